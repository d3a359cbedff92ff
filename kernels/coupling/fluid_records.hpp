#pragma once
// How much of a grain's exchange falls to a fluid particle: V_a W(|r_a - r_j|; h_c), divided by its sum S_j
// over a grain's fluid the weight phi_ja. Interpolation to the grain and spreading back use the same weights,
// which makes momentum exact and drag dissipative; the couple that keeps angular momentum too may give back
// up to K |omega_f x arm|2 / 4 W, beside a surface of fluid that turns.

#include "kernels/coupling/orifice_share.hpp"

namespace bedload::inline BL_VARIANT {

/// Mixture volume of a fluid particle, m3; v_rho: w is its superficial density.
BL_HD Real mixture_volume(Real mass, const Real4& v_rho) { return mass / v_rho.w; }

/// What grains read of a fluid particle, besides its velocity, in few loads.
struct FluidRecords {
  Span<Real4> theta;   ///< m/s2; w: V_a, m3
  Span<Real4> solids;  ///< porosity; intrinsic density, kg/m3; share of the solids around that count for it
};

struct RecordPass {
  Frame frame;
  OrificeShare counted;
  Span<const FluidPosition> x;
  Span<const Real> mass, eps;
  Span<const Real3> theta;
  Span<const Real4> v_rho;
  FluidRecords records;

  BL_HD void operator()(Index a) const {
    records.theta[a] = {theta[a], mixture_volume(mass[a], v_rho[a])};
    records.solids[a] = {eps[a], v_rho[a].w / eps[a], counted(coordinates(frame, x[a])), 0};
  }
};

}  // namespace bedload::inline BL_VARIANT
