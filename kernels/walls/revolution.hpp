#pragma once
#include "kernels/walls/bounded.hpp"

namespace BL_SOLVER {

/// A profile turned about an axis: cylinder, cone, pipe.
struct RevolutionKind : BoundedKind {
  static constexpr SurfaceKind kind = SurfaceKind::revolution;
  static constexpr bool kOne = false, kTracked = true, kShell = true;

  BL_HD static bool within(const SurfaceData& all, const Surface& s, const Vec3d& r, double reach) {
    const double p[3] = {dot(r, s.axis[0]), dot(r, s.axis[1]), dot(r, s.axis[2])};
    const double z = p[2], away = std::sqrt(p[0] * p[0] + p[1] * p[1]);
    for (std::uint32_t n = 0; n < s.count; ++n) {
      const ProfileCorner a = all.corners[s.first + n],
                          b = all.corners[s.first + (n + 1 == s.count ? 0 : n + 1)];
      const ProfileSide side(a, b, z, away);
      if (!side.real) continue;
      const double t = clamp(side.t, 0.0, 1.0);
      const double dz = z - a.z - t * (b.z - a.z), dr = away - a.r - t * (b.r - a.r);
      if (dz * dz + dr * dr <= reach * reach) return true;
    }
    return false;
  }
  /// Every closest point lies in the half-plane of the place itself.
  template <class F>
  BL_HD static void closest_points(const SurfaceData& all, const Surface& s, const Vec3d& r, double,
                                   const MeshSearch&, F& f) {
    const double p[3] = {dot(r, s.axis[0]), dot(r, s.axis[1]), dot(r, s.axis[2])};
    const double z = p[2], away = std::sqrt(p[0] * p[0] + p[1] * p[1]);
    Vec3d radial = s.axis[0];
    if (away > 0) radial = (p[0] * s.axis[0] + p[1] * s.axis[1]) * (1 / away);
    const auto corner = [&](std::uint32_t n) {
      return all.corners[s.first + (n >= s.count ? n - s.count : n)];
    };

    // the side before the first corner, then each side and the corner at which it begins
    ProfileSide before(corner(s.count - 1), corner(0), z, away);
    for (std::uint32_t n = 0; n < s.count; ++n) {
      const ProfileCorner at = corner(n);
      const ProfileSide side(at, corner(n + 1), z, away);
      if (side.real && side.t >= 0 && side.t <= 1)
        f(ClosestPoint{side.nz * s.axis[2] + side.nr * radial, side.height, 2 * n});
      if ((before.real || side.real) && (!before.real || before.t > 1) && (!side.real || side.t < 0)) {
        const double dz = z - at.z, dr = away - at.r, d = std::sqrt(dz * dz + dr * dr);
        const double nz = before.nz + side.nz, nr = before.nr + side.nr;
        const double front = dz * nz + dr * nr >= 0 ? 1.0 : -1.0;
        f(ClosestPoint{(dz * s.axis[2] + dr * radial) * (front / d), front * d, 2 * n + 1});
      }
      before = side;
    }
  }

 private:
  /// One side of a profile, seen from a place in its half-plane.
  struct ProfileSide {
    bool real;      ///< not on the axis, where there is no surface
    double t;       ///< of the place along it: 0..1 between its corners
    double nz, nr;  ///< normal
    double height;  ///< of the place above it, m
    BL_HD ProfileSide(const ProfileCorner& p, const ProfileCorner& q, double z, double r)
        : real(p.r > 0 || q.r > 0), t(0), nz(0), nr(0), height(0) {
      if (!real) return;
      const double dz = q.z - p.z, dr = q.r - p.r, length2 = dz * dz + dr * dr;
      const double inverse = 1 / std::sqrt(length2);
      t = ((z - p.z) * dz + (r - p.r) * dr) / length2;
      nz = -dr * inverse, nr = dz * inverse;
      height = (z - p.z) * nz + (r - p.r) * nr;
    }
  };
};

}  // namespace BL_SOLVER
