// Free bodies of one shape at random places in a box, and those that stand for large grains: a shape and a
// body for each.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bedload/case/limits.hpp"
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

/// Places in the box, farther apart than `apart` (m), as many as fit of `count`.
std::vector<Vec3d> random_places(std::int64_t count, const Vec3d& lo, const Vec3d& hi, double apart,
                                 CounterRandom& random) {
  constexpr int tries = 20000;  // for each
  std::vector<Vec3d> places;
  for (int failed = 0; std::int64_t(places.size()) < count && failed < tries;) {
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

void take_shape(Config& c, WallBody& body, ShapeConfig& shape) {
  shape.solid.shape = build_shape(shape, c.shapes, 0);
  c.shapes.push_back(shape);
  body.shape = ChosenOrNamed<WallShape>(shape.name);
}

/// Whether the fluid flows around grains of diameter d, m.
bool flows_around(const Config& c, double d) {
  const double times = d / c.fluid.dx;
  if (c.grain.resolve == GrainResolve::all) return true;
  return times >= kResolved * (1 - 1e-3) ||
         (c.couple.between == BetweenSizes::resolved && times > kDragged * (1 + 1e-3));
}

/// The diameter of the grains of a fill, all of which the fluid flows around; 0: of none. m.
double resolved_diameter(const Config& c, const GrainFill& fill, const Value& root, const std::string& path) {
  if (!fill.file.empty() || !fill.clump.empty() || fill.rigid.present || !fill.every.empty()) return 0;
  // what is refused later
  if (!fill.material.empty() && c.grain.material(fill.material) == 0) return 0;
  for (const auto* each : {&fill.velocities, &fill.spins})
    if (!each->empty() && each->size() != fill.positions.size()) return 0;
  std::vector<SizeClass> sizes = fill.sizes;
  if (sizes.empty()) sizes = {{.d = c.grain.d}};
  double d = 0;
  for (const SizeClass& size : sizes) {
    const double most = size.kind == SizeKind::one_size ? size.d : size.d_max;
    if (most > 0 && flows_around(c, most)) d = most;
  }
  if (d == 0) return 0;
  const auto refuse = [&](const char* key, const std::string& must) {
    throw CaseError(
        fmt::format("{}: grain.fill.{} has grains of {:.4g} m, {:.3g} times fluid.dx, around which the fluid "
                    "flows: they must {} (or grain.resolve = \"none\")",
                    nearest_value(root, path + "." + key).place(), key, d, d / c.fluid.dx, must));
  };
  if (sizes.size() > 1 || sizes[0].kind != SizeKind::one_size)
    refuse("sizes", "be in a fill of their own, of one diameter");
  if (!fill.shape.empty()) refuse("shape", "come in a box or by positions");
  if (d < kDragged * (1 - 1e-3) * c.fluid.dx)
    refuse("sizes", fmt::format("be at least {:g} times as large", kDragged));
  return d;
}

/// Centres of the grains of a fill, of diameter d (m).
std::vector<Vec3d> places_of(const Config& c, const GrainFill& fill, double d, const Value& root,
                             const std::string& path, std::size_t number) {
  constexpr double kMost = 1000;  // bodies are moved one by one
  std::vector<Vec3d> places = fill.positions;
  if (fill.relative)
    for (Vec3d& x : places)
      for (int k = 0; k < 3; ++k) x[k] = c.domain.min[k] + x[k] * (c.domain.max[k] - c.domain.min[k]);
  double count = double(places.size());
  const double each = std::numbers::pi / 6 * d * d * d;
  if (places.empty()) {
    const Vec3d side = fill.max - fill.min;
    count = double(fill.count);
    if (fill.mass > 0)
      count = std::round(fill.mass / (each * c.grain.all_materials()[c.grain.material(fill.material)].rho));
    if (fill.packing_fraction > 0)
      count = std::round(fill.packing_fraction * side.x * side.y * side.z / each);
  }
  const auto refuse = [&](const std::string& must) {
    reject(root, path + ".count", fmt::format("{:.0f}", count), must);
  };
  if (!(count >= 1)) refuse("must be at least 1, from count, mass or packing_fraction");
  if (count > kMost) refuse(fmt::format("must be at most {:.0f} where the fluid flows around each", kMost));
  if (!places.empty()) return places;
  Vec3d lo = fill.min, hi = fill.max;
  for (int k = 0; k < 3; ++k) lo[k] += d / 2, hi[k] -= d / 2;
  CounterRandom random(c.grain.seed, number);
  if (lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z)
    places = random_places(std::int64_t(count), lo, hi, d, random);
  if (double(places.size()) < count)
    refuse(fmt::format("must fit into the box at random: {} did; make it larger, or several layers of it",
                       places.size()));
  return places;
}

}  // namespace

void resolve_large_grains(Config& c, const Value& root) {
  if (!c.grain.present || !c.fluid.present || c.fluid.lattice() || c.couple.mode == CouplingMode::off ||
      c.grain.resolve == GrainResolve::none)
    return;
  std::vector<GrainFill> left;
  std::vector<double> resolved;  // diameters
  for (std::size_t i = 0; i < c.grain.fills.size(); ++i) {
    resolved.push_back(resolved_diameter(c, c.grain.fills[i], root, fmt::format("grain.fill.{}", i)));
    if (resolved[i] == 0) left.push_back(c.grain.fills[i]);
  }
  if (left.size() == c.grain.fills.size()) return;
  const bool others = !left.empty() || !c.grain_inlets.empty();
  for (std::size_t i = 0; i < c.grain.fills.size(); ++i) {
    if (resolved[i] == 0) continue;
    const GrainFill& fill = c.grain.fills[i];
    const double d = resolved[i];
    const std::vector<Vec3d> places = places_of(c, fill, d, root, fmt::format("grain.fill.{}", i), i);
    const GrainMaterial of = c.grain.all_materials()[c.grain.material(fill.material)];
    for (std::size_t n = 0; n < places.size(); ++n) {
      WallBody body;
      body.name = fmt::format("resolved_{}_{}", i + 1, n + 1);
      body.type = c.wall.type, body.slip = c.wall.slip, body.force = c.wall.force;
      body.no_penetration = c.wall.no_penetration, body.repulsion = c.wall.repulsion;
      if (others) body.mu = of.mu, body.mu_r = of.mu_r, body.e = of.e, body.E = of.E, body.nu = of.nu;
      FreeConfig& f = body.free;
      f.present = !c.grain.fixed;
      f.density = of.rho, f.release_time = c.grain.release_time;
      f.velocity = fill.velocities.empty() ? fill.velocity : fill.velocities[n];
      f.spin = fill.spins.empty() ? fill.spin : fill.spins[n];
      f.E = of.E, f.nu = of.nu, f.mu = of.mu, f.e = of.e, f.mu_r = of.mu_r;
      ShapeConfig shape;
      shape.name = body.name, shape.kind = ShapeKind::sphere;
      shape.centre = places[n], shape.radius = d / 2;
      take_shape(c, body, shape);
      c.wall.bodies.push_back(body);
    }
  }
  if (others)
    c.grain.fills = left;
  else
    c.grain = {};
}

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
      places = random_places(s.count, lo, hi, 2 * radius + s.gap, random);
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
      take_shape(c, one, shape);
      if (n == 0)
        c.wall.bodies[i] = one;
      else
        c.wall.bodies.push_back(one);
    }
  }
}

}  // namespace bedload
