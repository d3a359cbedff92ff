#include "bedload/geometry/lattice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bedload/core/error.hpp"
#include "bedload/geometry/depth.hpp"
#include "bedload/geometry/slice.hpp"
#include "geometry/fill_region.hpp"
#include "geometry/fill_velocity.hpp"
#include "geometry/first_where.hpp"
#include "geometry/shape_fill.hpp"

namespace bedload {
namespace {

constexpr double kMaxParticles = 2147483648.0;  // ids are 32 bits, one of them spare

void check_fill(const Config& config, std::size_t index) {
  const auto& fills = config.fluid.fills;
  const FluidFill& fill = fills[index];
  const std::string key = fmt::format("fluid.fill.{}", index);
  const double slack = 1e-6 * config.fluid.dx;
  for (int k = 0; k < 3; ++k) {
    if (!(fill.max[k] > fill.min[k]))
      throw KeyError(key + ".max", fmt::format("fluid.fill {}: max {} = {:g} m must exceed min {} = {:g} m",
                                               index + 1, "xyz"[k], fill.max[k], "xyz"[k], fill.min[k]));
    if (fill.solid.shape) continue;
    if (fill.min[k] < config.domain.min[k] - slack || fill.max[k] > config.domain.max[k] + slack)
      throw KeyError(key, fmt::format("fluid.fill {}: its box runs from {} = {:g} to {:g} m, the domain only "
                                      "from {:g} to {:g} m",
                                      index + 1, "xyz"[k], fill.min[k], fill.max[k], config.domain.min[k],
                                      config.domain.max[k]));
  }
  for (std::size_t other = 0; other < index; ++other) {
    // shapes are looked at particle by particle, as are those listed
    bool apart = fill.solid.shape || fills[other].solid.shape || !fills[other].file.empty();
    for (int k = 0; k < 3; ++k)
      apart |= fill.min[k] > fills[other].max[k] - slack || fills[other].min[k] > fill.max[k] - slack;
    if (!apart)
      throw KeyError(key, fmt::format("fluid.fill {} overlaps fluid.fill {}", index + 1, other + 1));
  }
}

/// The solid that `body` takes from a fill in which it stands; none of what may hold fluid, for which side of
/// it was meant the case has to state.
ShapePtr solid_in_fluid(const Config& config, const WallBody& body) {
  if (!body.stops_fluid() || body.single_layer()) return nullptr;
  if (body.shape == WallShape::box) {
    Vec3d min = body.min, max = body.max;
    for (int k = 0; k < 3; ++k) {  // continues beyond the faces of a period
      if (!config.domain.periodic[k]) continue;
      if (min[k] <= config.domain.min[k]) min[k] -= config.domain.max[k] - config.domain.min[k];
      if (max[k] >= config.domain.max[k]) max[k] += config.domain.max[k] - config.domain.min[k];
    }
    return make_box(min, max);
  }
  for (const ShapeConfig& shape : config.shapes)
    if (shape.name == body.shape.name() && (shape.kind == ShapeKind::hollow || shape.kind == ShapeKind::pipe))
      return nullptr;
  return body.solid.shape;
}

/// What is left of a fill between the bodies that stand in its particles, from `begin` on; none: all of it.
ShapePtr left_between_bodies(const Config& config, const FluidFill& fill, const Setup::Fluid& fluid,
                             std::size_t begin, std::string& names) {
  std::vector<ShapePtr> standing;
  for (const WallBody& body : config.wall.bodies) {
    const ShapePtr solid = solid_in_fluid(config, body);
    const auto inside = [&](const Vec3d& x) { return solid->distance(x) < -1e-6 * config.fluid.dx; };
    if (!solid || first_where(begin, fluid.x.size(), [&](std::size_t a) { return inside(fluid.x[a]); }) ==
                      fluid.x.size())
      continue;
    standing.push_back(solid);
    names += (names.empty() ? "\"" : ", \"") + body.name + '"';
  }
  if (standing.empty()) return nullptr;
  return make_difference(fill.solid.shape ? fill.solid.shape : make_box(fill.min, fill.max),
                         make_union(std::move(standing)));
}

/// Adds `count` particles, the n-th at place(n).
template <class Place>
void add_places(Setup::Fluid& fluid, std::size_t count, double mass, const FillVelocity& velocity,
                const Place& place) {
  const std::size_t begin = fluid.x.size();
  fluid.x.resize(begin + count), fluid.v.resize(begin + count), fluid.mass.resize(begin + count, mass);
  in_stretches(count, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const Vec3d x = place(n);
      fluid.x[begin + n] = x, fluid.v[begin + n] = velocity(x);
    }
  });
}

void add_shape(const Config& config, const FluidFill& fill, std::size_t index, Setup::Fluid& fluid) {
  double volume = 0;
  const double dx = config.fluid.dx;
  const Slice slice(fill.solid.shape, config.domain.middle(), dx);
  const Shape& shape = config.domain.two_d ? static_cast<const Shape&>(slice) : *fill.solid.shape;
  const auto places = fill_shape(shape, upwards(config.gravity), fill.level, dx, volume);
  volume *= config.domain.spacing_along(1, dx) / dx;
  const auto fail = [&](const std::string& why) {
    throw KeyError(fmt::format("fluid.fill.{}{}", index, fill.shape.empty() ? "" : ".shape"),
                   fmt::format("fluid.fill {}: {}", index + 1, why));
  };
  if (places.empty())
    fail(fmt::format("{} has no space for a particle of {:g} m",
                     fill.shape.empty() ? "what its bodies leave" : "shape \"" + fill.shape + '"',
                     config.fluid.dx));
  const FillVelocity velocity(fill, index);
  const double mass = config.fluid.rho0 * volume / double(places.size());
  add_places(fluid, places.size(), mass, velocity, [&](std::size_t n) {
    const Vec3d& x = places[n];
    for (int k = 0; k < 3; ++k)
      if (x[k] < config.domain.min[k] || x[k] > config.domain.max[k])
        fail(fmt::format("shape \"{}\" reaches to ({:g}, {:g}, {:g}) m, outside the domain", fill.shape, x.x,
                         x.y, x.z));
    return x;
  });
}

/// No particle may lie in what another fill occupies; `first`: of each fill. Boxes have been compared as
/// such.
void check_shapes(const Config& config, const Setup::Fluid& fluid, const std::vector<std::size_t>& first) {
  const auto& fills = config.fluid.fills;
  const Vec3d up = upwards(config.gravity);
  for (std::size_t other = 0; other < fills.size(); ++other)
    for (std::size_t index = 0; index < fills.size(); ++index) {
      if (index == other || !(fills[index].solid.shape || fills[other].solid.shape)) continue;
      const std::size_t at = first_where(first[index], first[index + 1], [&](std::size_t a) {
        return depth_in(fills[other], up, fluid.x[a]) > 0.1 * config.fluid.dx;
      });
      if (at == first[index + 1]) continue;
      const Vec3d& x = fluid.x[at];
      throw KeyError(fmt::format("fluid.fill.{}", std::max(index, other)),
                     fmt::format("fluid.fill {} overlaps fluid.fill {} at ({:g}, {:g}, {:g}) m",
                                 std::max(index, other) + 1, std::min(index, other) + 1, x.x, x.y, x.z));
    }
}

void add_box(const Config& config, const FluidFill& fill, std::size_t index, Setup::Fluid& fluid,
             std::vector<std::string>& warnings) {
  const double dx = config.fluid.dx;
  std::array<Cells, 3> cells;
  double wanted = 1, volume = 1;
  for (int k = 0; k < 3; ++k) {
    cells[k] = fit_cells(fill.min[k], fill.max[k], config.domain.spacing_along(k, dx));
    wanted *= double(cells[k].count);
    volume *= fill.max[k] - fill.min[k];
    if (std::abs(cells[k].step / config.domain.spacing_along(k, dx) - 1) > 0.05)
      warnings.push_back(
          fmt::format("fluid.fill {}: {:g} m along {} is not near a multiple of fluid.dx = "
                      "{:g} m; {} layers {:g} m apart are placed",
                      index + 1, fill.max[k] - fill.min[k], "xyz"[k], dx, cells[k].count, cells[k].step));
  }
  if (double(fluid.x.size()) + wanted >= kMaxParticles)
    throw KeyError("fluid.dx",
                   fmt::format("fluid.dx = {:g} m makes {:.3g} fluid particles: must be fewer than 2^31", dx,
                               double(fluid.x.size()) + wanted));

  const FillVelocity velocity(fill, index);
  const double mass = config.fluid.rho0 * volume / wanted;
  add_places(fluid, std::size_t(cells[0].count * cells[1].count * cells[2].count), mass, velocity,
             [&](std::size_t n) {
               const auto i = std::int64_t(n) % cells[0].count, row = std::int64_t(n) / cells[0].count;
               return Vec3d{cells[0].centre(i), cells[1].centre(row % cells[1].count),
                            cells[2].centre(row / cells[1].count)};
             });
}

/// The fluid of one fill, around the bodies that stand in it.
void add_fill(const Config& config, std::size_t index, Setup::Fluid& fluid,
              std::vector<std::string>& warnings, std::vector<std::string>& notes) {
  FluidFill fill = config.fluid.fills[index];
  const std::size_t begin = fluid.x.size();
  if (fill.solid.shape)
    add_shape(config, fill, index, fluid);
  else
    add_box(config, fill, index, fluid, warnings);

  std::string names;
  const std::size_t all = fluid.x.size() - begin;
  fill.solid.shape = left_between_bodies(config, fill, fluid, begin, names);
  if (!fill.solid.shape) return;
  for (auto* values : {&fluid.x, &fluid.v}) values->resize(begin);
  fluid.mass.resize(begin);
  add_shape(config, fill, index, fluid);
  notes.push_back(fmt::format("fluid.fill {}: leaves out wall.body {}, {} of {} particles", index + 1, names,
                              all - (fluid.x.size() - begin), all));
}

}  // namespace

std::vector<std::size_t> add_fluid(const Config& config, Setup::Fluid& fluid,
                                   std::vector<std::string>& warnings, std::vector<std::string>& notes) {
  std::vector<std::size_t> first;
  for (std::size_t index = 0; index < config.fluid.fills.size(); ++index) {
    first.push_back(fluid.x.size());
    if (!config.fluid.fills[index].file.empty()) continue;
    check_fill(config, index);
    add_fill(config, index, fluid, warnings, notes);
    fluid.fill.resize(fluid.x.size(), std::uint32_t(index));
  }
  first.push_back(fluid.x.size());
  check_shapes(config, fluid, first);
  return first;
}

}  // namespace bedload
