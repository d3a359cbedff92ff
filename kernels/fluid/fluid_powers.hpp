#pragma once
#include "bedload/core/types.hpp"

namespace bedload::inline BL_VARIANT {

/// Power of each term on the energy of a fluid particle and of the grains' share of it, W.
struct FluidPowers {
  Real viscosity = 0, artificial_viscosity = 0;  ///< by friction at walls, too
  Real density_diffusion = 0;
  Real voids = 0;     ///< void relaxation, cavitation, and spreading of what overfills its volume
  Real pressure = 0;  ///< of all pairs, less what continuity takes from it
};

}  // namespace bedload::inline BL_VARIANT
