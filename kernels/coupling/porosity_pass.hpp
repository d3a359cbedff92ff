#pragma once
#include <cmath>

#include "bedload/core/span.hpp"
#include "kernels/coupling/orifice_share.hpp"
#include "kernels/coupling/wall_share.hpp"

namespace bedload::inline BL_VARIANT {

/// eps_a = 1 - sum_j V_j W(|r_a - r_j|; h_c), with a floor [harting14] Eq. 6. Beside walls the sum is
/// divided by the share of the kernel that is free of them: a bed reaches a wall as dense as it is inside.
/// Fluid that fills its surroundings must make room by its velocity where the porosity changes. Torn fluid, a
/// drop that falls into a bed, has room: there its superficial density follows the porosity, and it is not
/// pressed.
template <class W>
struct PorosityPass {
  W w;
  Real floor;
  WallFreeShare wall_free;
  OrificeShare away_from_orifices;
  Frame frame;
  Span<const FluidPosition> x;
  Span<const Real> radius;
  Span<Real> eps;
  Span<const Real>
      filled;    ///< share of the kernel that fluid and walls fill; empty: superficial densities stay
  Span<Real> s;  ///< superficial density / rho0 - 1

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
    if (solid > 0) {
      const Vec3d at = coordinates(frame, x[a]);
      solid *= away_from_orifices(at) / wall_free(at);
    }
    const Real now = max_of(floor, 1 - solid);
    if (filled && now != eps[a]) s[a] = (1 + s[a]) * std::pow(now / eps[a], torn(filled[a])) - 1;
    eps[a] = now;
  }

 private:
  /// From 0 where the kernel is filled as at a calm surface or better to 1 where a particle is all but alone.
  BL_HD static Real torn(Real filled) { return clamp((Real(0.6) - filled) / Real(0.3), Real(0), Real(1)); }
};

}  // namespace bedload::inline BL_VARIANT
