#pragma once
// Solids by their signed distance: what walls are made of and what fluid and grains fill.

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "bedload/case/setup_choices.hpp"
#include "bedload/core/vec.hpp"

namespace bedload {

/// Axis-aligned box that holds what was added to it; empty at first.
struct Bounds {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3d min{kInfinity, kInfinity, kInfinity}, max{-kInfinity, -kInfinity, -kInfinity};  ///< m

  void add(const Vec3d& x) {
    for (int k = 0; k < 3; ++k) min[k] = std::fmin(min[k], x[k]), max[k] = std::fmax(max[k], x[k]);
  }
  void add(const Bounds& other) {
    for (int k = 0; k < 3; ++k)
      min[k] = std::fmin(min[k], other.min[k]), max[k] = std::fmax(max[k], other.max[k]);
  }
  Vec3d middle() const { return 0.5 * (min + max); }
  Bounds grown(double by) const {
    Bounds b = *this;
    for (int k = 0; k < 3; ++k) b.min[k] -= by, b.max[k] += by;
    return b;
  }
};

/// Similarity: x -> translation + scale * rotation(x).
struct Placement {
  double scale = 1;       ///< above 0
  Quat<double> rotation;  ///< unit
  Vec3d translation;      ///< m

  Vec3d apply(const Vec3d& x) const { return translation + scale * rotation.rotate(x); }
  Vec3d undo(const Vec3d& x) const { return rotation.conjugate().rotate(x - translation) / scale; }
  /// First `inner`, then this.
  Placement after(const Placement& inner) const {
    return {scale * inner.scale, rotation * inner.rotation, apply(inner.translation)};
  }
};

/// The surface as seen from some place.
struct SurfacePoint {
  double distance = 0;  ///< of the place, m; negative inside the solid
  Vec3d point;          ///< of the surface nearest to the place, m
  Vec3d normal;         ///< gradient of the distance at the place; on the surface the outward normal
};

struct MeshLayout;

/// A surface in elementary terms, for contacts on a device. Lab frame at t = 0.
struct SurfacePart {
  enum class Kind { box, capsule, revolution, mesh };
  struct Corner {
    double z, r;  ///< along the axis and away from it, m
  };

  Kind kind = Kind::box;
  Vec3d centre = {};                 ///< m
  Quat<double> rotation = {};        ///< of the axes; the last is that of capsule and revolution
  Vec3d half = {};                   ///< half extents along the axes, m
  double radius = 0;                 ///< capsule, m; half.z is half the length of its line
  std::vector<Corner> profile = {};  ///< revolution, closed; the solid lies to its right, z from the centre
  std::shared_ptr<const MeshLayout> mesh = nullptr;  ///< vertices from the centre
  double shell = 0;  ///< thickness of a wall around the shape, m; 0: the shape itself is solid
};

class Shape;
using ShapePtr = std::shared_ptr<const Shape>;

/// A solid. Its signed distance changes by no more than the way walked (Lipschitz constant 1).
class Shape {
 public:
  virtual ~Shape() = default;

  virtual SurfacePoint nearest(const Vec3d& x) const = 0;

  /// Encloses the solid, not always tightly.
  virtual Bounds bounds() const = 0;

  /// The same solid with coordinates from `origin`, rounded to decimals far below `spacing` (m) but far above
  /// the rounding of numbers: whatever its place, the same solid from its own middle has the same digits. Use
  /// it no longer than this one.
  virtual ShapePtr in_frame(const Vec3d& origin, double spacing) const = 0;

  /// Adds the parts of its surface, moved by `placement`. Parts that lie within others do no harm. Throws
  /// CaseError where the surface has no such description.
  virtual void add_parts(std::vector<SurfacePart>& parts, const Placement& placement) const = 0;

  /// m, negative inside the solid.
  double distance(const Vec3d& x) const { return nearest(x).distance; }

  /// distance(), but true also where that is only a bound outside the solid: how large a sphere fits, m.
  virtual double clearance(const Vec3d& x) const { return distance(x); }
};

// Primitives. Distances are exact; lengths in m. Sizes that make no solid raise a CaseError.

ShapePtr make_box(const Vec3d& min, const Vec3d& max);
ShapePtr make_sphere(const Vec3d& centre, double radius);

/// All points within `radius` of the line from a to b.
ShapePtr make_capsule(const Vec3d& a, const Vec3d& b, double radius);

/// Flat ends at a and b.
ShapePtr make_cylinder(const Vec3d& a, const Vec3d& b, double radius);

/// Flat ends at a and b; one of the two radii may be 0.
ShapePtr make_cone(const Vec3d& a, const Vec3d& b, double radius_a, double radius_b);

/// Hollow cylinder whose bore runs from a to b. A closed end is a plate beyond it, as thick as the wall.
ShapePtr make_pipe(const Vec3d& a, const Vec3d& b, double inner_radius, double outer_radius, PipeEnds ends);

// Shapes made of others.

/// Vessel: the points outside `shape` within `thickness` of it, so that `shape` is the hollow. Exact wherever
/// `shape` is, except within the wall where that is concave outside: a bound there.
ShapePtr make_hollow(ShapePtr shape, double thickness);

/// All of the shapes together. The distance is their least: exact outside, inside no greater than the true
/// depth. Shapes that only touch leave a surface between them: let them overlap.
ShapePtr make_union(std::vector<ShapePtr> shapes);

/// `shape` without `cut`. The distance is max(d, -d_cut): exact on the surface, elsewhere never greater in
/// magnitude than the true one: near what is cut away it may be that from the surface which is gone, a lid
/// on a hole. `nearest` names a point of that then; `clearance` is that from the triangles, up to half a
/// facet less. Its parts are triangles about `facet` (m) wide; 0: a quarter of the least extent, at most
/// 1/100 of the diagonal.
ShapePtr make_difference(ShapePtr shape, ShapePtr cut, double facet = 0);

/// `shape` moved, turned and scaled.
ShapePtr make_placed(ShapePtr shape, const Placement& placement);

}  // namespace bedload
