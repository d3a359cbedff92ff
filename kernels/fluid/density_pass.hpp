#pragma once
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/fluid/linear_fit.hpp"
#include "kernels/fluid/shifting.hpp"
#include "kernels/fluid/views.hpp"
#include "kernels/fluid/wall_mass.hpp"
#include "kernels/smoothing/half_space_fraction.hpp"
#include "kernels/smoothing/lengths.hpp"

namespace BL_SOLVER {

/// Continuity of the mixture with density diffusion. Advances s = rho / rho0 - 1 over the step dt by
///   ds_a/dt = (D_a - C_a / Omega_a) / (eps_a rho0) + S_a,
///   C_a = sum_b M_b F_ab (q_a - q_b) . r_ab + sum_w m_w F_aw (q_a - v_w) . r_aw
///         + rho_a^2 / M_a sum_w `wall_work`_w W_aw,
///   D_a = `diffusion` sum_b eps_ab V_b F_ab (rho_b - rho_a + k_ab `hydrostatic` . r_ab),
///   S_a = `spreading` max(0, n_a - 1 - `slack`).
/// First sum of C: [he18] Eq. 6, without grains [robinson14] Eq. 7; D: [fourtakas19].
///
/// Symbols: b fluid, w wall particles; M = m / eps and V = M / rho, mass and volume of the mixture that a
/// particle represents; q = eps v + sum_j w_j u_j, volume flux of fluid and grains j; r_ab = x_a - x_b;
/// F = -W' / r; W and F at h_a, and D_a times h_ab / h, where smoothing lengths vary, else Omega = 1; m_w:
/// continuity_mass; `wall_work`: of WallWorkPass; eps_ab: mean porosity of the pair;
/// k_ab = 1 - (gamma - 2) ((rho_a + rho_b) / (2 rho0) - 1), hydrostatic density gradient at the mean density
/// over that at rho0; n_a = V_a W(0) + sum_b V_b W_ab + sum_w V_w W_aw, kernel completeness. S corrects an
/// error of C that accumulates where particles cross a porosity gradient and ends in n_a > 1.
///
/// Void limiter, added after the rates: with the void z_a = max(0, 1 - n_a - cut(|sum V F r|)), where `cut`
/// is the part of the kernel outside a plane free surface (CutFraction),
///   cavitated, s < `least`:  s += min(dt `fading`, 1) (min(`least`, `slack` - z_a) - s),
///   otherwise:               s -= min(dt `fading` z_a, 1) max(0, s).
/// Fragmented fluid has no pressure until its voids have closed, and no gap stays between surfaces that meet.
///
/// The pressure term of ForcePass is the adjoint of C: the power of pressure on fluid and grains is minus the
/// rate of elastic energy. Evaluated at mid-step in kick-drift-kick, C is time-reversible.
///
/// kSmooth: with D, S and the limiter, else C alone. kPorous: there are grains. Shift, Fit: Shifting and
/// LinearFit, or NoShifting and NoFit.
template <class W, class Shift, class Fit, bool kSmooth, bool kPorous, class Lengths>
struct DensityPass {
  W w;
  FluidView fluid;
  WallView walls;
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
  Span<Real> compression_rate;  ///< ds/dt by C alone, for the acoustic damper (StatePass), 1/s; or empty
  Shift shift;
  Span<Real3> drift;  ///< empty where nothing drifts
  Fit fit;
  Lengths lengths;
  Span<const Real> wall_work;  ///< of WallWorkPass; empty without

  static constexpr bool kShifts = Shift::acts;
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
    const EosState<> m = fluid.state[a];
    return {fluid.flux[a].v,
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
    const auto state = read_if<asked>(fluid.state);
    if constexpr (kSmooth)
      return lengths.sources(fluid.flux, state, shift.sources());
    else
      return sources_of(fluid.flux, state, shift.sources());
  }
  /// exposure: if particles shift; h_b: if lengths vary.
  template <class N, class State, class Exposure, class... H>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& qb,
                  [[maybe_unused]] const State& state, [[maybe_unused]] const Exposure& exposure,
                  const H&... h_b) const {
    const N distance = root(r2);
    const auto factor = lengths.F(w, sum.own, distance, h_b...);
    const N F = own_factor(factor);
    const Vec3<N> v = sum.q - qb.v;
    sum.rate += M * F * dot(v, r);
    if constexpr (!kSmooth) return;
    const N rho = qb.rho, V = quotient(M, rho), VF = V * F;
    sum.filled += V * lengths.W(w, sum.own, distance);
    sum.gradient += VF * r;
    sum.shift.add(VF, v, r, exposure);
    if constexpr (Fit::acts) sum.fit.add_fluid(VF, state.p_over_rho2 * square(rho), r, exposure);
    const N still = 1 + stiffening - (Real(0.5) * stiffening / rho0) * (sum.rho + rho);
    N shared = sum.eps;
    if constexpr (kPorous) shared = Real(0.5) * (sum.eps + state.eps);  // what one gains the other loses
    const N spread = shared * (V * mean_factor(factor)) * pair_length(factor);  // D_a goes with h
    sum.diffused += spread * (rho - sum.rho + still * dot(Vec3<N>(hydrostatic), r));
  }
  BL_HD auto wall_sources() const {
    return sources_of(walls.v_rho, walls.state, read_where(bool(wall_work), wall_work));
  }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const VelocityDensity<N>& vb,
                       const WallState<N>& mb, N work) const {
    const N distance = root(r2), F = own_factor(lengths.F(w, sum.own, distance)),
            V = quotient(mb.mass, mb.rho);
    sum.rate += continuity_mass(mb, rho0) * F * dot(sum.q - vb.v, r);
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
      drift[a] = shift.drift(sum.shift, exposed, sum.gradient).velocity;
      if constexpr (Fit::acts)
        fit.finish(a, sum.fit, sum.rho, sum.gradient, moment, least, shift.inside(sum.shift.greatest));
    } else if (drift) {
      drift[a] = {};  // XSPH adds to it
    }
  }
  /// How s changes.
  struct Change {
    Real rate;               ///< 1/s
    Real settled;            ///< over dt, where there is a void
    Real void_fraction = 0;  ///< z_a
    Real excess = 0;         ///< of n_a over 1 + `slack`
  };
  BL_HD Change of(Index a, const Sum<>& sum) const {
    const Real rate = lengths.corrected(a, sum.rate);
    if (compression_rate) compression_rate[a] = -rate / (sum.eps * rho0);
    if constexpr (!kSmooth) return {-rate / (sum.eps * rho0), 0};
    const Real s = compression[a],
               filled = fluid.state[a].mass_over_eps / sum.rho * lengths.W(w, sum.own, Real(0)) + sum.filled;
    const Real void_fraction = max_of(Real(0), 1 - filled - cut(norm(sum.gradient) * lengths.ratio(a)));
    const Real excess = max_of(Real(0), filled - 1 - slack), pressed = max_of(Real(0), s);
    return {(diffusion * sum.diffused - rate) / (sum.eps * rho0) + spreading * excess,
            s < least ? min_of(dt * fading, Real(1)) * (min_of(least, slack - void_fraction) - s)
                      : -min_of(dt * fading * void_fraction, Real(1)) * pressed,
            void_fraction, excess};
  }
};

}  // namespace BL_SOLVER
