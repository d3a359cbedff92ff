#include "bedload/geometry/wall_surface.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "bedload/geometry/lattice.hpp"
#include "bedload/geometry/sampling.hpp"
#include "bedload/geometry/shape.hpp"
#include "bedload/geometry/shape_sampling.hpp"
#include "geometry/wall_faces.hpp"

namespace bedload {
namespace {

constexpr double kInfinity = Bounds::kInfinity;

/// What lies within half a thickness of the surface of a shape, so that its middle is that surface.
class Skin final : public Shape {
 public:
  Skin(ShapePtr shape, double thickness) : shape_(std::move(shape)), half_(thickness / 2) {}

  SurfacePoint nearest(const Vec3d& x) const override {
    const SurfacePoint p = shape_->nearest(x);
    const double side = p.distance < 0 ? -1 : 1;
    const Vec3d normal = side * p.normal;
    return {side * p.distance - half_, p.point + half_ * normal, normal};
  }
  Bounds bounds() const override { return shape_->bounds().grown(half_); }
  ShapePtr in_frame(const Vec3d& origin, double spacing) const override {
    return std::make_shared<Skin>(shape_->in_frame(origin, spacing), 2 * half_);
  }
  void add_parts(std::vector<SurfacePart>& parts, const Placement& placement) const override {
    shape_->add_parts(parts, placement);
  }

 private:
  ShapePtr shape_;
  double half_;
};

/// Sides of tanks and boxes, x- x+ y- y+ z- z+.
std::array<bool, 6> sides(const WallBody& body, const DomainConfig& domain) {
  WallBody all = body;
  if (body.shape == WallShape::box) all.faces.fill(true);
  return closed_faces(all, domain);
}

std::vector<Vec3d> sample_sides(const WallBody& body, double spacing, const DomainConfig& domain) {
  const auto closed = sides(body, domain);
  std::array<Cells, 3> cells;
  for (int k = 0; k < 3; ++k)
    cells[k] = fit_cells(body.min[k], body.max[k], domain.spacing_along(k, spacing));
  std::vector<Vec3d> points;
  for (int face = 0; face < 6; ++face) {
    if (!closed[face]) continue;
    const int k = face / 2, u = (k + 1) % 3, v = (k + 2) % 3;
    for (std::int64_t j = 0; j < cells[v].count; ++j)
      for (std::int64_t i = 0; i < cells[u].count; ++i) {
        Vec3d x;
        x[k] = face % 2 ? body.max[k] : body.min[k];
        x[u] = cells[u].centre(i), x[v] = cells[v].centre(j);
        points.push_back(x);
      }
  }
  return points;
}

/// The layer that sampling puts half a spacing behind a plane, moved onto it.
std::vector<Vec3d> sample_plane_surface(const WallBody& plane, double spacing, const DomainConfig& domain) {
  std::vector<Vec3d> points = sample_body(plane, spacing, spacing, domain);
  const Vec3d n = plane.normal / norm(plane.normal);
  for (Vec3d& x : points) x -= dot(x - plane.point, n) * n;
  return points;
}

/// Way through the solid from a place on its surface, against the normal there, m; infinite from `reach` on.
double chord(const Shape& shape, const SurfacePoint& from, double reach) {
  const double least = 1e-4 * reach;
  double way = least;
  for (double depth = least; depth > 0 && way < reach; way += std::max(depth, least))
    depth = -shape.distance(from.point - way * from.normal);
  return way < reach ? way : kInfinity;
}

}  // namespace

std::vector<Vec3d> sample_surface(const WallBody& body, double spacing, const DomainConfig& domain) {
  if (body.solid.shape)
    return sample_solid(std::make_shared<Skin>(body.solid.shape, spacing), spacing, spacing, domain);
  if (body.shape == WallShape::plane) return sample_plane_surface(body, spacing, domain);
  return sample_sides(body, spacing, domain);
}

Vec3d surface_point(const WallBody& body, const Vec3d& x, const DomainConfig& domain) {
  if (body.solid.shape) return body.solid.shape->nearest(x).point;
  if (body.shape == WallShape::plane)
    return x - dot(x - body.point, body.normal) / norm2(body.normal) * body.normal;
  const auto closed = sides(body, domain);
  Vec3d on = x;
  if (body.shape == WallShape::tank) {
    for (int k = 0; k < 3; ++k) {
      if (closed[2 * k]) on[k] = std::max(on[k], body.min[k]);
      if (closed[2 * k + 1]) on[k] = std::min(on[k], body.max[k]);
    }
    return on;
  }
  double least = kInfinity;
  for (int face = 0; face < 6; ++face) {
    const int k = face / 2;
    const double side = face % 2 ? body.max[k] : body.min[k];
    if (!closed[face] || std::abs(x[k] - side) >= least * (1 - 1e-9)) continue;  // the first of those alike
    least = std::abs(x[k] - side);
    on = x, on[k] = side;
  }
  return on;
}

SurfacePoint nearest_surface(const WallBody& body, const Vec3d& x, const DomainConfig& domain) {
  if (body.solid.shape) {
    const SurfacePoint from = body.solid.shape->nearest(x);
    return {from.distance, from.point, body.solid.shape->nearest(from.point).normal};
  }
  if (body.shape == WallShape::plane) {
    const Vec3d n = body.normal / norm(body.normal);
    const double height = dot(x - body.point, n);
    return {height, x - height * n, n};
  }
  const auto closed = sides(body, domain);
  SurfacePoint best{kInfinity, x, {}};
  for (int face = 0; face < 6; ++face) {
    if (!closed[face]) continue;
    const int axis = face / 2;
    const bool upper = face % 2;
    Vec3d on = x, normal;
    for (int k = 0; k < 3; ++k)
      if (!spans_period(body, domain, k)) on[k] = std::clamp(x[k], body.min[k], body.max[k]);
    on[axis] = upper ? body.max[axis] : body.min[axis];
    normal[axis] = upper == (body.shape == WallShape::box) ? 1 : -1;
    const double away = norm(x - on), side = dot(x - on, normal) < 0 ? -1 : 1;
    if (away < std::abs(best.distance) * (1 - 1e-9)) best = {side * away, on, normal};
  }
  return best;
}

double thickness(const WallBody& body, const std::vector<Vec3d>& points, double reach,
                 const DomainConfig& domain) {
  if (body.shape == WallShape::box) {
    double least = kInfinity;
    for (int k = 0; k < 3; ++k)
      if (!spans_period(body, domain, k)) least = std::min(least, body.max[k] - body.min[k]);
    return least < reach ? least : kInfinity;
  }
  if (!body.solid.shape || points.empty()) return kInfinity;
  constexpr std::size_t kMost = 400;  // places looked at
  std::vector<double> chords;
  const std::size_t stride = 1 + points.size() / kMost;
  for (std::size_t i = 0; i < points.size(); i += stride)
    chords.push_back(chord(*body.solid.shape, body.solid.shape->nearest(points[i]), reach));
  const auto twentieth = chords.begin() + std::ptrdiff_t(chords.size() / 20);
  std::nth_element(chords.begin(), twentieth, chords.end());
  return *twentieth;
}

}  // namespace bedload
