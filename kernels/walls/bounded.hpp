#pragma once
#include "kernels/walls/surface_data.hpp"

namespace BL_SOLVER {

/// Of kinds that lie within their half extents along their axes.
struct BoundedKind {
  BL_HD static bool beyond(const Surface& s, const Vec3d& r, double distance) {
    const double reach = distance + s.shell;
    for (int k = 2; k >= 0; --k) {
      const double half = k == 2 ? s.half[2] + s.radius : s.half[k];  // a capsule's ends are round
      if (std::abs(dot(r, s.axis[k])) - half > reach) return true;
    }
    return false;
  }
  BL_HD static bool within(const SurfaceData&, const Surface&, const Vec3d&, double) { return true; }
};

}  // namespace BL_SOLVER
