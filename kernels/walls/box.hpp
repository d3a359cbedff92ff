#pragma once
#include "kernels/walls/bounded.hpp"

namespace BL_SOLVER {

/// Solid box, or a shell around one.
struct BoxKind : BoundedKind {
  static constexpr SurfaceKind kind = SurfaceKind::box;
  static constexpr bool kOne = false, kTracked = true, kShell = true;

  BL_HD static bool within(const SurfaceData&, const Surface& s, const Vec3d& r, double reach) {
    if (!(s.shell > 0)) return true;
    const double p[3] = {dot(r, s.axis[0]), dot(r, s.axis[1]), dot(r, s.axis[2])};
    double depth = s.half[0] - std::abs(p[0]);
    for (int k = 1; k < 3; ++k) depth = min_of(depth, s.half[k] - std::abs(p[k]));
    return depth <= reach;
  }
  template <class F>
  BL_HD static void closest_points(const SurfaceData&, const Surface& s, const Vec3d& r, double,
                                   const MeshSearch&, F& f) {
    const double p[3] = {dot(r, s.axis[0]), dot(r, s.axis[1]), dot(r, s.axis[2])};
    double d[3];
    for (int k = 0; k < 3; ++k) d[k] = p[k] - clamp(p[k], -s.half[k], s.half[k]);
    if (d[0] == 0 && d[1] == 0 && d[2] == 0) return s.shell > 0 ? six_faces(s, p, f) : nearest_face(s, p, f);
    const Vec3d away = d[0] * s.axis[0] + d[1] * s.axis[1] + d[2] * s.axis[2];
    const double distance = norm(away);
    f(ClosestPoint{away * (1 / distance), distance, 0});
  }

 private:
  template <class F>
  BL_HD static void nearest_face(const Surface& s, const double* p, F& f) {
    int face = 0;
    double depth = s.half[0] - std::abs(p[0]);
    for (int k = 1; k < 3; ++k) {
      const double other = s.half[k] - std::abs(p[k]);
      if (other < depth) depth = other, face = k;
    }
    f(ClosestPoint{(p[face] >= 0 ? 1.0 : -1.0) * s.axis[face], -depth, 0});
  }
  template <class F>
  BL_HD static void six_faces(const Surface& s, const double* p, F& f) {
    for (int k = 0; k < 3; ++k) {
      f(ClosestPoint{s.axis[k], p[k] - s.half[k], std::uint32_t(2 * k + 1)});
      f(ClosestPoint{-s.axis[k], -p[k] - s.half[k], std::uint32_t(2 * k + 2)});
    }
  }
};

}  // namespace BL_SOLVER
