#pragma once
// Wall surfaces as grains and fluid meet them. Geometry is that at t = 0; a pose moves it.
//
// What a surface shows to a place are its closest points: where its distance from there is least in their
// neighbourhood. A face has one, a convex edge or corner one, a groove one on each side, so that a sphere
// touches each feature once, however finely the surface is cut.

#include "bedload/particles/walls.hpp"
#include "kernels/walls/mesh_view.hpp"

namespace bedload::inline BL_VARIANT {

enum class SurfaceKind : std::uint32_t {
  plane,       ///< half-space behind the plane
  rectangle,   ///< finite patch, acts on both sides
  box,         ///< solid
  capsule,     ///< within a distance of a line; a sphere if that has no length
  revolution,  ///< a profile turned about an axis: cylinder, cone, pipe
  mesh,        ///< closed surface of triangles
};

/// Corner of the profile of a surface of revolution; the solid lies to the right of the way from one to the
/// next, with r upwards and z to the right.
struct ProfileCorner {
  double z, r;  ///< along the axis and away from it, m
};

/// Closest point of a surface, seen from a place.
struct ClosestPoint {
  Vec3d normal;            ///< unit, from the surface towards its open side
  double distance;         ///< m; negative where the place lies behind the surface
  std::uint32_t feature;   ///< of the surface: face, edge or corner
  double side = 1;         ///< of a patch: +1 in front, -1 behind
  bool two_sided = false;  ///< on a patch, which opens to either side

  /// The same patch seen from side s (+1, -1).
  BL_HD void face(double s) {
    if (!two_sided || s == side) return;
    normal = -normal, distance = -distance, side = s;
  }
};

struct Surface {
  SurfaceKind kind = SurfaceKind::plane;
  std::uint32_t body = 0;
  Vec3d centre;         ///< m, at t = 0
  Vec3d axis[3];        ///< right-handed; axis[2] is the normal of plane and rectangle, or the axis
  double half[3] = {};  ///< half extents along them, m; infinite along a periodic axis. Capsule: half[2]
  double radius = 0;    ///< capsule, m
  double shell = 0;     ///< thickness of a wall around the shape, m; 0: the shape itself is solid
  std::uint32_t first = 0, count = 0;  ///< revolution: its corners; mesh: its place in the list

  /// Whether a place behind the surface belongs to it only if it came through it: others of its faces look
  /// on the same place from behind.
  BL_HD bool tracked() const {
    return kind == SurfaceKind::revolution || kind == SurfaceKind::mesh ||
           (kind == SurfaceKind::box && shell > 0);
  }
  /// How far from it the centre of a sphere of radius R may be that touches it, m: a patch that holds the
  /// sphere on its side may be behind the centre.
  BL_HD double reach(double R) const { return tracked() ? R : 2 * R; }
};

/// All surfaces of a case, with what they refer to.
struct SurfaceSet {
  Span<const Surface> surfaces;
  const ProfileCorner* corners = nullptr;
  const MeshView* meshes = nullptr;

  /// Whether r is surely farther than `distance` (m) from surface s; cheaper than its closest points.
  BL_HD bool beyond(const Surface& s, const Vec3d& r, double distance) const {
    if (s.kind == SurfaceKind::plane) return dot(r, s.axis[2]) > distance;
    const double reach = distance + s.shell;
    for (int k = 2; k >= 0; --k) {
      const double half = k == 2 ? s.half[2] + s.radius : s.half[k];  // a capsule's ends are round
      if (std::abs(dot(r, s.axis[k])) - half > reach) return true;
    }
    return false;
  }

  /// Whether s may be within `distance` (m) of r. Sees into hollows: slower than `beyond`.
  BL_HD bool within(const Surface& s, const Vec3d& r, double distance) const {
    if (beyond(s, r, distance)) return false;
    const double reach = distance + s.shell;
    if (s.kind == SurfaceKind::mesh) return meshes[s.first].within(r, reach);
    const double p[3] = {dot(r, s.axis[0]), dot(r, s.axis[1]), dot(r, s.axis[2])};
    if (s.kind == SurfaceKind::revolution) return profile_within(s, p, reach);
    if (!s.tracked()) return true;
    double depth = s.half[0] - std::abs(p[0]);
    for (int k = 1; k < 3; ++k) depth = min_of(depth, s.half[k] - std::abs(p[k]));
    return depth <= reach;
  }

  /// f(point) for each closest point of s no farther than `reach` (m) from r, the place as seen from s.centre
  /// in the frame of t = 0. `merge`: closest points nearer to each other than this (m) may be one.
  template <class F>
  BL_HD void each_closest_point(const Surface& s, const Vec3d& r, double reach, double merge, F&& f) const {
    closest_points(s, r, reach, f,
                   [&](auto&& meet) { meshes[s.first].each_closest_point(r, reach + s.shell, merge, meet); });
  }
  /// As each_closest_point, but a mesh leaves out what its nearest point hides; see
  /// MeshView::each_exposed_point.
  template <class F>
  BL_HD void each_exposed_point(const Surface& s, const Vec3d& r, double reach, double merge, double flat,
                                F&& f) const {
    closest_points(s, r, reach, f, [&](auto&& meet) {
      meshes[s.first].each_exposed_point(r, reach + s.shell, merge, flat, meet);
    });
  }

 private:
  /// f(point); of_mesh(g) calls g(normal, distance, feature) for the closest points on a mesh.
  template <class F, class M>
  BL_HD void closest_points(const Surface& s, const Vec3d& r, double reach, F& f, M&& of_mesh) const {
    const double p[3] = {dot(r, s.axis[0]), dot(r, s.axis[1]), dot(r, s.axis[2])};
    const auto meet = [&](ClosestPoint closest) {
      if (s.shell > 0) {
        const bool inner = closest.distance < 0.5 * s.shell;
        if (inner) closest.normal = -closest.normal;
        closest.distance = inner ? -closest.distance : closest.distance - s.shell;
        closest.feature = 2 * closest.feature + inner;
      }
      if (closest.distance <= reach && (closest.distance >= -reach || !s.tracked())) f(closest);
    };
    switch (s.kind) {
      case SurfaceKind::plane:
        if (p[2] <= reach) f(ClosestPoint{s.axis[2], p[2], 0});
        break;
      case SurfaceKind::rectangle:
      case SurfaceKind::box:
        block(s, p, meet);
        break;
      case SurfaceKind::capsule:
        capsule(s, p, meet);
        break;
      case SurfaceKind::revolution:
        revolution(s, p, meet);
        break;
      case SurfaceKind::mesh:
        of_mesh([&](const Vec3d& n, double d, std::uint32_t k) { meet(ClosestPoint{n, d, k}); });
        break;
    }
  }

  /// Box or rectangle.
  template <class F>
  BL_HD void block(const Surface& s, const double* p, F& f) const {
    const bool patch = s.kind == SurfaceKind::rectangle;
    double d[3];
    bool inside[3];
    for (int k = 0; k < 3; ++k) {
      d[k] = p[k] - clamp(p[k], -s.half[k], s.half[k]);
      inside[k] = d[k] == 0;
    }
    if (inside[0] && inside[1] && patch) {
      const double side = p[2] >= 0 ? 1.0 : -1.0;
      return f(ClosestPoint{side * s.axis[2], side * p[2], 0, side, true});
    }
    if (inside[0] && inside[1] && inside[2]) return s.shell > 0 ? six_faces(s, p, f) : nearest_face(s, p, f);
    const Vec3d away = d[0] * s.axis[0] + d[1] * s.axis[1] + d[2] * s.axis[2];
    const double distance = norm(away);
    f(ClosestPoint{away * (1 / distance), distance, 0, patch && p[2] < 0 ? -1.0 : 1.0});
  }
  template <class F>
  BL_HD void nearest_face(const Surface& s, const double* p, F& f) const {
    int face = 0;
    double depth = s.half[0] - std::abs(p[0]);
    for (int k = 1; k < 3; ++k) {
      const double other = s.half[k] - std::abs(p[k]);
      if (other < depth) depth = other, face = k;
    }
    f(ClosestPoint{(p[face] >= 0 ? 1.0 : -1.0) * s.axis[face], -depth, 0});
  }
  template <class F>
  BL_HD void six_faces(const Surface& s, const double* p, F& f) const {
    for (int k = 0; k < 3; ++k) {
      f(ClosestPoint{s.axis[k], p[k] - s.half[k], std::uint32_t(2 * k + 1)});
      f(ClosestPoint{-s.axis[k], -p[k] - s.half[k], std::uint32_t(2 * k + 2)});
    }
  }

  template <class F>
  BL_HD void capsule(const Surface& s, const double* p, F& f) const {
    const double z = p[2] - clamp(p[2], -s.half[2], s.half[2]);
    const double away = std::sqrt(p[0] * p[0] + p[1] * p[1] + z * z);
    Vec3d n = s.axis[0];
    if (away > 0) n = (p[0] * s.axis[0] + p[1] * s.axis[1] + z * s.axis[2]) * (1 / away);
    f(ClosestPoint{n, away - s.radius, 0});
  }

  /// Every closest point lies in the half-plane of the place itself.
  template <class F>
  BL_HD void revolution(const Surface& s, const double* p, F& f) const {
    const double z = p[2], r = std::sqrt(p[0] * p[0] + p[1] * p[1]);
    Vec3d radial = s.axis[0];
    if (r > 0) radial = (p[0] * s.axis[0] + p[1] * s.axis[1]) * (1 / r);
    const auto corner = [&](std::uint32_t n) { return corners[s.first + (n >= s.count ? n - s.count : n)]; };

    // the side before the first corner, then each side and the corner at which it begins
    ProfileSide before(corner(s.count - 1), corner(0), z, r);
    for (std::uint32_t n = 0; n < s.count; ++n) {
      const ProfileCorner at = corner(n);
      const ProfileSide side(at, corner(n + 1), z, r);
      if (side.real && side.t >= 0 && side.t <= 1)
        f(ClosestPoint{side.nz * s.axis[2] + side.nr * radial, side.height, 2 * n});
      if ((before.real || side.real) && (!before.real || before.t > 1) && (!side.real || side.t < 0)) {
        const double dz = z - at.z, dr = r - at.r, d = std::sqrt(dz * dz + dr * dr);
        const double nz = before.nz + side.nz, nr = before.nr + side.nr;
        const double front = dz * nz + dr * nr >= 0 ? 1.0 : -1.0;
        f(ClosestPoint{(dz * s.axis[2] + dr * radial) * (front / d), front * d, 2 * n + 1});
      }
      before = side;
    }
  }
  BL_HD bool profile_within(const Surface& s, const double* p, double reach) const {
    const double z = p[2], r = std::sqrt(p[0] * p[0] + p[1] * p[1]);
    for (std::uint32_t n = 0; n < s.count; ++n) {
      const ProfileCorner a = corners[s.first + n], b = corners[s.first + (n + 1 == s.count ? 0 : n + 1)];
      const ProfileSide side(a, b, z, r);
      if (!side.real) continue;
      const double t = clamp(side.t, 0.0, 1.0);
      const double dz = z - a.z - t * (b.z - a.z), dr = r - a.r - t * (b.r - a.r);
      if (dz * dz + dr * dr <= reach * reach) return true;
    }
    return false;
  }
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

/// Where x (m, lab frame) lies as a surface sees it that has been moved and turned.
struct SurfaceView {
  const Surface& surface;
  const BodyPose& pose;
  Vec3d centre;  ///< of the surface, lab frame, m
  Vec3d r;       ///< x from there, lab frame, m
  BL_HD SurfaceView(const Surface& s, const BodyPose& at, const Frame& frame, const Vec3d& x)
      : surface(s), pose(at), centre(at.place(s.centre)), r(frame.nearest_image(x - centre)) {}

  BL_HD Vec3d local() const { return pose.turned() ? pose.rotation.conjugate().rotate(r) : r; }
  BL_HD bool beyond(const SurfaceSet& set, double distance) const {
    return set.beyond(surface, local(), distance);
  }
  /// f(point), its normal in the lab frame; see SurfaceSet::each_closest_point.
  template <class F>
  BL_HD void each_closest_point(const SurfaceSet& set, double reach, double merge, F&& f) const {
    set.each_closest_point(surface, local(), reach, merge, [&](ClosestPoint closest) {
      if (pose.turned()) closest.normal = pose.rotation.rotate(closest.normal);
      f(closest);
    });
  }
  template <class F>
  BL_HD void each_exposed_point(const SurfaceSet& set, double reach, double merge, double flat, F&& f) const {
    set.each_exposed_point(surface, local(), reach, merge, flat, [&](ClosestPoint closest) {
      if (pose.turned()) closest.normal = pose.rotation.rotate(closest.normal);
      f(closest);
    });
  }
  /// Of the closest point on the surface, lab frame, m.
  BL_HD Vec3d point(const ClosestPoint& closest) const {
    return centre + r - closest.distance * closest.normal;
  }
};

}  // namespace bedload::inline BL_VARIANT
