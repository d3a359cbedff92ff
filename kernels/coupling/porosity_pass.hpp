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

  template <class N = Real>
  struct Sum {
    N solid;
  };
  BL_HD Sum<> start(Index) const { return {0}; }
  template <class N, class J>
  BL_HD void pair(Sum<N>& sum, Index, J j, const Vec3<N>&, N r2) const {
    const N R = radius[j];
    sum.solid += 4 * kPi / 3 * cube(R) * w.W(root(r2));
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.solid += other.solid; }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    Real solid = sum.solid;
    if (solid > 0) solid /= wall_free(coordinates(frame, x[a]));
    eps[a] = max_of(floor, 1 - solid);
  }
};

}  // namespace bedload::inline BL_VARIANT
