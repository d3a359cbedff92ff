#pragma once
// What a wall surface is, and what it shows to a place.

#include "bedload/particles/walls.hpp"
#include "kernels/walls/mesh_view.hpp"

namespace BL_SOLVER {

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
struct SurfaceData {
  Span<const Surface> surfaces;
  const ProfileCorner* corners = nullptr;
  const MeshView* meshes = nullptr;
};

}  // namespace BL_SOLVER
