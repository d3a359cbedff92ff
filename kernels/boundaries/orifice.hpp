#pragma once
#include <cmath>

#include "bedload/core/span.hpp"
#include "bedload/core/vec.hpp"

namespace BL_SOLVER {

/// Disc or rectangle through which fluid flows in.
struct Orifice {
  Vec3d centre, direction;  ///< m; unit, into the flow
  Vec3d axis[2];            ///< rectangle: unit, along its sides
  double half[2];           ///< half sides, or the radius and 0, m
  bool disc;
  std::uint32_t body;  ///< of the inflow buffer
  double behind;       ///< distance from the orifice to the front of the first buffer layer, m

  // r: from the centre, m
  BL_HD double along(const Vec3d& r) const { return dot(r, direction); }  ///< downstream of its plane, m
  /// Distance from the rim in the plane of the orifice, 0 inside, m.
  BL_HD double beside(const Vec3d& r) const {
    if (disc) return max_of(norm(r - along(r) * direction) - half[0], 0.0);
    const double a = max_of(std::abs(dot(r, axis[0])) - half[0], 0.0);
    const double b = max_of(std::abs(dot(r, axis[1])) - half[1], 0.0);
    return std::hypot(a, b);
  }
  BL_HD double distance(const Vec3d& r) const { return std::hypot(along(r), beside(r)); }
};

}  // namespace BL_SOLVER
