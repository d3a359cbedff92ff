#include "bedload/geometry/setup.hpp"

#include <fmt/format.h>

#include "bedload/core/error.hpp"
#include "bedload/geometry/filter.hpp"
#include "bedload/geometry/lattice.hpp"
#include "bedload/geometry/orifice.hpp"
#include "bedload/geometry/packing.hpp"
#include "bedload/geometry/sampling.hpp"

namespace bedload {
namespace {

/// Every fluid particle must start in the open.
void check_fluid_is_clear(const Config& config, const Setup::Fluid& fluid) {
  const double reach = config.fluid.kappa() * config.fluid.h(), slack = 1e-6 * config.fluid.dx;
  for (const WallBody& body : config.wall.bodies) {
    if (!body.stops_fluid()) continue;
    std::size_t count = 0, first = 0;
    for (std::size_t a = fluid.x.size(); a-- > 0;)
      if (wall_distance(body, fluid.x[a], reach, config.domain) < -slack) ++count, first = a;
    if (count == 0) continue;
    const Vec3d& x = fluid.x[first];
    throw CaseError(
        fmt::format("fluid.fill: {} fluid particles, the first at ({:g}, {:g}, {:g}) m, lie "
                    "inside wall.body \"{}\"",
                    count, x.x, x.y, x.z, body.name));
  }
}

}  // namespace

Setup build_setup(const Config& config, std::vector<std::string>& warnings) {
  Setup setup;
  if (config.fluid.present) {
    add_fluid(config, setup.fluid, warnings);
    check_fluid_is_clear(config, setup.fluid);
    add_listed_fluid(config, setup.fluid, warnings);
    add_walls(config, setup.walls, warnings);
    add_inlets(config, setup.fluid, setup.walls);
  }
  if (config.grain.present) {
    check_filters(config, warnings);
    add_grains(config, setup.grains);
  }
  return setup;
}

}  // namespace bedload
