#pragma once
// Wall surfaces as grains meet them. Geometry is that at t = 0; a pose moves it.

#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/particles/walls.hpp"

namespace bedload::inline BL_VARIANT {

enum class SurfaceKind : std::uint32_t {
  plane,      ///< half-space behind the plane
  rectangle,  ///< finite patch, felt from both sides
  box,        ///< solid
};

/// Nearest point of a surface, seen from a sphere's centre.
struct Nearest {
  Vec3d normal;     ///< from the surface to the centre
  double distance;  ///< m; negative when the centre has passed the surface
  double side;      ///< +1 in front of the surface, -1 behind
};

struct Surface {
  SurfaceKind kind = SurfaceKind::plane;
  std::uint32_t body = 0;
  Vec3d centre;         ///< m, at t = 0
  Vec3d axis[3];        ///< right-handed; axis[2] is the normal of plane and rectangle
  double half[3] = {};  ///< half extents along them, m; infinite along a periodic axis

  /// Whether r is surely farther than `distance` (m) from the surface; cheaper than nearest.
  BL_HD bool beyond(const Vec3d& r, double distance) const {
    if (kind == SurfaceKind::plane) return dot(r, axis[2]) > distance;
    for (int k = 2; k >= 0; --k)
      if (std::abs(dot(r, axis[k])) - half[k] > distance) return true;
    return false;
  }

  /// r: centre of the sphere from `centre`, in the frame of t = 0. side: where the sphere was while it
  /// touched last (+1, -1; 0: not known), so that a rectangle pushes back what has passed through it.
  BL_HD Nearest nearest(const Vec3d& r, double side) const {
    const double p[3] = {dot(r, axis[0]), dot(r, axis[1]), dot(r, axis[2])};
    if (kind == SurfaceKind::plane) return {axis[2], p[2], 1};
    double d[3];
    bool inside[3];
    for (int k = 0; k < 3; ++k) {
      d[k] = p[k] - clamp(p[k], -half[k], half[k]);
      inside[k] = d[k] == 0;
    }
    if (inside[0] && inside[1]) {
      if (kind == SurfaceKind::rectangle) {
        const double s = side != 0 ? side : (p[2] >= 0 ? 1.0 : -1.0);
        return {s * axis[2], s * p[2], s};
      }
      if (inside[2]) return nearest_face(p);
    }
    const Vec3d away = d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2];
    const double distance = norm(away);
    return {away * (1 / distance), distance, kind == SurfaceKind::rectangle && p[2] < 0 ? -1.0 : 1.0};
  }

 private:
  BL_HD Nearest nearest_face(const double* p) const {
    int face = 0;
    double depth = half[0] - std::abs(p[0]);
    for (int k = 1; k < 3; ++k) {
      const double other = half[k] - std::abs(p[k]);
      if (other < depth) depth = other, face = k;
    }
    const double s = p[face] >= 0 ? 1.0 : -1.0;
    return {s * axis[face], -depth, 1};
  }
};

/// A sphere against a moved surface.
struct SurfaceContact {
  Vec3d normal;     ///< from the wall to the centre, lab frame
  double distance;  ///< m
  double side;
  Vec3d point;  ///< on the surface, lab frame, m
};

BL_HD SurfaceContact meet(const Surface& s, const BodyPose& pose, const Frame& frame, const Vec3d& x,
                          double side) {
  const Vec3d centre = pose.place(s.centre);
  const Vec3d r = frame.nearest_image(x - centre);
  const Nearest near = s.nearest(pose.turned() ? pose.rotation.conjugate().rotate(r) : r, side);
  const Vec3d n = pose.turned() ? pose.rotation.rotate(near.normal) : near.normal;
  return {n, near.distance, near.side, centre + r - near.distance * n};
}
/// Whether x is surely farther than `distance` (m) from the surface; cheaper than meet.
BL_HD bool beyond(const Surface& s, const BodyPose& pose, const Frame& frame, const Vec3d& x,
                  double distance) {
  const Vec3d r = frame.nearest_image(x - pose.place(s.centre));
  return s.beyond(pose.turned() ? pose.rotation.conjugate().rotate(r) : r, distance);
}

/// The surfaces of all wall bodies: a rectangle for each face of a tank, one for a box or a plane.
std::vector<Surface> make_surfaces(const Config& config);

}  // namespace bedload::inline BL_VARIANT
