#include "bedload/geometry/setup.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bedload/core/error.hpp"
#include "bedload/geometry/filter.hpp"
#include "bedload/geometry/lattice.hpp"
#include "bedload/geometry/orifice.hpp"
#include "bedload/geometry/packing.hpp"
#include "bedload/geometry/sampling.hpp"

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
  const double reach = config.fluid.kappa() * config.fluid.h();
  double nearest = r0;
  std::size_t at = 0;
  for (std::size_t a = 0; a < fluid.x.size(); ++a) {
    const double distance = wall_distance(body, fluid.x[a], reach, config.domain);
    if (distance < nearest) nearest = distance, at = a;
  }
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
  const double reach = config.fluid.kappa() * config.fluid.h(), slack = 1e-6 * config.fluid.dx;
  for (const WallBody& body : config.wall.bodies) {
    if (!body.stops_fluid()) continue;
    std::size_t count = 0, at = 0;
    for (std::size_t a = fluid.x.size(); a-- > 0;)
      if (wall_distance(body, fluid.x[a], reach, config.domain) < -slack) ++count, at = a;
    if (count == 0) {
      check_layer_is_clear(config, body, fluid, first);
      continue;
    }
    const Vec3d& x = fluid.x[at];
    throw KeyError(fill_key(first, at),
                   fmt::format("fluid.fill: {} fluid particles, the first at ({:g}, {:g}, {:g}) m, lie "
                               "inside wall.body \"{}\"{}",
                               count, x.x, x.y, x.z, body.name,
                               body.shape == "tank" || body.shape == "plane"
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

}  // namespace

Setup build_setup(const Config& config, std::vector<std::string>& warnings) {
  Setup setup;
  if (config.fluid.present) {
    const First first = add_fluid(config, setup.fluid, warnings);
    check_fluid_is_clear(config, setup.fluid, first);
    add_listed_fluid(config, setup.fluid, warnings);
    add_walls(config, setup.walls, warnings);
    if (config.domain.two_d) flatten(config, setup, first);
    add_inlets(config, setup.fluid, setup.walls, warnings);
  }
  if (config.grain.present) {
    check_filters(config, warnings);
    add_grains(config, setup.grains);
  }
  return setup;
}

}  // namespace bedload
