#pragma once
// How much of a grain's exchange falls to a fluid particle: V_a W(|r_a - r_j|; h_c), divided by its sum S_j
// over a grain's fluid the weight phi_ja. Interpolation to the grain and spreading back use the same weights,
// which makes momentum exact and drag dissipative.

#include "kernels/coupling/orifice_weight.hpp"

namespace bedload::inline BL_VARIANT {

/// Volume of fluid and grains that a fluid particle stands for, m3.
BL_HD Real mixture_volume(const Real4& m_state) { return m_state.x / m_state.z; }

/// Stress on the mixture around a fluid particle as far as it counts grains, f_a M_a theta_a, N; w: V_a, m3.
BL_HD Real4 push_record(Real solid_factor, const Real3& theta, const Real4& m_state) {
  return {solid_factor * m_state.x * theta, mixture_volume(m_state)};
}

/// What grains read of a fluid particle, besides its velocity, in few loads.
struct FluidRecords {
  Span<Real4> push;    ///< push_record
  Span<Real4> solids;  ///< porosity; density, kg/m3; weight of the solids around that count beside orifices
};

struct RecordPass {
  Frame frame;
  OrificeWeight counted;
  Span<const FluidPosition> x;
  Span<const Real> solid_factor;
  Span<const Real3> theta;
  Span<const Real4> m_state;
  Span<const Real> eps;
  FluidRecords records;

  BL_HD void operator()(Index a) const {
    const Real4 m = m_state[a];
    records.push[a] = push_record(solid_factor[a], theta[a], m);
    records.solids[a] = {eps[a], m.z, counted(coordinates(frame, x[a])), 0};
  }
};

}  // namespace bedload::inline BL_VARIANT
