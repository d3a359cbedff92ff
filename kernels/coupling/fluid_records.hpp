#pragma once
// Weights of the exchange between a grain and the fluid particles around it: phi_ja = V_a W(|r_a - r_j|; h_c)
// / S_j, S_j being the sum over the grain's fluid. Interpolation to the grain and spreading of the reaction
// use the same weights, so momentum is conserved exactly and drag is dissipative.

#include "kernels/coupling/orifice_weight.hpp"

namespace BL_SOLVER {

/// Volume of the mixture that a fluid particle represents, m3.
BL_HD Real mixture_volume(const EosState<>& state) { return state.mass_over_eps / state.rho; }

/// Data of a fluid particle that grains read in addition to its velocity, packed for few loads.
struct FluidRecords {
  Span<Real4> push;    ///< of PushPass
  Span<Real4> solids;  ///< porosity; density, kg/m3; weight of the solids around that count next to orifices
};

/// The stress on the mixture around each fluid particle as far as it counts grains, f_a M_a theta_a, N, theta
/// being the acceleration by stress; w: volume of the mixture, m3.
struct PushPass {
  Span<const Real> solid_factor;
  Span<const Real3> stress_acceleration;
  Span<const EosState<>> eos_state;
  Span<Real4> push;

  BL_HD void operator()(Index a) const {
    const EosState<> m = eos_state[a];
    push[a] = {solid_factor[a] * m.mass_over_eps * stress_acceleration[a], mixture_volume(m)};
  }
};

struct RecordPass {
  PushPass push;
  Frame frame;
  OrificeWeight counted;
  Span<const FluidPosition> x;
  Span<const Real> eps;
  Span<Real4> solids;

  BL_HD void operator()(Index a) const {
    push(a);
    solids[a] = {eps[a], push.eos_state[a].rho, counted(coordinates(frame, x[a])), 0};
  }
};

}  // namespace BL_SOLVER
