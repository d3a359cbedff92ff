#include "src/coupling/parameters.hpp"

#include "bedload/case/config.hpp"
#include "src/boundaries/orifices.hpp"

namespace BL_SOLVER {

CouplingParameters coupling_parameters(const Config& config) {
  return {
      .couple = config.couple,
      .fluid = config.fluid,
      .materials = config.grain.all_materials(),
      .orifices = orifices_of(config.inlets, config.wall.bodies.size(), config.fluid.dx, config.domain),
      .largest_range = config.couple.farthest(config.fluid.kappa(), config.grain.d_min, config.grain.d_max),
      .drag_fraction = config.time.drag,
      .counts_grains = config.density.count_grains,
      .kT = config.fluid.model->thermal ? config.sdpd.kT * square(config.sdpd.force_scale[3]) : 0,
      .seed = config.seed};
}

}  // namespace BL_SOLVER
