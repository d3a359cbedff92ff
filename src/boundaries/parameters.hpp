#pragma once
// Parameters of open boundaries.

#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/fluid.hpp"
#include "bedload/case/config/grains.hpp"
#include "bedload/case/config/openings.hpp"
#include "bedload/case/config/walls.hpp"
#include "bedload/core/types.hpp"
#include "bedload/geometry/grain_source.hpp"

namespace BL_SOLVER {

struct OpenBoundaryParameters {
  bool has_fluid = false, has_grains = false;
  DomainConfig domain;
  FluidProperties fluid;
  std::vector<OutletConfig> outlets;
  std::vector<GrainSource> sources;
  std::vector<GrainMaterial> materials;  ///< of grains, in the order of their numbers
  std::vector<WallBody> walls;           ///< inserted grains must be clear of them
  double d_max = 0;                      ///< of grains, m

  /// Of an inserted particle, kg.
  double fluid_mass() const { return fluid.rho0 * domain.cell_volume(fluid.dx); }
};
OpenBoundaryParameters open_boundary_parameters(const Config& config);

}  // namespace BL_SOLVER
