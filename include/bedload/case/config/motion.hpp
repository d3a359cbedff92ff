#pragma once
// How walls and the domain move.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bedload/case/setup_choices.hpp"
#include "bedload/core/vec.hpp"

namespace bedload {

/// A row of a motion table: t (s), x, y, z (m), rotation vector (deg).
using MotionRow = std::array<double, 7>;

/// The regular wave that a piston or flap makes.
struct WaveConfig {
  double height = 0, period = 0, depth = 0;    ///< m, s, m
  std::int64_t order = 2;                      ///< of the theory
  Vec3d direction{1, 0, 0};                    ///< in which it runs (resolved: unit, horizontal)
  double ramp = 1;                             ///< periods over which the motion rises
  bool operator==(const WaveConfig&) const = default;
};

/// One part of a motion. Its t counts from start.
struct MotionPart {
  Chosen<MotionKind> kind = MotionKind::fixed;
  Vec3d velocity;                              ///< velocity: m/s
  Vec3d amplitude;                             ///< oscillation: displacement amplitude, m
  double frequency = 0;                        ///< oscillation: Hz
  Vec3d axis, centre;                          ///< rotation: unit axis; centre of any turning, m
  double rate = 0;                             ///< rotation: rad/s
  std::string factor = "1";                    ///< velocity, rotation: of velocity or rate, a formula in t
  std::string file;                            ///< table: CSV file; its rows replace it when the case is read
  std::vector<MotionRow> rows;                 ///< table
  Chosen<TableSpline> spline = TableSpline::smooth;  ///< table
  WaveConfig wave;                             ///< piston, flap
  std::array<std::string, 3> displacement{"0", "0", "0"};  ///< formula, piston (resolved): in t, m
  std::array<std::string, 3> rotation{"0", "0", "0"};      ///< formula, flap (resolved): in t, rotation vector, deg
  double start = 0;                            ///< s
  double stop = std::numeric_limits<double>::infinity();  ///< s
  bool scaled() const { return factor != "1"; }
  bool operator==(const MotionPart&) const = default;
};

/// How a body moves: by its own part and those added. Evaluated on the host into one pose and velocity.
struct MotionConfig : MotionPart {
  bool remove_when_clear = false;              ///< deleted once above all fluid and grains
  std::vector<MotionPart> add;                 ///< translations add, rotations follow in this order
  bool moves() const { return kind != MotionKind::fixed || !add.empty(); }
  bool operator==(const MotionConfig&) const = default;
};

/// How the domain itself moves: translation only. The effective gravity is then g - a_frame.
struct FrameConfig {
  MotionConfig motion;
  double acceleration = 0;                     ///< largest, m/s2 (resolved)
  bool operator==(const FrameConfig&) const = default;
};

}  // namespace bedload
