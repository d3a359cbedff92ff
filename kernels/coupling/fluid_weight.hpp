#pragma once
// How much of a grain's exchange falls to a fluid particle. Interpolation to the grain and
// spreading back use the same weights, which makes momentum exact and drag dissipative; the couple that keeps
// angular momentum too may give back up to K |omega_f x arm|2 / 4 W, beside a surface of fluid that turns.

#include "bedload/core/span.hpp"

namespace bedload::inline BL_VARIANT {

/// V_a W(|r_a - r_j|; h_c): divided by its sum S_j over a grain's fluid it is the weight phi_ja.
template <class W>
struct FluidWeight {
  W w;
  Span<const Real4> v_rho;
  Span<const Real> mass;

  template <class A, class N>
  BL_HD N operator()(A a, N r2) const {
    return mass[a] / v_rho[a].w * w.W(root(r2));
  }
};

}  // namespace bedload::inline BL_VARIANT
