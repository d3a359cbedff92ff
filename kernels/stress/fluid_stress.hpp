#pragma once
// Stress by the forces of pairs of fluid, taken from the passes that move it.

#include "kernels/fluid/force_pass.hpp"
#include "kernels/sdpd/force_pass.hpp"
#include "kernels/stress/pair_moment.hpp"

namespace BL_SOLVER {

/// Of fluid particles, by parts: pressure, friction, noise (empty without any).
struct StressParts {
  Span<PairMoment<>> pressure, friction, noise;

  BL_HD void write(Index a, const PairMoment<>& p, const PairMoment<>& f, const PairMoment<>& n) const {
    pressure[a] = p.times(Real(0.5));
    friction[a] = f.times(Real(0.5));
    if (noise) noise[a] = n.times(Real(0.5));
  }
};

/// Forces of the pairs of WCSPH. `whole` is its pass; `inviscid` the same without physical and artificial
/// viscosity.
template <class Force>
struct StressPass {
  Force whole, inviscid;
  StressParts out;

  template <class N = Real>
  struct Sum {
    typename Force::template Sum<N> of;
    PairMoment<N> pressure, friction;
  };
  BL_HD Sum<> start(Index a) const { return {whole.start(a), {}, {}}; }
  BL_HD auto sources() const { return whole.sources(); }
  template <class N, class... Of>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& vb, N p,
                  const Of&... of_b) const {
    auto pressed = sum.of, rubbed = sum.of;
    inviscid.pair(pressed, r, r2, M, vb, p, of_b...);
    rubbed.m.p_over_rho2 = N(0);  // no pressure on either side
    whole.pair(rubbed, r, r2, M, vb, N(0), of_b...);
    sum.pressure.add(pressed.stress, r);
    sum.friction.add(rubbed.stress, r);
  }
  BL_HD auto wall_sources() const { return whole.wall_sources(); }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const VelocityDensity<N>& vw,
                       const WallState<N>& mw, const NoSlip<N>& no_slip) const {
    const auto F = whole.lengths.F(whole.w, sum.of.own, root(r2));
    sum.pressure.add(whole.wall.pressure(sum.of.m, mw, r, F), r);
    if (whole.wall.viscosity.acts())
      sum.friction.add(sum.of.viscosity * whole.wall.friction(sum.of.a, vw, no_slip, r, r2, F), r);
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.pressure.add(other.pressure);
    into.friction.add(other.friction);
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    const Real M = whole.fluid.state[a].mass_over_eps;
    out.write(a, sum.pressure.times(M), sum.friction.times(M), {});
  }
};

/// The same of SDPD.
template <class Force, bool kNoise>
struct SdpdStressPass {
  Force force;
  StressParts out;

  template <class N = Real>
  struct Sum {
    typename Force::template Sum<N> of;
    PairMoment<N> pressure, friction, noise;

    BL_HD void add(const Vec3<N>& push, const Vec3<N>& rub, const Vec3<N>& kick, const Vec3<N>& r) {
      pressure.add(push, r);
      friction.add(rub, r);
      if constexpr (kNoise) noise.add(kick, r);
    }
  };
  BL_HD Sum<> start(Index a) const { return {force.start(a), {}, {}, {}}; }
  BL_HD auto sources() const { return force.sources(); }
  template <class N, class... Own>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& vb, N p,
                  const Own&... own) const {
    auto one = sum.of;
    force.pair(one, r, r2, M, vb, p, own...);
    sum.add(one.push, one.friction, one.noise, r);
  }
  BL_HD auto wall_sources() const { return force.wall_sources(); }
  template <class N, class... Of>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const Of&... of_b) const {
    auto one = sum.of;
    force.wall_pair(one, r, r2, of_b...);
    sum.add(one.push, one.friction, one.noise, r);
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.pressure.add(other.pressure);
    into.friction.add(other.friction);
    if constexpr (kNoise) into.noise.add(other.noise);
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    out.write(a, sum.pressure.times(force.fluid.state[a].mass_over_eps), sum.friction, sum.noise);
  }
};

}  // namespace BL_SOLVER
