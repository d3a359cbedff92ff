#pragma once
// Cross-section of a solid in a plane flow.

#include <utility>

#include "bedload/geometry/shape.hpp"

namespace bedload {

/// A slab of `thickness` (m) about the plane y = middle, throughout as the solid is in that plane.
class Slice final : public Shape {
 public:
  Slice(ShapePtr shape, double middle, double thickness)
      : shape_(std::move(shape)), middle_(middle), half_(thickness / 2) {}

  SurfacePoint nearest(const Vec3d& x) const override {
    SurfacePoint p = shape_->nearest({x.x, middle_, x.z});
    const double beyond = std::abs(x.y - middle_) - half_;
    if (beyond > std::fmax(p.distance, -1e-6 * half_)) {  // on its faces too, whatever the round-off
      const double side = x.y < middle_ ? -1 : 1;
      return {beyond, {x.x, middle_ + side * half_, x.z}, {0, side, 0}};
    }
    const Vec3d flat{p.normal.x, 0, p.normal.z};
    p.point.y = x.y;
    if (const double length = norm(flat); length > 0) p.normal = flat * (1 / length);
    return p;
  }
  Bounds bounds() const override {
    Bounds b = shape_->bounds();
    b.min.y = middle_ - half_, b.max.y = middle_ + half_;
    return b;
  }
  ShapePtr in_frame(const Vec3d& origin, double spacing) const override {
    return std::make_shared<Slice>(shape_->in_frame(origin, spacing), middle_ - origin.y, 2 * half_);
  }
  void add_parts(std::vector<SurfacePart>& parts, const Placement& placement) const override {
    shape_->add_parts(parts, placement);
  }

 private:
  ShapePtr shape_;
  double middle_, half_;
};

}  // namespace bedload
