#pragma once
// How wall bodies and the frame move in time. Evaluated on the host alone.

#include <memory>
#include <vector>

#include "bedload/case/config/motion.hpp"
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
  /// Times at which a part sets in, breaks or ends, ascending, s: there the velocity may jump.
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

/// Effective gravity in the frame of the case, g - a_frame(t).
class EffectiveGravity {
 public:
  /// Of a frame that moves like that; `until`: end of the time of interest, s.
  EffectiveGravity(const Vec3d& gravity, const MotionConfig& frame, double until)
      : gravity_(gravity), frame_(frame, until) {}

  Vec3d at(double t) const { return gravity_ - frame_.at(t).a; }  ///< m/s2
  /// At t + k dt / n for k = 0..n.
  std::vector<Vec3d> along(double t, double dt, int n) const {
    std::vector<Vec3d> all;
    for (int k = 0; k <= n; ++k) all.push_back(at(t + dt * k / n));
    return all;
  }

 private:
  Vec3d gravity_;
  MotionLaw frame_;
};

}  // namespace bedload
