#pragma once
#include "bedload/core/span.hpp"
#include "kernels/coupling/wall_share.hpp"

namespace bedload::inline BL_VARIANT {

/// eps_a = 1 - sum_j V_j W(|r_a - r_j|; h_c), with a floor [harting14] Eq. 6. Beside walls the sum is
/// divided by the share of the kernel that is free of them: a bed reaches a wall as dense as it is inside.
template <class W>
struct PorosityPass {
  W w;
  Real floor;
  WallFreeShare wall_free;
  Frame frame;
  Span<const FluidPosition> x;
  Span<const Real> radius;
  Span<Real> eps;

  BL_HD Real start(Index) const { return 0; }
  BL_HD void pair(Real& solid, Index, Index j, const Real3&, Real r2) const {
    solid += 4 * kPi / 3 * cube(radius[j]) * w.W(std::sqrt(r2));
  }
  BL_HD void merge(Real& into, Real other) const { into += other; }
  BL_HD void finish(Index a, Real solid) const {
    if (solid > 0) solid /= wall_free(coordinates(frame, x[a]));
    eps[a] = max_of(floor, 1 - solid);
  }
};

}  // namespace bedload::inline BL_VARIANT
