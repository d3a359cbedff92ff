#pragma once
// Common to all drag laws. A law has `law`, its enumerator, and
//   Real K(eps, d, rho, mu, w): drag on one grain per slip velocity, kg/s,
// at porosity eps in (0, 1], diameter d (m), intrinsic fluid density rho (kg/m3), viscosity
// mu > 0 (Pa s) and interstitial slip speed w >= 0 (m/s). Every K is finite at w = 0 and eps = 1.

#include "bedload/case/choices.hpp"
#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// Reynolds number of the superficial slip.
BL_HD Real grain_reynolds(Real eps, Real d, Real rho, Real mu, Real w) { return rho * d * eps * w / mu; }

/// Drag of a single sphere over its Stokes drag: Schiller and Naumann, then C_D = 0.44 [schiller33].
BL_HD Real sphere_drag_factor(Real Re) {
  return max_of(1 + Real(0.15) * std::pow(Re, Real(0.687)), Real(0.44 / 24) * Re);
}

BL_HD Real stokes_drag(Real d, Real mu) { return 3 * kPi * mu * d; }

}  // namespace BL_SOLVER
