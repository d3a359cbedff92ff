#pragma once
#include "kernels/walls/bounded.hpp"

namespace BL_SOLVER {

/// Within a distance of a line; a sphere if that has no length.
struct CapsuleKind : BoundedKind {
  static constexpr SurfaceKind kind = SurfaceKind::capsule;
  static constexpr bool kOne = true, kTracked = false, kShell = true;

  BL_HD static ClosestPoint closest_point(const Surface& s, const Vec3d& r) {
    const double p[3] = {dot(r, s.axis[0]), dot(r, s.axis[1]), dot(r, s.axis[2])};
    const double z = p[2] - clamp(p[2], -s.half[2], s.half[2]);
    const double away = std::sqrt(p[0] * p[0] + p[1] * p[1] + z * z);
    Vec3d n = s.axis[0];
    if (away > 0) n = (p[0] * s.axis[0] + p[1] * s.axis[1] + z * s.axis[2]) * (1 / away);
    return {n, away - s.radius, 0};
  }
};

}  // namespace BL_SOLVER
