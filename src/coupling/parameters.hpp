#pragma once
// What the exchange between grains and fluid takes from a case.

#include <cstdint>
#include <vector>

#include "bedload/case/config/coupling.hpp"
#include "bedload/case/config/fluid.hpp"
#include "bedload/case/config/grains.hpp"
#include "kernels/boundaries/orifice.hpp"

namespace bedload {
struct Config;
}

namespace bedload::inline BL_VARIANT {

struct CouplingParameters {
  CouplingConfig couple;
  FluidProperties fluid;
  std::vector<GrainMaterial> materials;  ///< of grains, as they are numbered
  std::vector<Orifice> orifices;
  double drag_fraction = 0;    ///< of the time in which drag acts, that a step may take
  bool counts_grains = false;  ///< the fluid's density takes in grains
  double kT = 0;               ///< temperature of the fluid, J
  std::uint64_t seed = 1;      ///< of noise
};
CouplingParameters coupling_parameters(const Config& config);

}  // namespace bedload::inline BL_VARIANT
