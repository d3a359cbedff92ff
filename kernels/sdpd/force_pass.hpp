#pragma once
#include "kernels/fluid/force_pass.hpp"
#include "kernels/sdpd/pair_law.hpp"

namespace BL_SOLVER {

/// Force of a wall particle w on fluid particle a. A frozen one acts as a fluid particle with the velocity
/// and spin of the wall [tsuzuki]. Any other takes the spin of a, u = v_a - v_w + r x w_a, so that simple
/// shear at a no-slip wall has no more slip than in the bulk; a then takes the whole couple -r x F. Friction
/// with walls removes heat, so walls also make noise, at the temperature of the fluid.
template <class W>
struct SdpdWallPair {
  W w;
  PairLaw law;
  Real pressing;  ///< factor on the pressure
  bool noisy;

  template <class N>
  struct Force {
    Vec3<N> push, friction, noise;  ///< m/s2, N, N
    N arm;                          ///< part of -r x F that turns a
  };
  /// a: {v, rho}, V, P / rho^2, spin, id, viscosity over that of `law`; b: wall's as in WallPair, and its
  /// spin and label.
  template <class N>
  BL_HD Force<N> operator()(const VelocityDensity<N>& va, N V, N pa, const Vec3<N>& spin, const RowId<N>& id,
                            N relative, const VelocityDensity<N>& vw, const WallState<N>& mw,
                            const NoSlip<N>& no_slip, const Vec4<N>& own, const Vec3<N>& r, N r2) const {
    const N F = w.F(root(r2)), g = relative * V * quotient(no_slip.mass, vw.rho) * F;
    Force<N> out;
    out.arm = 1 - Real(0.5) * mw.frozen;
    out.push = (pressing * pressure_term(mw.mass, pa, mw.p_over_rho2, F)) * r;
    const Vec3<N> turn = cross(r, out.arm * spin + (1 - out.arm) * own.xyz());
    out.friction = law.friction(g, va.v - no_slip.v, turn, r, r2);
    if (noisy) out.noise = law.noise(g, id, own.w, r, r2);
    return out;
  }
};

/// Momentum and spin of SDPD. stress_acceleration: as in ForcePass of WCSPH, noise
/// included: friction acts on the volume flux of fluid and grains, so its noise does. Both partners of a pair
/// feel the couple -r x F / 2, F being friction and noise, which with r x F adds up to none. kSpin: particles
/// spin; kNoise: there is noise; kSpecies: fluids of several viscosities, the harmonic mean of which counts
/// for a pair.
template <class W, bool kSpin, bool kNoise, bool kSpecies>
struct SdpdForcePass {
  SdpdWallPair<W> wall;
  FluidView fluid;
  Span<const Real4> spin_label;
  Span<const Real> p_rho2, mass;
  Span<const Id> id;
  WallView walls;
  Span<const Real4> wall_label;  ///< spin, id
  Real3 gravity;                 ///< minus the frame's acceleration, m/s2
  Drive drive;
  Real dt, inertia;  ///< s; k_I dx^2, m2
  FluidAccelerations out;
  Span<Real3> spin, spin_acc;
  Span<const Real> viscosity;  ///< over that of `wall.law`

  template <class N = Real>
  struct Sum {
    VelocityDensity<N> a;
    N V, p;
    Vec3<N> spin;
    RowId<N> id;
    Vec3<N> push, friction, noise, couple;  ///< m/s2; N; N; N m
    N viscosity;
  };
  BL_HD Sum<> start(Index a) const {
    const EosState<> m = fluid.state[a];
    Sum<> sum{
        fluid.flux[a], quotient(m.mass_over_eps, m.rho), m.p_over_rho2, {}, row_id(id[a]), {}, {}, {}, {}, 1};
    if (kSpecies) sum.viscosity = viscosity[a];
    if (kSpin) sum.spin = spin_label[a].xyz();
    return sum;
  }
  BL_HD auto sources() const {
    return sources_of(fluid.flux, p_rho2, read_if<(kSpin || kNoise)>(spin_label),
                      read_if<kSpecies>(viscosity));
  }
  template <class N, class Own, class Relative>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& vb, N p,
                  [[maybe_unused]] const Own& own, [[maybe_unused]] const Relative& viscosity_b) const {
    const N F = wall.w.F(root(r2));
    N g = sum.V * quotient(M, vb.rho) * F;
    if constexpr (kSpecies) g *= quotient(2 * sum.viscosity * viscosity_b, sum.viscosity + viscosity_b);
    sum.push += (wall.pressing * pressure_term(M, sum.p, p, F)) * r;
    Vec3<N> turn;
    if constexpr (kSpin) turn = Real(0.5) * cross(r, sum.spin + own.xyz());
    const Vec3<N> friction = wall.law.friction(g, sum.a.v - vb.v, turn, r, r2);
    sum.friction += friction;
    if constexpr (kSpin) sum.couple -= Real(0.5) * cross(r, friction);
    if constexpr (kNoise) {
      const Vec3<N> noise = wall.law.noise(g, sum.id, own.w, r, r2);
      sum.noise += noise;
      if constexpr (kSpin) sum.couple -= Real(0.5) * cross(r, noise);
    }
  }
  BL_HD auto wall_sources() const { return sources_of(walls.v_rho, walls.state, walls.no_slip, wall_label); }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const VelocityDensity<N>& vb,
                       const WallState<N>& mb, const NoSlip<N>& no_slip, const Vec4<N>& own) const {
    const auto f = wall(sum.a, sum.V, sum.p, sum.spin, sum.id, kSpecies ? sum.viscosity : N(1), vb, mb,
                        no_slip, own, r, r2);
    sum.push += f.push;
    sum.friction += f.friction;
    if constexpr (kNoise) sum.noise += f.noise;
    if constexpr (kSpin) sum.couple -= f.arm * cross(r, f.friction + f.noise);
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.push += other.push;
    into.friction += other.friction;
    into.noise += other.noise;
    into.couple += other.couple;
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    const EosState<> m = fluid.state[a];
    const Real3 stress = sum.push + (1 / m.mass_over_eps) * (sum.friction + sum.noise);
    out.set(a, stress, stress + gravity + drive(a, m));
    if constexpr (kSpin) {  // from the value predicted with the last acceleration to the mean of both
      const Real3 turning = (1 / (mass[a] * inertia)) * sum.couple;
      spin[a] = sum.spin + (dt / 2) * (turning - spin_acc[a]);
      spin_acc[a] = turning;
    }
  }
};

/// Spin at the end of the step, predicted by the acceleration at its start.
struct PredictSpin {
  Real dt;  ///< s
  Span<const Real3> spin, spin_acc;
  Span<const Id> id;
  Span<Real4> spin_label;
  BL_HD void operator()(Index a) const {
    const Real3 w = spin ? spin[a] + dt * spin_acc[a] : Real3();
    spin_label[a] = {w, as_label(id[a])};
  }
};

/// Spin of wall particles, if there is any, and their ids, above those of the fluid.
struct LabelWalls {
  bool spins;
  Span<const Id> id;
  WallBodies bodies;
  Span<Real4> label;
  BL_HD void operator()(Index b) const {
    label[b] = {spins ? Real3(bodies[b].omega) : Real3(), as_label(id[b] | 0x80000000u)};
  }
};

/// Force on each wall particle [N]: minus what SdpdForcePass gave the fluid. The noise counts as friction.
template <class W, class Force>
struct SdpdWallForcePass {
  SdpdWallPair<W> wall;
  BeforeCorrection before;
  FluidView fluid;
  Span<const Real4> spin_label;
  WallView walls;
  Span<const Real4> wall_label;
  Span<Vec3d> force, friction;
  Span<const Real> viscosity;  ///< over that of `wall.law`; empty: the same

  struct Sum {
    VelocityDensity<> v;  ///< of the wall particle, as the next
    WallState<> m;
    NoSlip<> no_slip;
    Real4 label;
    Force force;
  };
  BL_HD Sum start(Index b) const {
    return {walls.v_rho[b], walls.state[b], walls.no_slip[b], wall_label[b], {}};
  }
  BL_HD auto sources() const {
    return sources_of(fluid.flux, fluid.state, spin_label, before.source(before.acc),
                      before.source(before.acc_before), read_where(bool(viscosity), viscosity, Real(1)));
  }
  BL_HD void pair(Sum& sum, const Real3& r_ba, Real r2, Real, const VelocityDensity<>& flux_a,
                  const EosState<>& ma, const Real4& own, const Real3& acc_a, const Real3& acc_before_a,
                  Real relative) const {
    const VelocityDensity<> va = before(flux_a, acc_a, acc_before_a);
    const auto f = wall(va, quotient(ma.mass_over_eps, ma.rho), ma.p_over_rho2, own.xyz(),
                        row_id(as_id(own.w)), relative, sum.v, sum.m, sum.no_slip, sum.label, -r_ba, r2);
    sum.force.add(-ma.mass_over_eps * f.push, -(f.friction + f.noise));
  }
  BL_HD void merge(Sum& into, const Sum& other) const { into.force.add(other.force); }
  BL_HD void finish(Index b, const Sum& sum) const { sum.force.write(b, force, friction); }
};

}  // namespace BL_SOLVER
