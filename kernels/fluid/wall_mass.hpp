#pragma once
#include "bedload/core/records.hpp"

namespace bedload::inline BL_VARIANT {

/// Mass of a wall particle in the continuity of the fluid beside it, kg: what a frozen one carries, as fluid
/// does; others count at rho0. By the density of their pressure, a wall that slides past resting fluid would
/// change the fluid's density for as long as it slides.
template <class N>
BL_HD N continuity_mass(const WallState<N>& state, Real rho0) {
  return select(state.frozen > N(0), state.mass, quotient(state.mass, state.rho) * rho0);
}

}  // namespace bedload::inline BL_VARIANT
