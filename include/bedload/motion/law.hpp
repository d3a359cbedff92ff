#pragma once
// How wall bodies move in time. Evaluated on the host alone.

#include <memory>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/core/rigid_motion.hpp"

namespace bedload {

class Track;

/// The motion of one body: its parts' translations add, their rotations follow one another in the order
/// given, each about its own centre; velocities and accelerations are those of the composed motion.
class MotionLaw {
 public:
  /// `until`: end of the time of interest, s.
  MotionLaw(const MotionConfig& motion, double until);

  RigidMotion at(double t) const;
  bool moves() const { return !parts_.empty(); }
  /// Times at which a part sets in or ends, ascending, s: there the velocity may jump.
  std::vector<double> events() const;

 private:
  struct Part {
    double start, stop;  ///< s
    Vec3d centre;        ///< m
    std::shared_ptr<const Track> track;
  };
  std::vector<Part> parts_;
  Vec3d centre_;  ///< of the first part that turns, m
};

}  // namespace bedload
