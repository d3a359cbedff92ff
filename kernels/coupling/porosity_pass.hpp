#pragma once
#include "bedload/core/span.hpp"

namespace bedload::inline BL_VARIANT {

/// eps_a = 1 - sum_j V_j W(|r_a - r_j|; h_c), with a floor [harting14] Eq. 6.
template <class W>
struct PorosityPass {
  W w;
  Real floor;
  Span<const Real> radius;
  Span<Real> eps;

  BL_HD Real start(Index) const { return 0; }
  BL_HD void pair(Real& solid, Index, Index j, const Real3&, Real r2) const {
    solid += 4 * kPi / 3 * cube(radius[j]) * w.W(std::sqrt(r2));
  }
  BL_HD void finish(Index a, Real solid) const { eps[a] = max_of(floor, 1 - solid); }
};

}  // namespace bedload::inline BL_VARIANT
