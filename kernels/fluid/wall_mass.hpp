#pragma once
#include "bedload/core/pack.hpp"

namespace bedload::inline BL_VARIANT {

/// Mass of a wall particle in the continuity of the fluid beside it, kg: what a frozen one carries, as fluid
/// does; others count at rho0. By the density of their pressure, a wall that slides past resting fluid would
/// change the fluid's density for as long as it slides. state: {M, P/rho^2, rho, 1 if frozen}.
template <class N>
BL_HD N continuity_mass(const Vec4<N>& state, Real rho0) {
  return select(state.w > N(0), state.x, quotient(state.x, state.z) * rho0);
}

}  // namespace bedload::inline BL_VARIANT
