#pragma once
#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// Power of each term on the energy of a fluid particle and of the grains' share of it, W; and which of them
/// act.
struct FluidPowers {
  Real viscosity = 0, artificial_viscosity = 0;  ///< by friction at walls, too
  Real density_diffusion = 0;
  Real voids = 0;     ///< void relaxation, cavitation, and spreading of what overfills its volume
  Real pressure = 0;  ///< of all pairs, less what continuity takes from it
  Real3 shift;        ///< drift by shifting, walls apart, m/s
  bool shift_limited = false;
  bool fades = false;    ///< its pressure, beside a void of more than DensityPass::slack
  bool spreads = false;  ///< it overfills its volume
};

}  // namespace BL_SOLVER
