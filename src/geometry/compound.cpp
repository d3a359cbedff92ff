// Shapes made of other shapes.

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "bedload/core/error.hpp"
#include "bedload/geometry/mesh.hpp"
#include "geometry/contour.hpp"
#include "geometry/decimals.hpp"

namespace bedload {
namespace {

/// The same surface around the complement of the solid.
SurfacePoint inverted(const SurfacePoint& s) { return {-s.distance, s.point, -s.normal}; }

class Hollow : public Shape {
 public:
  Hollow(ShapePtr shape, double thickness) : shape_(std::move(shape)), thickness_(thickness) {
    if (!(thickness > 0 && std::isfinite(thickness)))
      throw CaseError(fmt::format("hollow: thickness = {:g} m must be above 0", thickness));
  }

  SurfacePoint nearest(const Vec3d& x) const override {
    const SurfacePoint inner = shape_->nearest(x);
    if (inner.distance < thickness_ / 2) return inverted(inner);
    return {inner.distance - thickness_, inner.point + thickness_ * inner.normal, inner.normal};
  }

  double clearance(const Vec3d& x) const override {
    const double inner = shape_->distance(x);
    return inner < thickness_ / 2 ? -inner : shape_->clearance(x) - thickness_;
  }

  Bounds bounds() const override { return shape_->bounds().grown(thickness_); }

  ShapePtr in_frame(const Vec3d& origin, double spacing) const override {
    return std::make_shared<Hollow>(shape_->in_frame(origin, spacing), thickness_);
  }

  void add_parts(std::vector<SurfacePart>& parts, const Placement& p) const override {
    const std::size_t before = parts.size();
    shape_->add_parts(parts, p);
    if (parts.size() != before + 1 || parts.back().shell > 0)
      throw CaseError(
          "hollow: grains can meet it only around a single box, cylinder, cone, sphere, capsule, "
          "pipe or mesh");
    parts.back().shell = p.scale * thickness_;
  }

 private:
  ShapePtr shape_;
  double thickness_;
};

class Union : public Shape {
 public:
  explicit Union(std::vector<ShapePtr> shapes) : shapes_(std::move(shapes)) {
    if (shapes_.empty()) throw CaseError("union: must hold at least one shape");
  }

  SurfacePoint nearest(const Vec3d& x) const override {
    SurfacePoint least = shapes_[0]->nearest(x);
    for (std::size_t n = 1; n < shapes_.size(); ++n) {
      const SurfacePoint other = shapes_[n]->nearest(x);
      if (other.distance < least.distance) least = other;
    }
    return least;
  }

  double clearance(const Vec3d& x) const override {
    double least = Bounds::kInfinity;
    for (const ShapePtr& shape : shapes_) least = std::min(least, shape->clearance(x));
    return least;
  }

  Bounds bounds() const override {
    Bounds b;
    for (const ShapePtr& shape : shapes_) b.add(shape->bounds());
    return b;
  }

  ShapePtr in_frame(const Vec3d& origin, double spacing) const override {
    std::vector<ShapePtr> shapes;
    for (const ShapePtr& shape : shapes_) shapes.push_back(shape->in_frame(origin, spacing));
    return std::make_shared<Union>(std::move(shapes));
  }

  void add_parts(std::vector<SurfacePart>& parts, const Placement& p) const override {
    for (const ShapePtr& shape : shapes_) shape->add_parts(parts, p);
  }

 private:
  std::vector<ShapePtr> shapes_;
};

class Difference : public Shape {
 public:
  Difference(ShapePtr shape, ShapePtr cut, double facet)
      : shape_(std::move(shape)), cut_(std::move(cut)), facet_(facet) {}

  SurfacePoint nearest(const Vec3d& x) const override {
    const SurfacePoint kept = shape_->nearest(x), cut = inverted(cut_->nearest(x));
    return kept.distance >= cut.distance ? kept : cut;
  }

  double clearance(const Vec3d& x) const override {
    const SurfacePoint s = nearest(x);
    if (s.distance <= 0 || distance(s.point) < 1e-6 * facet()) return s.distance;
    return std::max(s.distance, mesh().distance(x) - facet() / 2);
  }

  Bounds bounds() const override { return shape_->bounds(); }

  ShapePtr in_frame(const Vec3d& origin, double spacing) const override {
    return std::make_shared<Difference>(shape_->in_frame(origin, spacing), cut_->in_frame(origin, spacing),
                                        facet_);
  }

  void add_parts(std::vector<SurfacePart>& parts, const Placement& p) const override {
    mesh().add_parts(parts, p);
  }

 private:
  double facet() const {
    if (facet_ > 0) return facet_;
    const Bounds b = bounds();
    const Vec3d side = b.max - b.min;
    return std::min(norm(side) / 100, std::min({side.x, side.y, side.z}) / 4);
  }

  const TriangleMesh& mesh() const {
    std::call_once(made_, [&] { mesh_ = make_mesh(); });
    return *mesh_;
  }

  std::shared_ptr<const TriangleMesh> make_mesh() const {
    MeshOptions options;
    options.repair = true;
    std::string fault;
    for (const double size : {facet(), 0.97 * facet(), 0.94 * facet()}) {  // another raster may do
      try {
        TriangleSoup surface = contour(*this, size);
        if (surface.triangles.empty())
          throw CaseError("nothing is left of what the difference is taken from, or less than that");
        return std::make_shared<TriangleMesh>(std::move(surface), "its triangles", options);
      } catch (const CaseError& error) {
        if (fault.empty()) fault = error.what();
      }
    }
    throw CaseError(fmt::format("difference: with a facet of {:g} m, {}", facet(), fault));
  }

  ShapePtr shape_, cut_;
  double facet_;  ///< as asked for, m
  mutable std::once_flag made_;
  mutable std::shared_ptr<const TriangleMesh> mesh_;
};

class Placed : public Shape {
 public:
  Placed(ShapePtr shape, const Placement& placement) : shape_(std::move(shape)), placement_(placement) {
    if (!(placement.scale > 0 && std::isfinite(placement.scale)))
      throw CaseError(fmt::format("placed shape: scale = {:g} must be above 0", placement.scale));
  }

  SurfacePoint nearest(const Vec3d& x) const override {
    const SurfacePoint s = shape_->nearest(placement_.undo(x));
    return {placement_.scale * s.distance, placement_.apply(s.point), placement_.rotation.rotate(s.normal)};
  }

  double clearance(const Vec3d& x) const override {
    return placement_.scale * shape_->clearance(placement_.undo(x));
  }

  Bounds bounds() const override {
    const Bounds own = shape_->bounds();
    Bounds b;
    for (int corner = 0; corner < 8; ++corner)
      b.add(placement_.apply({corner & 1 ? own.max.x : own.min.x, corner & 2 ? own.max.y : own.min.y,
                              corner & 4 ? own.max.z : own.min.z}));
    return b;
  }

  ShapePtr in_frame(const Vec3d& origin, double spacing) const override {
    const Vec3d middle = shape_->bounds().middle();  // what turns about a place is far from its own origin
    Placement placement = placement_;
    placement.translation = Decimals(spacing)(placement_.apply(middle) - origin);
    return std::make_shared<Placed>(shape_->in_frame(middle, spacing / placement_.scale), placement);
  }

  void add_parts(std::vector<SurfacePart>& parts, const Placement& p) const override {
    shape_->add_parts(parts, p.after(placement_));
  }

 private:
  ShapePtr shape_;
  Placement placement_;
};

}  // namespace

ShapePtr make_hollow(ShapePtr shape, double thickness) {
  return std::make_shared<Hollow>(std::move(shape), thickness);
}

ShapePtr make_union(std::vector<ShapePtr> shapes) { return std::make_shared<Union>(std::move(shapes)); }

ShapePtr make_difference(ShapePtr shape, ShapePtr cut, double facet) {
  return std::make_shared<Difference>(std::move(shape), std::move(cut), facet);
}

ShapePtr make_placed(ShapePtr shape, const Placement& placement) {
  return std::make_shared<Placed>(std::move(shape), placement);
}

}  // namespace bedload
