#include "bedload/geometry/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "bedload/core/error.hpp"
#include "geometry/decimals.hpp"
#include "geometry/surface_point.hpp"

namespace bedload {
namespace {

void check_positive(const char* shape, const char* what, double value) {
  if (!(value > 0 && std::isfinite(value)))
    throw CaseError(fmt::format("{}: {} = {:g} m must be above 0", shape, what, value));
}

class Box : public Shape {
 public:
  Box(const Vec3d& min, const Vec3d& max) : box_{min, max} {
    for (int k = 0; k < 3; ++k)
      if (!(max[k] > min[k] && std::isfinite(max[k] - min[k])))
        throw CaseError(fmt::format("box: max {} = {:g} m must exceed min {} = {:g} m", "xyz"[k], max[k],
                                    "xyz"[k], min[k]));
  }

  SurfacePoint nearest(const Vec3d& x) const override {
    Vec3d point = x;
    int side = 0;
    double beyond_side = -Bounds::kInfinity;
    for (int k = 0; k < 3; ++k) {
      point[k] = std::clamp(x[k], box_.min[k], box_.max[k]);
      const double beyond = std::max(box_.min[k] - x[k], x[k] - box_.max[k]);
      if (beyond > beyond_side) beyond_side = beyond, side = k;
    }
    const bool upper = x[side] - box_.max[side] >= box_.min[side] - x[side];
    Vec3d normal;
    normal[side] = upper ? 1 : -1;
    if (beyond_side <= 0) point[side] = upper ? box_.max[side] : box_.min[side];
    return seen_from(x, point, beyond_side <= 0, normal);
  }

  Bounds bounds() const override { return box_; }

  ShapePtr in_frame(const Vec3d& origin, double spacing) const override {
    const Decimals decimals(spacing);
    Vec3d min = box_.min - origin, max = box_.max - origin;
    for (int k = 0; k < 3; ++k)
      if (decimals(min[k]) < decimals(max[k])) min[k] = decimals(min[k]), max[k] = decimals(max[k]);
    return std::make_shared<Box>(min, max);
  }

  void add_parts(std::vector<SurfacePart>& parts, const Placement& p) const override {
    SurfacePart part{.kind = SurfacePart::Kind::box, .centre = p.apply((box_.min + box_.max) / 2)};
    part.rotation = p.rotation;
    part.half = p.scale / 2 * (box_.max - box_.min);
    parts.push_back(part);
  }

 private:
  Bounds box_;
};

/// Turns the z axis to the unit vector `to`.
Quat<double> rotation_to(const Vec3d& to) {
  const Vec3d z{0, 0, 1}, axis = cross(z, to);
  const double sine = norm(axis), angle = std::atan2(sine, to.z);
  return Quat<double>::from_rotation(angle * (sine > 0 ? axis / sine : Vec3d{1, 0, 0}));
}

/// Sphere, or a capsule about the line from a to b.
class Capsule : public Shape {
 public:
  Capsule(const Vec3d& a, const Vec3d& b, double radius) : a_(a), axis_(b - a), radius_(radius) {}

  SurfacePoint nearest(const Vec3d& x) const override {
    const double length2 = norm2(axis_);
    const double t = length2 > 0 ? std::clamp(dot(x - a_, axis_) / length2, 0.0, 1.0) : 0;
    const Vec3d out = x - (a_ + t * axis_);
    const double r = norm(out);
    const Vec3d normal = r > 0 ? out / r : perpendicular(axis_);
    return {r - radius_, x + (radius_ - r) * normal, normal};
  }

  Bounds bounds() const override {
    Bounds b;
    b.add(a_), b.add(a_ + axis_);
    return b.grown(radius_);
  }

  ShapePtr in_frame(const Vec3d& origin, double spacing) const override {
    const Decimals decimals(spacing);
    const Vec3d a = decimals(a_ - origin);
    return std::make_shared<Capsule>(a, a + decimals(axis_), radius_);
  }

  void add_parts(std::vector<SurfacePart>& parts, const Placement& p) const override {
    SurfacePart part{.kind = SurfacePart::Kind::capsule, .centre = p.apply(a_ + axis_ / 2)};
    part.radius = p.scale * radius_;
    const double length = norm(axis_);
    if (length > 0) part.rotation = p.rotation * rotation_to(axis_ / length);
    part.half = {part.radius, part.radius, p.scale * length / 2};
    parts.push_back(part);
  }

 private:
  Vec3d a_, axis_;
  double radius_;
};

/// What a polygon in the half-plane (z along the axis, r away from it) sweeps about the axis. The nearest
/// point lies in the half-plane of the place itself, so its distance there is the distance in space.
class Revolution : public Shape {
 public:
  using Corner = SurfacePart::Corner;

  /// `profile` is closed; the solid lies to its right, with r upwards and z to the right.
  Revolution(const Vec3d& origin, const Vec3d& axis, std::vector<Corner> profile)
      : origin_(origin), axis_(axis), profile_(std::move(profile)) {}

  SurfacePoint nearest(const Vec3d& x) const override {
    const Vec3d from_origin = x - origin_;
    const double z = dot(from_origin, axis_);
    const Vec3d away = from_origin - z * axis_;
    const double r = norm(away);
    const Vec3d radial = r > 0 ? away / r : perpendicular(axis_);

    double least2 = Bounds::kInfinity;
    Corner point{}, normal{};
    bool inside = false;
    for (std::size_t n = 0; n < profile_.size(); ++n) {
      const Corner &p = profile_[n], &q = profile_[(n + 1) % profile_.size()];
      if (p.r == 0 && q.r == 0) continue;  // on the axis: no surface
      const double dz = q.z - p.z, dr = q.r - p.r, length2 = dz * dz + dr * dr;
      const double t = std::clamp(((z - p.z) * dz + (r - p.r) * dr) / length2, 0.0, 1.0);
      const Corner c{p.z + t * dz, p.r + t * dr};
      const double d2 = (z - c.z) * (z - c.z) + (r - c.r) * (r - c.r), length = std::sqrt(length2);
      if (d2 < least2) least2 = d2, point = c, normal = {-dr / length, dz / length};
      if ((p.z <= z) != (q.z <= z) && r < p.r + (z - p.z) / dz * dr) inside = !inside;
    }
    return seen_from(x, place(point, radial), inside, normal.z * axis_ + normal.r * radial);
  }

  Bounds bounds() const override {
    Bounds b;
    for (const Corner& c : profile_) {
      Vec3d reach;  // of a circle across the axis
      for (int k = 0; k < 3; ++k) reach[k] = c.r * std::sqrt(std::max(0.0, 1 - axis_[k] * axis_[k]));
      b.add(place({c.z, 0}, {}) + reach), b.add(place({c.z, 0}, {}) - reach);
    }
    return b;
  }

  ShapePtr in_frame(const Vec3d& origin, double spacing) const override {
    const Decimals decimals(spacing), of_unit(0.01);
    const Vec3d axis = of_unit(axis_);
    std::vector<Corner> profile = profile_;
    for (Corner& c : profile) c.z = decimals.positive(c.z);
    return std::make_shared<Revolution>(decimals(origin_ - origin), axis / norm(axis), std::move(profile));
  }

  void add_parts(std::vector<SurfacePart>& parts, const Placement& p) const override {
    double lo = Bounds::kInfinity, hi = -lo, widest = 0;
    for (const Corner& c : profile_)
      lo = std::min(lo, c.z), hi = std::max(hi, c.z), widest = std::max(widest, c.r);
    const double middle = (lo + hi) / 2;
    SurfacePart part{.kind = SurfacePart::Kind::revolution, .centre = p.apply(place({middle, 0}, {}))};
    part.rotation = p.rotation * rotation_to(axis_);
    part.half = p.scale * Vec3d{widest, widest, (hi - lo) / 2};
    for (const Corner& c : profile_) part.profile.push_back({p.scale * (c.z - middle), p.scale * c.r});
    parts.push_back(part);
  }

 private:
  Vec3d place(const Corner& c, const Vec3d& radial) const { return origin_ + c.z * axis_ + c.r * radial; }

  Vec3d origin_, axis_;
  std::vector<Corner> profile_;
};

/// Length of the axis from a to b of `shape`, m.
double checked_length(const char* shape, const Vec3d& a, const Vec3d& b) {
  const double length = norm(b - a);
  if (!(length > 0 && std::isfinite(length)))
    throw CaseError(fmt::format("{}: its ends ({:g}, {:g}, {:g}) and ({:g}, {:g}, {:g}) m must lie apart",
                                shape, a.x, a.y, a.z, b.x, b.y, b.z));
  return length;
}

}  // namespace

ShapePtr make_box(const Vec3d& min, const Vec3d& max) { return std::make_shared<Box>(min, max); }

ShapePtr make_sphere(const Vec3d& centre, double radius) {
  check_positive("sphere", "radius", radius);
  return std::make_shared<Capsule>(centre, centre, radius);
}

ShapePtr make_capsule(const Vec3d& a, const Vec3d& b, double radius) {
  check_positive("capsule", "radius", radius);
  return std::make_shared<Capsule>(a, b, radius);
}

ShapePtr make_cylinder(const Vec3d& a, const Vec3d& b, double radius) {
  check_positive("cylinder", "radius", radius);
  const double length = checked_length("cylinder", a, b);
  const std::vector<Revolution::Corner> profile{{0, 0}, {0, radius}, {length, radius}, {length, 0}};
  return std::make_shared<Revolution>(a, (b - a) / length, profile);
}

ShapePtr make_cone(const Vec3d& a, const Vec3d& b, double radius_a, double radius_b) {
  check_positive("cone", "the larger radius", std::max(radius_a, radius_b));
  if (!(radius_a >= 0 && radius_b >= 0))
    throw CaseError(fmt::format("cone: radius {:g} m must not be negative", std::min(radius_a, radius_b)));
  const double length = checked_length("cone", a, b);
  const std::vector<Revolution::Corner> profile{{0, 0}, {0, radius_a}, {length, radius_b}, {length, 0}};
  return std::make_shared<Revolution>(a, (b - a) / length, profile);
}

ShapePtr make_pipe(const Vec3d& a, const Vec3d& b, double inner_radius, double outer_radius, PipeEnds ends) {
  check_positive("pipe", "inner radius", inner_radius);
  if (!(outer_radius > inner_radius && std::isfinite(outer_radius)))
    throw CaseError(fmt::format("pipe: outer radius = {:g} m must exceed inner radius = {:g} m", outer_radius,
                                inner_radius));
  const double length = checked_length("pipe", a, b), thickness = outer_radius - inner_radius;
  std::vector<Revolution::Corner> profile;
  if (ends == PipeEnds::closed || ends == PipeEnds::closed_a)
    profile = {{0, inner_radius}, {0, 0}, {-thickness, 0}, {-thickness, outer_radius}};
  else
    profile = {{0, inner_radius}, {0, outer_radius}};
  if (ends == PipeEnds::closed || ends == PipeEnds::closed_b)
    profile.insert(
        profile.end(),
        {{length + thickness, outer_radius}, {length + thickness, 0}, {length, 0}, {length, inner_radius}});
  else
    profile.insert(profile.end(), {{length, outer_radius}, {length, inner_radius}});
  return std::make_shared<Revolution>(a, (b - a) / length, profile);
}

}  // namespace bedload
