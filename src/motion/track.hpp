#pragma once
// One part of a motion: a displacement and a rotation vector in time.

#include <limits>
#include <memory>
#include <vector>

#include "bedload/case/config/motion.hpp"

namespace bedload {

/// A vector with its first two derivatives in time.
struct Jet {
  Vec3d value, rate, rate2;
};

/// Displacement (m) and rotation vector (axis times angle, rad).
struct TrackPoint {
  Jet shift, turn;
};

/// s counts from the start of the part, in seconds.
class Track {
 public:
  virtual ~Track() = default;
  virtual TrackPoint at(double s) const = 0;
  virtual bool turns() const { return false; }
  /// Times between which it is smooth, in any order.
  virtual std::vector<double> breaks() const { return {}; }
  /// Moves from `begin` to `end`; rests where it is before and after.
  virtual double begin() const { return 0; }
  virtual double end() const { return std::numeric_limits<double>::infinity(); }
};

/// The track of `part`; none if it is fixed. `span`: seconds of interest from its start.
std::unique_ptr<Track> make_track(const MotionPart& part, double span);

}  // namespace bedload
