#pragma once
// Nearest points, common to all shapes.

#include <algorithm>
#include <cmath>

#include "bedload/geometry/shape.hpp"

namespace bedload {

/// The place x seen from `point`, nearest to it on the surface. `outward` is the surface's normal there,
/// taken where x lies so close that round-off would decide the direction from one to the other.
inline SurfacePoint seen_from(const Vec3d& x, const Vec3d& point, bool inside, const Vec3d& outward) {
  const Vec3d apart = x - point;
  const double d = norm(apart);
  double size = 0;
  for (int k = 0; k < 3; ++k) size = std::max({size, std::abs(x[k]), std::abs(point[k])});
  const double sign = inside ? -1 : 1;
  return {sign * d, point, d > 1e-8 * size ? apart * (sign / d) : outward};
}

/// A unit vector at a right angle to `v`; any one where v = 0.
inline Vec3d perpendicular(const Vec3d& v) {
  const Vec3d other = std::abs(v.x) <= std::abs(v.y) && std::abs(v.x) <= std::abs(v.z) ? Vec3d{1, 0, 0}
                      : std::abs(v.y) <= std::abs(v.z)                                 ? Vec3d{0, 1, 0}
                                                                                       : Vec3d{0, 0, 1};
  const Vec3d p = v == Vec3d{} ? other : cross(v, other);
  return p / norm(p);
}

}  // namespace bedload
