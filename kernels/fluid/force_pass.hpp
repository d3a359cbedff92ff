#pragma once
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/fluid/drive.hpp"
#include "kernels/fluid/layer_force.hpp"
#include "kernels/fluid/pair_terms.hpp"
#include "kernels/fluid/views.hpp"

namespace BL_SOLVER {

/// What a wall particle does to fluid particle a; the same terms with the opposite sign act on the wall.
struct WallPair {
  Viscosity viscosity;
  bool suction = true;  ///< whether walls hold fluid back by pressure below zero

  /// va, vw: velocity and density. Both masses of a dry wall particle are zero. relative: viscosity of a over
  /// that of `viscosity`.
  template <class N, class Factor>
  BL_HD Vec3<N> operator()(const VelocityDensity<N>& va, const EosState<N>& ma, const VelocityDensity<N>& vw,
                           const WallState<N>& mw, const NoSlip<N>& no_slip, const Vec3<N>& r, N r2,
                           const Factor& F, N relative) const {
    Vec3<N> stress = pressure(ma, mw, r, F);
    if (viscosity.acts()) stress += relative * friction(va, vw, no_slip, r, r2, F);
    return stress;
  }
  template <class N, class Factor>
  BL_HD Vec3<N> pressure(const EosState<N>& ma, const WallState<N>& mw, const Vec3<N>& r,
                         const Factor& F) const {
    const N push = pressure_term(mw.mass, ma.p_over_rho2, mw.p_over_rho2, F);
    return (suction ? push : max_of(push, N(0))) * r;
  }
  template <class N, class Factor>
  BL_HD Vec3<N> friction(const VelocityDensity<N>& va, const VelocityDensity<N>& vw, const NoSlip<N>& no_slip,
                         const Vec3<N>& r, N r2, const Factor& F) const {
    return viscosity(no_slip.mass, va.rho, vw.rho, va.v - no_slip.v, r, r2, F);
  }
};

/// Momentum equation of locally averaged WCSPH [he18] Eqs. 9-12:
///   stress_acceleration_a = sum_b [M_b (P_a / rho_a^2 + P_b / rho_b^2) F_ab r_ab + viscous terms] + walls,
///   acc = stress_acceleration + gravity + drive.
/// M_a times stress_acceleration is the force on the volume of fluid and grains; the fluid takes the fraction
/// eps_a of it, grains the rest (BuoyancyPass). kArtificial: with artificial viscosity; kAdded: with the
/// tensile term and the drift of XSPH; kSpecies: fluids of several viscosities, a pair taking their mean;
/// Lengths: OneLength or, without species, OwnLengths.
template <class W, bool kArtificial, bool kAdded, bool kSpecies = false, class Lengths = OneLength>
struct ForcePass {
  W w;
  WallPair wall;
  FluidView fluid;
  Span<const Real> p_rho2;  ///< P / rho^2, where lengths vary over Omega, m5/(kg s2)
  WallView walls;
  ArtificialViscosity artificial;
  TensileTerm tensile;
  Real xsph_factor;
  Real3 gravity;  ///< minus the frame's acceleration, m/s2
  Drive drive;
  FluidAccelerations out;
  Span<Real3> drift;
  Span<const Real> relative_viscosity = {};  ///< over that of wall.viscosity
  Span<const Real4> correction = {};         ///< of LinearFit, m/s2; empty without
  Lengths lengths = {};

  template <class N = Real>
  struct Sum {
    VelocityDensity<N> a;
    EosState<N> m;
    Vec3<N> stress, xsph;
    N viscosity;
    typename Lengths::template Own<N> own;
  };
  BL_HD Sum<> start(Index a) const {
    EosState<> m = fluid.state[a];
    m.p_over_rho2 = lengths.corrected(a, m.p_over_rho2);
    return {
        fluid.flux[a], m, {}, {}, kSpecies ? relative_viscosity[a] : Real(1), lengths.template own<Real>(a)};
  }

  BL_HD auto species() const { return read_if<kSpecies>(relative_viscosity); }
  BL_HD auto sources() const { return lengths.sources(fluid.flux, p_rho2, species()); }
  /// h_b: if lengths vary.
  template <class N, class Relative, class... H>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& vb, N p,
                  [[maybe_unused]] const Relative& viscosity_b, const H&... h_b) const {
    const N distance = root(r2);
    const auto F = lengths.F(w, sum.own, distance, h_b...);
    const Vec3<N> v = sum.a.v - vb.v;
    [[maybe_unused]] const N rho_mean = Real(0.5) * (sum.a.rho + vb.rho);
    N along = pressure_term(M, sum.m.p_over_rho2, p, F);
    if constexpr (kArtificial) along += artificial.term(M, dot(v, r), rho_mean, r2, F);
    if constexpr (kAdded) {
      along += M * tensile.R(w.W(distance), sum.m.p_over_rho2, p) * mean_factor(F);
      sum.xsph -= quotient(xsph_factor * M * w.W(distance), rho_mean) * v;
    }
    sum.stress += along * r;
    if (!wall.viscosity.acts()) return;
    const Vec3<N> friction = wall.viscosity(M, sum.a.rho, vb.rho, v, r, r2, F);
    if constexpr (kSpecies)
      sum.stress += Real(0.5) * (sum.viscosity + viscosity_b) * friction;
    else
      sum.stress += friction;
  }
  BL_HD auto wall_sources() const { return sources_of(walls.v_rho, walls.state, walls.no_slip); }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const VelocityDensity<N>& vb,
                       const WallState<N>& mb, const NoSlip<N>& no_slip) const {
    sum.stress += wall(sum.a, sum.m, vb, mb, no_slip, r, r2, lengths.F(w, sum.own, root(r2)),
                       kSpecies ? sum.viscosity : N(1));
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.stress += other.stress;
    into.xsph += other.xsph;
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    Real3 stress = sum.stress;
    if (correction) stress += correction[a].xyz();
    out.set(a, stress, stress + gravity + drive(a, sum.m));
    if (kAdded && xsph_factor > 0) drift[a] += sum.xsph;
  }
};

/// The force on a wall particle as a whole.
struct WholeForce {
  Vec3d sum;  ///< N
  BL_HD void add(const Real3& pressure, const Real3& friction) { sum += Vec3d(pressure + friction); }
  BL_HD void add(const WholeForce& other) { sum += other.sum; }
  BL_HD void write(Index b, Span<Vec3d> force, Span<Vec3d>) const { force[b] = sum; }
};
/// Its parts: pressure with the push of single layers; friction.
struct ForceParts {
  Vec3d pressure, friction;  ///< N
  BL_HD void add(const Real3& p, const Real3& f) { pressure += Vec3d(p), friction += Vec3d(f); }
  BL_HD void add(const ForceParts& other) { pressure += other.pressure, friction += other.friction; }
  BL_HD void write(Index b, Span<Vec3d> p, Span<Vec3d> f) const { p[b] = pressure, f[b] = friction; }
};

/// What correct() has changed since the forces were found, undone: velocities by `kick` of what the
/// acceleration has changed.
struct BeforeCorrection {
  Real kick;  ///< s
  Span<const Real3> acc, acc_before;
  /// To be read of a neighbour: acc, or acc_before.
  BL_HD auto source(Span<const Real3> field) const { return read_where(kick != 0, field); }
  BL_HD VelocityDensity<> operator()(const VelocityDensity<>& a, const Real3& acc_a,
                                     const Real3& acc_before_a) const {
    return {a.v - kick * (acc_a - acc_before_a), a.rho};
  }
};

/// Force of the mixture on each wall particle [N], the reaction to ForcePass and LayerPass. `Force`:
/// WholeForce, which leaves `friction` alone, or ForceParts.
template <class W, class Force, class Lengths>
struct WallForcePass {
  W w;
  WallPair wall;
  LayerForces<W> layer;  ///< empty without single layers
  BeforeCorrection before;
  FluidView fluid;
  WallView walls;
  Span<const std::uint32_t> wall_body;
  Span<Vec3d> force, friction;
  Span<const Real> relative_viscosity;  ///< of fluid over that of wall.viscosity; empty: the same
  Lengths lengths = {};

  struct Sum {
    VelocityDensity<> v;  ///< of the wall particle, as the next
    WallState<> m;
    NoSlip<> no_slip;
    std::uint32_t body;
    Force force;
  };
  BL_HD Sum start(Index b) const {
    return {walls.v_rho[b], walls.state[b], walls.no_slip[b], wall_body[b], {}};
  }
  BL_HD auto sources() const {
    return lengths.sources(fluid.flux, fluid.state, lengths.corrections(), before.source(before.acc),
                           before.source(before.acc_before),
                           read_where(bool(relative_viscosity), relative_viscosity, Real(1)));
  }
  /// h_a: if lengths vary.
  template <class Correction, class... H>
  BL_HD void pair(Sum& sum, const Real3& r_ba, Real r2, Real, const VelocityDensity<>& flux_a,
                  const EosState<>& state, const Correction& correction, const Real3& acc_a,
                  const Real3& acc_before_a, Real relative, const H&... h_a) const {
    const VelocityDensity<> va = before(flux_a, acc_a, acc_before_a);
    EosState<> ma = state;
    ma.p_over_rho2 = lengths.corrected_by(correction, ma.p_over_rho2);
    const auto F = lengths.F(w, lengths.template own_of<Real>(h_a...), std::sqrt(r2));
    Real3 push = wall.pressure(ma, sum.m, -r_ba, F), drag;
    if (wall.viscosity.acts()) drag = relative * wall.friction(va, sum.v, sum.no_slip, -r_ba, r2, F);
    if (layer.law) {
      const auto more = layer(va, sum.v, sum.body, -r_ba, r2);
      push += more.push;
      drag += more.damping;
    }
    sum.force.add(-ma.mass_over_eps * push, -ma.mass_over_eps * drag);
  }
  BL_HD void merge(Sum& into, const Sum& other) const { into.force.add(other.force); }
  BL_HD void finish(Index b, const Sum& sum) const { sum.force.write(b, force, friction); }
};

}  // namespace BL_SOLVER
