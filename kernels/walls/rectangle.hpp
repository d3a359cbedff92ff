#pragma once
#include "kernels/walls/bounded.hpp"

namespace BL_SOLVER {

/// Finite patch, acts on both sides.
struct RectangleKind : BoundedKind {
  static constexpr SurfaceKind kind = SurfaceKind::rectangle;
  static constexpr bool kOne = true, kTracked = false, kShell = false;

  BL_HD static ClosestPoint closest_point(const Surface& s, const Vec3d& r) {
    const double p[3] = {dot(r, s.axis[0]), dot(r, s.axis[1]), dot(r, s.axis[2])};
    const double side = p[2] >= 0 ? 1.0 : -1.0;
    const double d[2] = {p[0] - clamp(p[0], -s.half[0], s.half[0]),
                         p[1] - clamp(p[1], -s.half[1], s.half[1])};
    if (d[0] == 0 && d[1] == 0) return {side * s.axis[2], side * p[2], 0, side, true};
    const Vec3d away = d[0] * s.axis[0] + d[1] * s.axis[1] + p[2] * s.axis[2];
    const double distance = norm(away);
    return {away * (1 / distance), distance, 0, side};
  }
};

}  // namespace BL_SOLVER
