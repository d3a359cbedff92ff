#pragma once
#include "bedload/core/frame.hpp"
#include "bedload/core/span.hpp"
#include "kernels/fluid/equation_of_state.hpp"

namespace bedload::inline BL_VARIANT {

/// v += kick (acc + reaction); x += drift (v + beside), packed `back` before where it is.
struct KickDriftPass {
  Frame frame;
  Real kick, drift, back;                   ///< s
  Span<const Real3> acc, reaction, beside;  ///< reaction empty without grains
  Span<Real4> v_rho;
  Span<FluidPosition> x;
  Span<PairPosition> xp;

  BL_HD void operator()(Index a) const {
    const Real4 old = v_rho[a];
    Real3 v = old.xyz() + kick * acc[a];
    if (reaction) v += kick * reaction[a];
    v_rho[a] = {v, old.w};
    if (drift == 0) return;
    const Real3 move = beside ? v + beside[a] : v;
    const Vec3d at = coordinates(frame, x[a]) + Vec3d(move) * double(drift);
    x[a] = as_position<FluidPosition>(frame, at);
    xp[a] = pair_position(frame, coordinates(frame, x[a]) - Vec3d(back * v), xp[a].weight);
  }
};

constexpr Real kThinnest = Real(-0.5);  // of s; thinner fluid is spray

/// Pressure from s; velocity and, among grains, volume flux predicted by `kick` (0: Euler).
struct StatePass {
  Frame frame;
  EquationOfState eos;
  Real kick;  ///< s
  Span<const FluidPosition> x;
  Span<const Real3> acc, reaction;
  Span<Real> s;
  Span<const Real> mass, eps;
  Span<Real4> v_rho, flux, m_state;  ///< flux empty without grains
  Span<Real> p_rho2;
  Span<PairPosition> xp;

  BL_HD void operator()(Index a) const {
    Real3 gain = kick * acc[a];
    if (reaction) gain += kick * reaction[a];
    const Real compression = max_of(s[a], kThinnest), rho = eos.density(compression);
    s[a] = compression;
    v_rho[a] = {v_rho[a].xyz() + gain, rho};
    if (flux) flux[a] = {flux[a].xyz() + eps[a] * gain, rho};
    const Real M = mass[a] / eps[a], p = eos.pressure(compression) / square(rho);
    m_state[a] = {M, p, rho, eps[a]};
    p_rho2[a] = p;
    xp[a] = pair_position(frame, coordinates(frame, x[a]), M);
  }
};

}  // namespace bedload::inline BL_VARIANT
