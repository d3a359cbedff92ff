#pragma once
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/fluid/drive.hpp"
#include "kernels/fluid/layer_force.hpp"
#include "kernels/fluid/pair_terms.hpp"

namespace bedload::inline BL_VARIANT {

/// What a wall particle does to fluid particle a; the same terms with the opposite sign act on the wall.
struct WallPair {
  Viscosity viscosity;
  bool suction = true;  ///< whether walls hold fluid back by pressure below zero

  /// a: {v, rho}, {M, P/rho^2, ..}; b: the wall's, with its no-slip velocity `visc` (w: mass that drags).
  /// Both masses of an inactive wall particle are zero. relative: viscosity of a over that of `viscosity`.
  template <class N, class Factor>
  BL_HD Vec3<N> operator()(const Vec4<N>& va, const Vec4<N>& ma, const Vec4<N>& vw, const Vec4<N>& mw,
                           const Vec4<N>& visc, const Vec3<N>& r, N r2, const Factor& F, N relative) const {
    Vec3<N> theta = pressure(ma, mw, r, F);
    if (viscosity.acts()) theta += relative * friction(va, vw, visc, r, r2, F);
    return theta;
  }
  template <class N, class Factor>
  BL_HD Vec3<N> pressure(const Vec4<N>& ma, const Vec4<N>& mw, const Vec3<N>& r, const Factor& F) const {
    const N push = pressure_term(mw.x, ma.y, mw.y, F);
    return (suction ? push : max_of(push, N(0))) * r;
  }
  template <class N, class Factor>
  BL_HD Vec3<N> friction(const Vec4<N>& va, const Vec4<N>& vw, const Vec4<N>& visc, const Vec3<N>& r, N r2,
                         const Factor& F) const {
    return viscosity(visc.w, va.w, vw.w, va.xyz() - visc.xyz(), r, r2, F);
  }
};

/// Momentum of locally averaged WCSPH [H (9)-(12)]. theta: stress of the mixture over its density, which
/// accelerates the fluid by as much (theta M eps / m = theta) and pushes the grains by the rest of it;
/// acc = theta + gravity + drive. kArtificial: with artificial viscosity; kAdded: with the tensile term and
/// the drift of XSPH; kSpecies: fluids of several viscosities, the mean of which counts for a pair; Lengths:
/// OneLength or, without species, OwnLengths.
template <class W, bool kArtificial, bool kAdded, bool kSpecies = false, class Lengths = OneLength>
struct ForcePass {
  W w;
  WallPair wall;
  Span<const Real4> flux, m_state;
  Span<const Real> p_rho2;  ///< P / rho^2, where lengths vary over Omega, m5/(kg s2)
  Span<const Real4> wall_v_rho, wall_m_state, wall_v_visc;
  ArtificialViscosity artificial;
  TensileTerm tensile;
  Real xsph_factor;
  Real3 gravity;  ///< minus the frame's acceleration, m/s2
  Drive drive;
  Span<Real3> theta, acc, drift;
  Span<const Real> relative_viscosity = {};  ///< over that of wall.viscosity
  Span<const Real4> correction = {};         ///< of LinearFit, m/s2; empty without
  Lengths lengths = {};

  template <class N = Real>
  struct Sum {
    Vec4<N> v, m;
    Vec3<N> theta, xsph;
    N viscosity;
    typename Lengths::template Own<N> own;
  };
  BL_HD Sum<> start(Index a) const {
    Real4 m = m_state[a];
    m.y = lengths.corrected(a, m.y);
    return {flux[a], m, {}, {}, kSpecies ? relative_viscosity[a] : Real(1), lengths.template own<Real>(a)};
  }

  BL_HD auto species() const { return read_if<kSpecies>(relative_viscosity); }
  BL_HD auto sources() const { return lengths.sources(flux, p_rho2, species()); }
  /// h_b: if lengths vary.
  template <class N, class Relative, class... H>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const Vec4<N>& vb, N p,
                  [[maybe_unused]] const Relative& viscosity_b, const H&... h_b) const {
    const N distance = root(r2);
    const auto F = lengths.F(w, sum.own, distance, h_b...);
    const Vec3<N> v = sum.v.xyz() - vb.xyz();
    [[maybe_unused]] const N rho_mean = Real(0.5) * (sum.v.w + vb.w);
    N along = pressure_term(M, sum.m.y, p, F);
    if constexpr (kArtificial) along += artificial.term(M, dot(v, r), rho_mean, r2, F);
    if constexpr (kAdded) {
      along += M * tensile.R(w.W(distance), sum.m.y, p) * mean_factor(F);
      sum.xsph -= quotient(xsph_factor * M * w.W(distance), rho_mean) * v;
    }
    sum.theta += along * r;
    if (!wall.viscosity.acts()) return;
    const Vec3<N> friction = wall.viscosity(M, sum.v.w, vb.w, v, r, r2, F);
    if constexpr (kSpecies)
      sum.theta += Real(0.5) * (sum.viscosity + viscosity_b) * friction;
    else
      sum.theta += friction;
  }
  BL_HD auto wall_sources() const { return sources_of(wall_v_rho, wall_m_state, wall_v_visc); }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const Vec4<N>& vb, const Vec4<N>& mb,
                       const Vec4<N>& visc) const {
    sum.theta += wall(sum.v, sum.m, vb, mb, visc, r, r2, lengths.F(w, sum.own, root(r2)),
                      kSpecies ? sum.viscosity : N(1));
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.theta += other.theta;
    into.xsph += other.xsph;
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    Real3 stress = sum.theta;
    if (correction) stress += correction[a].xyz();
    theta[a] = stress;
    acc[a] = stress + gravity + drive(a, sum.m);
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

/// Force of the mixture on each wall particle [N]: minus what ForcePass and LayerPass gave it, by velocities
/// that have been corrected by `kick` since. `Force`: WholeForce, which leaves `friction` alone, or
/// ForceParts.
template <class W, class Force, class Lengths>
struct WallForcePass {
  W w;
  WallPair wall;
  LayerForces<W> layer;  ///< empty without single layers
  Real kick;             ///< s
  Span<const Real3> acc, acc_before;
  Span<const Real4> flux, m_state, wall_v_rho, wall_m_state, wall_v_visc;
  Span<const std::uint32_t> wall_body;
  Span<Vec3d> force, friction;
  Span<const Real> relative_viscosity;  ///< of fluid over that of wall.viscosity; empty: the same
  Lengths lengths = {};

  struct Sum {
    Real4 v, m, visc;  ///< of the wall particle
    std::uint32_t body;
    Force force;
  };
  BL_HD Sum start(Index b) const {
    return {wall_v_rho[b], wall_m_state[b], wall_v_visc[b], wall_body[b], {}};
  }
  BL_HD auto sources() const {
    return lengths.sources(flux, m_state, lengths.corrections(), read_where(kick != 0, acc),
                           read_where(kick != 0, acc_before),
                           read_where(bool(relative_viscosity), relative_viscosity, Real(1)));
  }
  /// h_a: if lengths vary.
  template <class Correction, class... H>
  BL_HD void pair(Sum& sum, const Real3& r_ba, Real r2, Real, const Real4& flux_a, const Real4& state,
                  const Correction& correction, const Real3& acc_a, const Real3& acc_before_a, Real relative,
                  const H&... h_a) const {
    const Real4 va{flux_a.xyz() - kick * (acc_a - acc_before_a), flux_a.w};
    const Real4 ma{state.x, lengths.corrected_by(correction, state.y), state.z, state.w};
    const auto F = lengths.F(w, lengths.template own_of<Real>(h_a...), std::sqrt(r2));
    Real3 push = wall.pressure(ma, sum.m, -r_ba, F), drag;
    if (wall.viscosity.acts()) drag = relative * wall.friction(va, sum.v, sum.visc, -r_ba, r2, F);
    if (layer.law) {
      const auto more = layer(va, sum.v, sum.body, -r_ba, r2);
      push += more.push;
      drag += more.damping;
    }
    sum.force.add(-ma.x * push, -ma.x * drag);
  }
  BL_HD void merge(Sum& into, const Sum& other) const { into.force.add(other.force); }
  BL_HD void finish(Index b, const Sum& sum) const { sum.force.write(b, force, friction); }
};

}  // namespace bedload::inline BL_VARIANT
