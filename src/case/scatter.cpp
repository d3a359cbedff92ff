// Free bodies of one shape at random places in a box: a shape and a body for each.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bedload/core/error.hpp"
#include "bedload/core/random.hpp"
#include "bedload/geometry/build_shape.hpp"
#include "bedload/geometry/shape.hpp"
#include "resolve.hpp"

namespace bedload {
namespace {

/// Radius of a sphere about the middle of its bounds that holds the shape, m: from the cells of a raster that
/// the shape reaches into.
double radius_around(const Shape& shape) {
  constexpr int n = 24;
  const Bounds bounds = shape.bounds();
  const Vec3d side = (bounds.max - bounds.min) / n, middle = bounds.middle();
  const double half = norm(side) / 2;
  double radius = 0;
  for (int k = 0; k < n * n * n; ++k) {
    const Vec3d at{k % n + 0.5, k / n % n + 0.5, k / (n * n) + 0.5};
    const Vec3d x = bounds.min + Vec3d{at.x * side.x, at.y * side.y, at.z * side.z};
    if (shape.distance(x) < half) radius = std::max(radius, norm(x - middle) + half);
  }
  return std::min(radius, norm(bounds.max - bounds.min) / 2);
}

/// One of all rotations, or of those about y, each as likely as any other.
Quat<double> random_turn(CounterRandom& random, bool about_y) {
  using std::numbers::pi;
  if (about_y) return Quat<double>::from_rotation({0, 2 * pi * random.uniform(), 0});
  const double u = random.uniform(), a = 2 * pi * random.uniform(), b = 2 * pi * random.uniform();
  const double s = std::sqrt(1 - u), c = std::sqrt(u);  // of a point on the sphere in four dimensions
  return {s * std::sin(a), s * std::cos(a), c * std::sin(b), c * std::cos(b)};
}

/// Places in the box, farther apart than `apart` (m).
std::vector<Vec3d> random_places(const ScatterConfig& s, const Vec3d& lo, const Vec3d& hi, double apart,
                                 CounterRandom& random) {
  constexpr int tries = 20000;  // for each
  std::vector<Vec3d> places;
  for (int failed = 0; std::int64_t(places.size()) < s.count && failed < tries;) {
    Vec3d x;
    for (int k = 0; k < 3; ++k) x[k] = lo[k] + (hi[k] - lo[k]) * random.uniform();
    const bool free = std::all_of(places.begin(), places.end(),
                                  [&](const Vec3d& other) { return norm2(x - other) >= apart * apart; });
    if (free) places.push_back(x), failed = 0;
    if (!free) ++failed;
  }
  return places;
}

void check(const Config& c, const WallBody& body, const Value& root, const std::string& path) {
  const FreeConfig& f = body.free;
  if (body.shape.choice())
    reject(root, path + ".shape", fmt::format("\"{}\"", body.shape.name()),
           "must be the name of a [[shape]] with free.scatter");
  for (const auto& [key, given] : {std::pair{"centre_of_mass", !f.centre_of_mass.empty()},
                                   {"inertia", !f.inertia.empty()},
                                   {"point", !f.point.empty()},
                                   {"contact", !f.balls.empty()}})
    if (given)
      throw CaseError(
          fmt::format("{}: wall.body.free.{} must be left out with free.scatter, whose bodies lie apart",
                      nearest_value(root, path + ".free." + key).place(), key));
  for (int k = 0; k < 3; ++k)
    if (!c.domain.flat(k) && !(f.scatter.min[k] < f.scatter.max[k]))
      throw CaseError(fmt::format("{}: wall.body.free.scatter.max must exceed min along every axis",
                                  nearest_value(root, path + ".free.scatter.max").place()));
}

}  // namespace

void resolve_scattered_bodies(Config& c, const Value& root) {
  const std::size_t given = c.wall.bodies.size();
  for (std::size_t i = 0; i < given; ++i) {
    if (!c.wall.bodies[i].free.scatter.present) continue;
    const std::string path = fmt::format("wall.body.{}", i);
    const WallBody body = c.wall.bodies[i];
    const ScatterConfig& s = body.free.scatter;
    check(c, body, root, path);
    const Solid solid =
        shape_named(c, body.shape.name(), root, path + ".shape", "must be the name of a [[shape]]");
    const double radius = radius_around(*solid.shape);
    const Vec3d middle = solid.shape->bounds().middle();
    Vec3d lo = s.min, hi = s.max;
    for (int k = 0; k < 3; ++k) {
      lo[k] += radius, hi[k] -= radius;
      if (c.domain.flat(k)) lo[k] = hi[k] = middle[k];
    }
    CounterRandom random(s.seed, i);
    std::vector<Vec3d> places;
    if (lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z)
      places = random_places(s, lo, hi, 2 * radius + s.gap, random);
    if (std::int64_t(places.size()) < s.count)
      reject(root, path + ".free.scatter.count", fmt::format("{}", s.count),
             fmt::format("must fit into the box at random: {} did, of spheres of {:.3g} m around each; make "
                         "it larger, or "
                         "several layers of it",
                         places.size(), 2 * radius));
    for (std::size_t n = 0; n < places.size(); ++n) {
      WallBody one = body;
      one.free.scatter = {};
      one.name = fmt::format("{}_{}", body.name, n + 1);
      ShapeConfig shape;
      shape.name = one.name, shape.kind = ShapeKind::union_, shape.of = {body.shape.name()};
      const Quat<double> turn = s.turned ? random_turn(random, c.domain.two_d) : Quat<double>{};
      const Vec3d axis{turn.x, turn.y, turn.z};
      if (norm(axis) > 0)
        shape.turn_axis = axis / norm(axis),
        shape.turn_angle = 360 / std::numbers::pi * std::atan2(norm(axis), turn.w);
      shape.translate = places[n] - turn.rotate(middle);
      for (const ShapeConfig& other : c.shapes)
        if (other.name == shape.name)
          reject(root, path + ".name", fmt::format("\"{}\"", body.name),
                 fmt::format("must differ: there is a shape {} already", shape.name));
      shape.solid.shape = build_shape(shape, c.shapes, 0);
      c.shapes.push_back(shape);
      one.shape = ChosenOrNamed<WallShape>(shape.name);
      if (n == 0)
        c.wall.bodies[i] = one;
      else
        c.wall.bodies.push_back(one);
    }
  }
}

}  // namespace bedload
