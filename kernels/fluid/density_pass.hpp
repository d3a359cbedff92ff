#pragma once
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/fluid/linear_fit.hpp"
#include "kernels/fluid/shifting.hpp"
#include "kernels/fluid/wall_mass.hpp"
#include "kernels/smoothing/half_space_fraction.hpp"
#include "kernels/smoothing/lengths.hpp"

namespace bedload::inline BL_VARIANT {

/// Continuity of the mixture with density diffusion (Fourtakas et al. 2019), over `dt`:
///   eps_a d rho_a / dt = - sum_b M_b (q_a - q_b) . r_ab F_ab,  M = m / eps,  q = eps v + sum_j w_j u_j,
/// q being the volume flux of fluid and grains; [H (6)], [R (7)] without grains. Its adjoint is the pressure
/// force of ForcePass, which fluid and grains share by their weights in q: the power of pressure on both is
/// the loss of compression energy. Kick-drift-kick passes positions and velocities at mid-step, which makes
/// it reversible. Walls enter by their continuity_mass and return the work of their own pressure
/// (WallWorkPass).
///
/// Continuity gives changes of density only. Three terms correct s = rho / rho0 - 1 by the particles, with
/// f = sum V W over fluid and walls and the void v = max(0, 1 - f - cut), cut: left empty by a plane surface:
///   s < least:  ds/dt = fading (min(least, slack - v) - s)
///               fragmented fluid has no pressure before its void has closed;
///   s >= least: ds/dt = -fading v max(s, 0)
///               void relaxation: surfaces that meet would keep a gap, each counting as full up to the other;
///   always:     ds/dt = spreading max(0, f - 1 - slack)
///               among grains errors of the porosity gradient add up, so particles may overfill the kernel.
/// The rate of s by continuity alone is the input of the acoustic damper (StatePass). kSmooth: with density
/// diffusion and these terms; else continuity alone. kPorous: there are grains. Fit: LinearFit, with
/// Shifting, or NoFit. With variable smoothing lengths the sum of continuity is taken at h_a and divided by
/// Omega_a.
template <class W, class Shift, class Fit, bool kSmooth, bool kPorous, class Lengths>
struct DensityPass {
  W w;
  Span<const Real4> flux;
  Span<const EosState<>> eos_state;
  Span<const Real4> wall_v_rho;
  Span<const WallState<>> wall_state;
  Real diffusion;     ///< 2 delta h c [m2/s]
  Real3 hydrostatic;  ///< rho0 g / c^2 [kg/m4]: how density grows downwards at rho0
  Real stiffening;    ///< and by which power of rho0 / rho elsewhere: gamma - 2
  Real rho0, dt;      ///< kg/m3, s
  Span<const Real> compression;
  Span<Real> compression_new;
  CutFraction cut;
  Real least;      ///< s at which fluid cavitates
  Real fading;     ///< of pressure where there is a void, and pace at which fragmented fluid follows it [1/s]
  Real spreading;  ///< of density where particles overfill their volume [1/s]
  Span<Real> compression_rate;  ///< 1/s; empty where nothing asks for it
  Shift shift;
  Span<Real3> drift;  ///< empty where nothing drifts
  Fit fit;
  Lengths lengths;
  Span<const Real> wall_work;  ///< of WallWorkPass; empty without

  static constexpr Real slack = Real(0.02);  ///< twice what the sum over particles at rest scatters

  template <class N = Real>
  struct Sum {
    Vec3<N> q;
    N M, rho, eps, rate, diffused, filled;
    Vec3<N> gradient;
    [[no_unique_address]] typename Shift::template Sum<N> shift;
    [[no_unique_address]] typename Fit::template Sum<N> fit;
    [[no_unique_address]] typename Lengths::template Own<N> own;
  };
  BL_HD Sum<> start(Index a) const {
    const EosState<> m = eos_state[a];
    return {flux[a].xyz(),
            m.mass_over_eps,
            m.rho,
            m.eps,
            0,
            0,
            0,
            {},
            shift.template start<Real>(a),
            fit.start(m),
            lengths.template own<Real>(a)};
  }

  BL_HD auto sources() const {
    constexpr bool asked = (kSmooth && kPorous) || Fit::acts;
    const auto state = read_if<asked>(eos_state);
    if constexpr (kSmooth)
      return lengths.sources(flux, state, shift.sources());
    else
      return sources_of(flux, state, shift.sources());
  }
  /// exposure: if particles shift; h_b: if lengths vary.
  template <class N, class State, class Exposure, class... H>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const Vec4<N>& qb,
                  [[maybe_unused]] const State& state, [[maybe_unused]] const Exposure& exposure,
                  const H&... h_b) const {
    const N distance = root(r2);
    const auto factor = lengths.F(w, sum.own, distance, h_b...);
    const N F = own_factor(factor);
    const Vec3<N> v = sum.q - qb.xyz();
    sum.rate += M * F * dot(v, r);
    if constexpr (!kSmooth) return;
    const N rho = qb.w, V = quotient(M, rho), VF = V * F;
    sum.filled += V * lengths.W(w, sum.own, distance);
    sum.gradient += VF * r;
    sum.shift.add(VF, v, r, exposure);
    if constexpr (Fit::acts) sum.fit.add_fluid(VF, state.p_over_rho2 * square(rho), r, exposure);
    const N still = 1 - stiffening * (Real(0.5) * (sum.rho + rho) / rho0 - 1);
    N shared = sum.eps;
    if constexpr (kPorous) shared = Real(0.5) * (sum.eps + state.eps);  // what one gains the other loses
    const N spread = shared * (V * mean_factor(factor)) * pair_length(factor);  // D_a goes with h
    sum.diffused += spread * (rho - sum.rho + still * dot(Vec3<N>(hydrostatic), r));
  }
  BL_HD auto wall_sources() const {
    return sources_of(wall_v_rho, wall_state, read_where(bool(wall_work), wall_work));
  }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const Vec4<N>& vb, const WallState<N>& mb,
                       N work) const {
    const N distance = root(r2), F = own_factor(lengths.F(w, sum.own, distance)),
            V = quotient(mb.mass, mb.rho);
    sum.rate += continuity_mass(mb, rho0) * F * dot(sum.q - vb.xyz(), r);
    if (wall_work) sum.rate += quotient(square(sum.rho) * work, sum.M) * lengths.W(w, sum.own, distance);
    if constexpr (!kSmooth) return;
    sum.filled += V * lengths.W(w, sum.own, distance);
    const N VF = V * F;
    sum.gradient += VF * r;
    sum.shift.add_wall(VF, r);
    if constexpr (Fit::acts) sum.fit.add(VF, mb.pressure(), r);
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.rate += other.rate;
    into.diffused += other.diffused;
    into.filled += other.filled;
    into.gradient += other.gradient;
    into.shift.merge(other.shift);
    into.fit.merge(other.fit);
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    const Change change = of(a, sum);
    compression_new[a] = compression[a] + dt * change.rate + change.settled;
    order(a, sum);
  }
  /// What the arrangement of particles calls for: their drift, and what the pressure force is wrong by.
  BL_HD void order(Index a, const Sum<>& sum) const {
    if constexpr (Shift::acts) {
      const SymmetricMatrix<Real> moment = shift.moment(sum.shift);
      const Real least = moment.least_eigenvalue(), exposed = 1 - least;
      shift.exposure_new[a] = exposed;
      drift[a] = shift.drift(sum.shift, exposed, sum.gradient);
      if constexpr (Fit::acts)
        fit.finish(a, sum.fit, sum.rho, sum.gradient, moment, least, shift.inside(sum.shift.greatest));
    } else if (drift) {
      drift[a] = {};  // XSPH adds to it
    }
  }
  /// How s changes.
  struct Change {
    Real rate;     ///< 1/s
    Real settled;  ///< over dt, where there is a void
  };
  BL_HD Change of(Index a, const Sum<>& sum) const {
    const Real rate = lengths.corrected(a, sum.rate);
    if (compression_rate) compression_rate[a] = -rate / (sum.eps * rho0);
    if constexpr (!kSmooth) return {-rate / (sum.eps * rho0), 0};
    const Real s = compression[a],
               filled = eos_state[a].mass_over_eps / sum.rho * lengths.W(w, sum.own, Real(0)) + sum.filled;
    const Real void_fraction = max_of(Real(0), 1 - filled - cut(norm(sum.gradient) * lengths.ratio(a)));
    const Real excess = max_of(Real(0), filled - 1 - slack), pressed = max_of(Real(0), s);
    return {(diffusion * sum.diffused - rate) / (sum.eps * rho0) + spreading * excess,
            s < least ? min_of(dt * fading, Real(1)) * (min_of(least, slack - void_fraction) - s)
                      : -min_of(dt * fading * void_fraction, Real(1)) * pressed};
  }
};

}  // namespace bedload::inline BL_VARIANT
