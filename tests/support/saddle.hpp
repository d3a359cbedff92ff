#pragma once
// A grain that rolls off the saddle between two larger ones that are fixed and touch.

#include <cmath>

#include "bedload/core/types.hpp"

namespace BL_SOLVER {

struct Saddle {
  static constexpr double kG = 9.81;  ///< m/s2
  double R, ratio;                    ///< radius of the grain, m; of the larger ones, over R

  double apart() const { return (1 + ratio) * R; }  ///< centres that touch, m
  /// Of the circle that its centre describes, m.
  double orbit() const { return std::sqrt(1 + 2 * ratio) * R; }
  Vec3d large(int side) const { return {0, side == 0 ? -ratio * R : ratio * R, 0}; }
  /// At an angle from the top (degrees), where it just touches both.
  Vec3d start(double angle) const {
    const double a = angle * M_PI / 180;
    return {orbit() * std::sin(a), 0, orbit() * std::cos(a)};
  }
  double gap(const Vec3d& x) const { return std::hypot(x.x, x.z) - orbit(); }
  /// Where it leaves if it rolls, from rest at `start` (degrees): by its energy, as gravity no longer presses
  /// it on.
  double release(double start) const {
    const double reach = ratio / (1 + ratio), kappa = 0.4 / (1 - reach * reach);
    return std::acos(2 * std::cos(start * M_PI / 180) / (3 + kappa)) * 180 / M_PI;
  }
  /// Where it left (degrees), from its horizontal velocity in flight, m/s.
  double released(double v) const { return std::acos(std::cbrt(v * v / (kG * orbit()))) * 180 / M_PI; }
};

}  // namespace BL_SOLVER
