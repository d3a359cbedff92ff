#pragma once
#include "bedload/core/records.hpp"

namespace BL_SOLVER {

/// Mass with which a wall particle enters the continuity of the fluid, kg: its own if frozen, else its volume
/// times rho0. With the density of the extrapolated pressure instead, a wall that slides past fluid at rest
/// would steadily change the density of that fluid.
template <class N>
BL_HD N continuity_mass(const WallState<N>& state, Real rho0) {
  return select(state.frozen > N(0), state.mass, quotient(state.mass, state.rho) * rho0);
}

}  // namespace BL_SOLVER
