#pragma once
// Snapshots of a simulation for pictures: a subset of its particles.

#include <optional>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/core/rigid_motion.hpp"
#include "bedload/motion/law.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

/// A subset of the particles of a kind.
struct LiveParticles {
  std::vector<Vec3d> x;        ///< m
  std::vector<double> speed;   ///< m/s
  std::vector<double> radius;  ///< m, of grains; enlarged if one represents several
  double enlarged = 1;         ///< by this factor
};

/// The state of a run at one time.
struct LiveFrame {
  double time = 0;  ///< s
  LiveParticles fluid, grains;
  std::vector<std::optional<RigidMotion>> bodies;  ///< of wall bodies that move
  std::vector<bool> removed;                       ///< of all wall bodies
  double top_speed = 0;                            ///< m/s, 99th percentile, rounded up
};

/// Takes frames of one run.
class FrameTaker {
 public:
  explicit FrameTaker(const Config& config);
  /// Changes nothing in the simulation.
  LiveFrame take(Simulation& simulation) const;

 private:
  RigidMotion motion_of(Simulation& simulation, int body) const;
  bool removed(Simulation& simulation, int body) const;

  const Config config_;
  std::vector<MotionLaw> laws_;  ///< one a wall body
};

}  // namespace bedload
