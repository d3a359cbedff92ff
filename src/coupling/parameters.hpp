#pragma once
// Parameters of the exchange between grains and fluid.

#include <cstdint>
#include <vector>

#include "bedload/case/config/coupling.hpp"
#include "bedload/case/config/fluid.hpp"
#include "bedload/case/config/grains.hpp"
#include "kernels/boundaries/orifice.hpp"

namespace bedload {
struct Config;
}

namespace BL_SOLVER {

struct CouplingParameters {
  CouplingConfig couple;
  FluidProperties fluid;
  std::vector<GrainMaterial> materials;  ///< of grains, in the order of their numbers
  std::vector<Orifice> orifices;
  double largest_range = 0;    ///< as far as fluid is averaged around any grain, m
  double drag_fraction = 0;    ///< limit of a step over the relaxation time of drag
  bool counts_grains = false;  ///< the density sum of the fluid includes grains
  double kT = 0;               ///< temperature of the fluid, J
  std::uint64_t seed = 1;      ///< of noise
};
CouplingParameters coupling_parameters(const Config& config);

}  // namespace BL_SOLVER
