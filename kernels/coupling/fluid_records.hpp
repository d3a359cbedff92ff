#pragma once
// Weights of the exchange between a grain and the fluid particles around it: phi_ja = V_a W(|r_a - r_j|; h_c)
// / S_j, S_j being the sum over the grain's fluid. Interpolation to the grain and spreading of the reaction
// use the same weights, so momentum is conserved exactly and drag is dissipative.

#include "kernels/coupling/orifice_weight.hpp"

namespace BL_SOLVER {

/// Volume of the mixture that a fluid particle represents, m3, by the mass M = mass / porosity that it has in
/// its volume and its density.
template <class N>
BL_HD N mixture_volume(const N& M, const N& rho) {
  return quotient(M, rho);
}
BL_HD Real mixture_volume(const EosState<>& state) { return mixture_volume(state.mass_over_eps, state.rho); }

/// Data of a fluid particle that grains read in addition to its place, M, velocity and density, packed for
/// few loads.
struct FluidRecords {
  Span<Real4> push;    ///< of PushPass
  Span<Real> counted;  ///< weight of the solids around that counts next to orifices; empty without these
};

/// The stress on the mixture around each fluid particle as far as it counts grains, f_a M_a theta_a, N, theta
/// being the acceleration by stress; w: porosity.
struct PushPass {
  Span<const Real> solid_factor;
  Span<const Real3> stress_acceleration;
  Span<const EosState<>> eos_state;
  Span<const Real> eps;  ///< empty where nobody reads it
  Span<Real4> push;

  BL_HD void operator()(Index a) const {
    push[a] = {solid_factor[a] * eos_state[a].mass_over_eps * stress_acceleration[a], eps ? eps[a] : Real(1)};
  }
};

struct CountedPass {
  Frame frame;
  OrificeWeight weight;
  Span<const FluidPosition> x;
  Span<Real> counted;

  BL_HD void operator()(Index a) const { counted[a] = weight(coordinates(frame, x[a])); }
};

}  // namespace BL_SOLVER
