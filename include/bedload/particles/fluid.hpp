#pragma once
#include "bedload/particles/store.hpp"

namespace bedload::inline BL_VARIANT {

/// Fluid particles. Densities are superficial (rho~ = eps rho) unless said otherwise.
struct FluidStore : Store {
  FluidStore() : Store("fluid") {}

  Field<Id> id{*this, "id", "-", Lifetime::kept};
  Field<FluidPosition> x{*this, "x", "m", Lifetime::kept};
  Field<FluidPosition> x_list{*this, "x_list", "m", Lifetime::kept};  ///< where the neighbour lists were built
  Field<Real4> v_rho{*this, "v_rho", "m/s, kg/m3", Lifetime::kept};   ///< velocity, superficial density
  Field<Real> s{*this, "s", "-", Lifetime::kept};                     ///< superficial density / rho0 - 1
  Field<Real> mass{*this, "mass", "kg", Lifetime::kept};
  Field<Real> eps{*this, "porosity", "-", Lifetime::kept};
  Field<Real3> theta{*this, "theta", "m/s2", Lifetime::kept};   ///< pressure + physical viscosity
  Field<Real3> acc{*this, "acceleration", "m/s2", Lifetime::kept};  ///< theta + gravity + artificial and repulsive terms
  Field<Real3> xsph{*this, "xsph", "m/s", Lifetime::kept};      ///< added to the drift velocity
  Field<Real4> m_state{*this, "m_state", "kg, m5/(kg s2), kg/m3, Pa", Lifetime::kept};  ///< what pair loops read: mass, P/rho~2, intrinsic rho, P
  Field<Real3> drag_kick{*this, "drag_kick", "m/s", Lifetime::derived};  ///< by the drag of the grains, this step
  Field<Real3> acc_next{*this, "acc_next", "m/s2", Lifetime::derived};
  Field<Real> s_next{*this, "s_next", "-", Lifetime::derived};
  Field<Real> filled{*this, "filled", "-", Lifetime::derived};  ///< share of the kernel with fluid or wall in it
  Field<PairPosition> xp{*this, "xp", "m", Lifetime::derived};  ///< x as pair loops read it
  Field<Real3> reaction{*this, "reaction", "m/s2", Lifetime::derived};  ///< - pressure part of the force on grains / m
};

}  // namespace bedload::inline BL_VARIANT
