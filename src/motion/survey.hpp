#pragma once
// What a motion reaches over a run, by sampling it.

#include <vector>

#include "bedload/motion/law.hpp"

namespace bedload {

/// Times at which to sample a motion up to `until`: evenly spaced, and where a table has rows.
std::vector<double> survey_times(const MotionConfig& motion, double until);

/// The first sampled time at which the motion has no finite place, velocity or acceleration; infinite if it
/// always has.
double first_gap(const MotionConfig& motion, double until);

/// Largest speed of any of the points that move along, given where they are at rest, m/s.
double top_speed(const MotionConfig& motion, const std::vector<Vec3d>& points, double until);

/// How far the motion has taken any of the points at t = 0, m.
double initial_shift(const MotionConfig& motion, const std::vector<Vec3d>& points);

struct VelocityJump {
  double time;  ///< s
  double size;  ///< largest change of any point's velocity, m/s
};
/// Jumps of more than a hundredth of the top speed in [0, until), a start from rest at t = 0 among them.
std::vector<VelocityJump> velocity_jumps(const MotionConfig& motion, const std::vector<Vec3d>& points,
                                         double until);

}  // namespace bedload
