#pragma once
#include "kernels/contact/grain_mass.hpp"
#include "kernels/coupling/averaging.hpp"
#include "kernels/coupling/fluid_records.hpp"

namespace BL_SOLVER {

/// Force of the fluid's stress on a grain, its buoyancy: sum_a w_ja M_a theta_a. The fluid takes the fraction
/// eps_a of M_a theta_a, the grains the rest. Replaces V_j sum phi rho~ theta of [he18] Eqs. 27-29.
template <class W, class Averages = OneAverage>
struct BuoyancyPass {
  W w;
  Averages averages = {};
  Span<const Real4> push, volume;
  Span<Real3> force;

  template <class N = Real>
  struct Sum {
    Vec3<N> f;
    [[no_unique_address]] typename Averages::template Own<N> own;
  };
  BL_HD Sum<> start(Index j) const { return {{}, averages.own(j)}; }
  BL_HD auto sources() const { return sources_of(push); }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>&, N r2, N, const Vec4<N>& of_fluid) const {
    sum.f += averages.W(w, sum.own, root(r2)) * of_fluid.xyz();
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const { into.f += other.f; }
  BL_HD void finish(Index j, const Sum<>& sum) const { force[j] = volume[j].w * sum.f; }
};

/// Completes kick-drift-kick for the grains: adds half of the change of the force, which was held at its
/// value at the start of the step.
struct BuoyancyKick {
  Real kick;  ///< s
  MassPerR3 mass_per_r3;
  bool moves;
  Span<const Real3> now;
  Span<const Real> radius;
  Span<Real3> force, v;
  BL_HD void operator()(Index j) const {
    if (moves) v[j] += kick / (Real(mass_per_r3(j)) * cube(radius[j])) * (now[j] - force[j]);
    force[j] = now[j];
  }
};

}  // namespace BL_SOLVER
