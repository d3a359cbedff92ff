#pragma once
// Weights of the exchange between a grain and the fluid particles around it: phi_ja = V_a W(|r_a - r_j|; h_c)
// / S_j, S_j being the sum over the grain's fluid. Interpolation to the grain and spreading of the reaction
// use the same weights, so momentum is conserved exactly and drag is dissipative.

#include "kernels/coupling/orifice_weight.hpp"

namespace bedload::inline BL_VARIANT {

/// Volume of the mixture that a fluid particle represents, m3.
BL_HD Real mixture_volume(const EosState<>& state) { return state.mass_over_eps / state.rho; }

/// Stress on the mixture around a fluid particle as far as it counts grains, f_a M_a theta_a, N, theta being
/// the acceleration by stress; w: V_a, m3.
BL_HD Real4 push_record(Real solid_factor, const Real3& theta, const EosState<>& state) {
  return {solid_factor * state.mass_over_eps * theta, mixture_volume(state)};
}

/// Data of a fluid particle that grains read in addition to its velocity, packed for few loads.
struct FluidRecords {
  Span<Real4> push;    ///< push_record
  Span<Real4> solids;  ///< porosity; density, kg/m3; weight of the solids around that count next to orifices
};

struct RecordPass {
  Frame frame;
  OrificeWeight counted;
  Span<const FluidPosition> x;
  Span<const Real> solid_factor;
  Span<const Real3> stress_acceleration;
  Span<const EosState<>> eos_state;
  Span<const Real> eps;
  FluidRecords records;

  BL_HD void operator()(Index a) const {
    const EosState<> m = eos_state[a];
    records.push[a] = push_record(solid_factor[a], stress_acceleration[a], m);
    records.solids[a] = {eps[a], m.rho, counted(coordinates(frame, x[a])), 0};
  }
};

}  // namespace bedload::inline BL_VARIANT
