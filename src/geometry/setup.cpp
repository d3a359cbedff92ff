#include "bedload/geometry/setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "bedload/core/error.hpp"
#include "bedload/geometry/filter.hpp"
#include "bedload/geometry/lattice.hpp"
#include "bedload/geometry/nodes.hpp"
#include "bedload/geometry/orifice.hpp"
#include "bedload/geometry/packing.hpp"
#include "bedload/geometry/sampling.hpp"
#include "first_where.hpp"
#include "place_cells.hpp"

namespace bedload {
namespace {

using First = std::vector<std::size_t>;  ///< particle of each fluid.fill, as add_fluid returns them

/// The key of the fill that a fluid particle belongs to.
std::string fill_key(const First& first, std::size_t particle) {
  if (particle >= first.back()) return "fluid.fill";  // of those from files
  const auto after = std::upper_bound(first.begin(), first.end(), particle);
  return fmt::format("fluid.fill.{}", after - first.begin() - 1);
}

/// What begins within reach of a single layer would be thrown off.
void check_layer_is_clear(const Config& config, const WallBody& body, const Setup::Fluid& fluid,
                          const First& first) {
  if (!body.single_layer()) return;
  const double dx = config.fluid.dx, r0 = body.force == LayerForce::monaghan ? config.wall.layer_r0 : dx;
  const double reach = config.fluid.reach();
  std::pair<double, std::size_t> found{r0, 0};  // distance, particle
  std::mutex mutex;
  in_stretches(fluid.x.size(), [&](std::size_t begin, std::size_t end) {
    std::pair<double, std::size_t> here{r0, 0};
    for (std::size_t a = begin; a < end; ++a) {
      const double distance = wall_distance(body, fluid.x[a], reach, config.domain);
      if (distance < here.first) here = {distance, a};
    }
    const std::lock_guard lock(mutex);
    if (here.first < r0) found = std::min(found, here);
  });
  const auto [nearest, at] = found;
  if (nearest < 0.9 * r0)
    throw KeyError(
        fill_key(first, at),
        fmt::format(
            "fluid.fill: particles begin {:.3g} m from wall.body \"{}\", whose single layer throws off "
            "what is nearer than {:g} m; let the fill begin {:g} m from it",
            nearest, body.name, r0, r0 - 0.5 * dx));
}

/// Every fluid particle must start in the open.
void check_fluid_is_clear(const Config& config, const Setup::Fluid& fluid, const First& first) {
  const double reach = config.fluid.reach(), slack = 1e-6 * config.fluid.dx;
  for (const WallBody& body : config.wall.bodies) {
    if (!body.stops_fluid()) continue;
    std::atomic<std::size_t> count = 0;
    const auto inside = [&](std::size_t a) {
      return wall_distance(body, fluid.x[a], reach, config.domain) < -slack;
    };
    in_stretches(fluid.x.size(), [&](std::size_t begin, std::size_t end) {
      std::size_t here = 0;
      for (std::size_t a = begin; a < end; ++a) here += inside(a);
      if (here > 0) count += here;
    });
    if (count == 0) {
      check_layer_is_clear(config, body, fluid, first);
      continue;
    }
    const std::size_t at = first_where(0, fluid.x.size(), inside);
    const Vec3d& x = fluid.x[at];
    throw KeyError(fill_key(first, at),
                   fmt::format("fluid.fill: {} fluid particles, the first at ({:g}, {:g}, {:g}) m, lie "
                               "inside wall.body \"{}\"{}",
                               count.load(), x.x, x.y, x.z, body.name,
                               body.shape == WallShape::tank || body.shape == WallShape::plane
                                   ? ""
                                   : "; fill a shape of kind \"difference\" that leaves it out"));
  }
}

/// Everything to the middle of a plane flow.
void flatten(const Config& config, Setup& setup, const First& first) {
  for (std::size_t a = 0; a < setup.fluid.v.size(); ++a)
    if (const double v = setup.fluid.v[a].y; v != 0)
      throw KeyError(
          fill_key(first, a),
          fmt::format("fluid.fill: a velocity along y of {:g} m/s must be 0 in a plane flow (domain.two_d)",
                      v));
  for (auto* places : {&setup.fluid.x, &setup.walls.x, &setup.walls.mirror})
    for (Vec3d& x : *places) x.y = config.domain.middle();
}

/// The particle nearest to x of those within `reach` (m) that are not `gone`; none: their number.
std::size_t nearest(const PlaceCells& cells, const Vec3d& x, double reach, const std::vector<bool>& gone) {
  double least = reach * reach;
  std::size_t found = gone.size();
  cells.any(x, reach, [&](std::size_t a, double r2) {
    if (!gone[a] && (r2 < least || (r2 == least && a < found))) least = r2, found = a;
    return false;
  });
  return found;
}

/// Takes out the fluid particle nearest to each grain of fills with replaces_fluid. Those that are left of
/// its fluid.fill share its volume, so that fluid and grains still fill the space together.
void replace_fluid(const Config& config, const Setup::Grains& grains, Setup::Fluid& fluid) {
  const auto& fills = config.grain.fills;
  if (std::none_of(fills.begin(), fills.end(), [](const GrainFill& fill) { return fill.replaces_fluid; }))
    return;
  const PlaceCells cells(config.domain, config.fluid.dx, fluid.x);
  std::vector<bool> gone(fluid.x.size(), false);
  std::vector<double> was(config.fluid.fills.size()), left(config.fluid.fills.size());
  for (std::size_t i = 0; i < grains.x.size(); ++i) {
    if (!fills[grains.fill[i]].replaces_fluid) continue;
    const Vec3d& x = grains.x[i];
    const std::size_t at = nearest(cells, x, config.fluid.dx, gone);
    if (at == fluid.x.size())
      throw KeyError(
          fmt::format("grain.fill.{}.replaces_fluid", grains.fill[i]),
          fmt::format("grain.fill {}: no fluid particle lies within fluid.dx of its grain at ({:g}, {:g}, "
                      "{:g}) m that it could replace",
                      grains.fill[i] + 1, x.x, x.y, x.z));
    gone[at] = true;
  }
  for (std::size_t a = 0; a < gone.size(); ++a) {
    was[fluid.fill[a]] += fluid.mass[a];
    if (!gone[a]) left[fluid.fill[a]] += fluid.mass[a];
  }
  std::size_t kept = 0;
  for (std::size_t a = 0; a < gone.size(); ++a) {
    if (gone[a]) continue;
    fluid.x[kept] = fluid.x[a], fluid.v[kept] = fluid.v[a], fluid.fill[kept] = fluid.fill[a];
    fluid.mass[kept++] = fluid.mass[a] * was[fluid.fill[a]] / left[fluid.fill[a]];
  }
  fluid.x.resize(kept), fluid.v.resize(kept), fluid.mass.resize(kept), fluid.fill.resize(kept);
}

}  // namespace

Setup build_setup(const Config& config, std::vector<std::string>& warnings, std::vector<std::string>* notes) {
  Setup setup;
  std::vector<std::string> unread;
  if (config.fluid.present && config.fluid.lattice()) {
    setup.nodes = place_nodes(config);
    if (config.grain.present) {
      check_filters(config, warnings);
      add_grains(config, setup.grains);
    }
    return setup;
  }
  if (config.fluid.present) {
    const First first = add_fluid(config, setup.fluid, warnings, notes ? *notes : unread);
    check_fluid_is_clear(config, setup.fluid, first);
    add_listed_fluid(config, setup.fluid, warnings);
    add_walls(config, setup.walls, warnings);
    if (config.domain.two_d) flatten(config, setup, first);
  }
  if (config.grain.present) {
    check_filters(config, warnings);
    add_grains(config, setup.grains);
    replace_fluid(config, setup.grains, setup.fluid);
  }
  if (config.fluid.present) add_inlets(config, setup.fluid, setup.walls, warnings);
  return setup;
}

}  // namespace bedload
