#pragma once
#include "kernels/walls/bounded.hpp"

namespace BL_SOLVER {

/// Closed surface of triangles.
struct MeshKind : BoundedKind {
  static constexpr SurfaceKind kind = SurfaceKind::mesh;
  static constexpr bool kOne = false, kTracked = true, kShell = true;

  BL_HD static bool within(const SurfaceData& all, const Surface& s, const Vec3d& r, double reach) {
    return all.meshes[s.first].within(r, reach);
  }
  template <class F>
  BL_HD static void closest_points(const SurfaceData& all, const Surface& s, const Vec3d& r, double reach,
                                   const MeshSearch& search, F& f) {
    all.meshes[s.first].each_closest_point(r, reach + s.shell,
                                           s.shell > 0 ? MeshSearch(search.merge) : search, as_points(f));
  }
  /// See MeshView::each_exposed_point.
  template <class F>
  BL_HD static void exposed_points(const SurfaceData& all, const Surface& s, const Vec3d& r, double reach,
                                   double merge, double flat, F& f) {
    all.meshes[s.first].each_exposed_point(r, reach + s.shell, merge, flat, as_points(f));
  }

 private:
  template <class F>
  BL_HD static auto as_points(F& f) {
    return [&f](const Vec3d& n, double d, std::uint32_t k) { f(ClosestPoint{n, d, k}); };
  }
};

}  // namespace BL_SOLVER
