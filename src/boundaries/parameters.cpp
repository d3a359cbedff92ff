#include "bedload/core/types.hpp"
#include "src/boundaries/parameters.hpp"

#include "bedload/case/config.hpp"

namespace BL_SOLVER {

OpenBoundaryParameters open_boundary_parameters(const Config& config) {
  OpenBoundaryParameters p{.has_fluid = config.fluid.present,
                           .has_grains = config.grain.present,
                           .domain = config.domain,
                           .fluid = config.fluid,
                           .outlets = config.outlets,
                           .sources = {},
                           .materials = config.grain.all_materials(),
                           .walls = config.wall.bodies,
                           .d_max = config.grain.d_max};
  for (std::size_t i = 0; i < config.grain_inlets.size(); ++i) p.sources.emplace_back(config, i);
  return p;
}

}  // namespace BL_SOLVER
