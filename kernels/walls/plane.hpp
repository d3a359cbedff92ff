#pragma once
#include "kernels/walls/surface_data.hpp"

namespace BL_SOLVER {

/// Half-space behind a plane.
struct PlaneKind {
  static constexpr SurfaceKind kind = SurfaceKind::plane;
  static constexpr bool kOne = true, kTracked = false, kShell = false;

  BL_HD static bool beyond(const Surface& s, const Vec3d& r, double distance) {
    return dot(r, s.axis[2]) > distance;
  }
  BL_HD static bool within(const SurfaceData&, const Surface&, const Vec3d&, double) { return true; }
  BL_HD static ClosestPoint closest_point(const Surface& s, const Vec3d& r) {
    return {s.axis[2], dot(r, s.axis[2]), 0};
  }
};

}  // namespace BL_SOLVER
