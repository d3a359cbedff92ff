#pragma once
// Copies of a simulation, as coarse as a picture of it needs.

#include <optional>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/core/rigid_motion.hpp"
#include "bedload/motion/law.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

/// Particles that stand for all of their kind.
struct LiveParticles {
  std::vector<Vec3d> x;        ///< m
  std::vector<double> speed;   ///< m/s
  std::vector<double> radius;  ///< m, of grains; larger where one stands for several
  double widened = 1;          ///< that factor
};

/// One moment of a run.
struct LiveFrame {
  double time = 0;  ///< s
  LiveParticles fluid, grains;
  std::vector<std::optional<RigidMotion>> bodies;  ///< of wall bodies that move
  std::vector<bool> removed;                       ///< of all wall bodies
  double top_speed = 0;  ///< m/s, rounded up, which 1 % of the particles at most exceed
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
