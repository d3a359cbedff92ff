#pragma once
// Cross-section of a solid in a plane flow.

#include "bedload/geometry/shape.hpp"

namespace bedload {

/// A slab of `thickness` (m) about the plane y = middle, throughout as the solid is in that plane.
class Slice final : public Shape {
 public:
  Slice(const Shape& shape, double middle, double thickness)
      : shape_(shape), middle_(middle), half_(thickness / 2) {}

  SurfacePoint nearest(const Vec3d& x) const override {
    SurfacePoint p = shape_.nearest({x.x, middle_, x.z});
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
    Bounds b = shape_.bounds();
    b.min.y = middle_ - half_, b.max.y = middle_ + half_;
    return b;
  }
  void add_parts(std::vector<SurfacePart>& parts, const Placement& placement) const override {
    shape_.add_parts(parts, placement);
  }

 private:
  const Shape& shape_;
  double middle_, half_;
};

}  // namespace bedload
