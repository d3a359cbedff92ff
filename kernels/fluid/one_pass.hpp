#pragma once
#include "kernels/fluid/density_pass.hpp"
#include "kernels/fluid/force_pass.hpp"
#include "kernels/integrate/fluid_kicks.hpp"

namespace BL_SOLVER {

/// ForcePass and DensityPass in one loop over pairs, for Adams-Bashforth steps: writes what ForcePass does
/// and ds/dt, by which DensityHistory advances the next step. The void limiter acts on `compression_new` at
/// once.
template <class Force, class Density>
struct OnePass {
  Force force;
  Density density;
  Span<Real> rate;  ///< of s, 1/s

  template <class N = Real>
  struct Sum {
    typename Force::template Sum<N> force;
    typename Density::template Sum<N> density;
  };
  BL_HD Sum<> start(Index a) const { return {force.start(a), with_shared_fields().start(a)}; }

  BL_HD auto sources() const {
    return sources_of(force.fluid.flux, force.p_rho2, Unread{}, density.shift.sources());
  }
  template <class N, class Exposure>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& vb, N p, Unread,
                  const Exposure& exposure) const {
    force.pair(sum.force, r, r2, M, vb, p, Unread{});
    with_shared_fields().pair(sum.density, r, r2, M, vb, EosState<N>{.p_over_rho2 = p, .eps = N(1)},
                              exposure);
  }
  BL_HD auto wall_sources() const { return force.wall_sources(); }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const VelocityDensity<N>& vb,
                       const WallState<N>& mb, const NoSlip<N>& no_slip) const {
    force.wall_pair(sum.force, r, r2, vb, mb, no_slip);
    with_shared_fields().wall_pair(sum.density, r, r2, vb, mb, N(0));
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    force.merge(into.force, other.force);
    density.merge(into.density, other.density);
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    density.order(a, sum.density);
    force.finish(a, sum.force);
    const auto change = density.of(a, sum.density);
    rate[a] = change.rate;
    density.compression_new[a] = max_of(density.compression[a] + change.settled, kThinnest);
  }

 private:
  /// The density's pass with the kernel function and spans of the force's, so that the compiler sees that
  /// both read the same and computes it once.
  BL_HD Density with_shared_fields() const {
    Density same = density;
    same.w = force.w;
    same.fluid = force.fluid;
    return same;
  }
};

}  // namespace BL_SOLVER
