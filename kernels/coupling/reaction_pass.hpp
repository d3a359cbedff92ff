#pragma once
#include "kernels/coupling/drag_pass.hpp"

namespace bedload::inline BL_VARIANT {

/// What each grain gives back: fluid particle a at r from it receives -w (impulse - A x r), w being its
/// weight of the drag (DragWeights), and -phi (force - B x r). A couple has no net force: with M A = arm x
/// impulse - torque it takes the torque on the grain out of the fluid and cancels the moment of spreading off
/// its centre, and with M B = lost_moment, force = B x arm, it returns what moment the stress shared with the
/// grain has lost.
///
/// With local slip the drag of a particle follows its own velocity: it receives -w K dt (v_a - u) besides,
/// u being the mean motion around the grain, with the couple a rigid one. These parts have neither net
/// impulse nor, with the couple, net moment; they do not act on the grain.
struct Reactions {
  Span<Real4> impulse;  ///< N s, + A x arm - K dt (u - v_j), u at the grain's centre; w: K dt, kg
  Span<Real4> force;    ///< N; w: 1/S_j
  Span<Real4> spin;     ///< A, N s/m; w: DragWeights::still
  Span<Real4> couple;   ///< B, N/m
};

/// What becomes of differences of velocity around a grain.
struct LocalSlip {
  Real dt;  ///< s
  Span<const Real> K;
  Span<const Real3> U, omega_f;
};

/// Grain j makes up what it gives back.
template <bool Couple, bool Local>
struct ReactionTermsPass {
  Span<const Real3> impulse, spin_impulse;
  GrainSurroundings surroundings;
  DragWeights weights;
  LocalSlip slip;
  Reactions reactions;

  BL_HD void operator()(Index j) const {
    Real3 J = impulse[j], F, A, u;
    const Real Kdt = Local ? slip.dt * slip.K[j] : Real(0);
    if constexpr (Local) u = slip.U[j] - weights.by_slip[j].xyz();
    if constexpr (Couple) {
      const Carriers &drag = surroundings.drag, &stress = surroundings.stress;
      const Real3 B = stress.inv_M[j] * surroundings.lost_moment[j];
      A = drag.couple(j, J, spin_impulse[j]);
      J += cross(A, drag.arm[j]);
      F = cross(B, stress.arm[j]);
      if constexpr (Local) A += Kdt * slip.omega_f[j];
      reactions.couple[j] = {B, 0};
    }
    reactions.impulse[j] = {J - Kdt * u, Kdt};
    reactions.force[j] = {F, surroundings.inv_S[j]};
    reactions.spin[j] = {A, weights.still[j]};
  }
};

/// Fluid particle a takes the drag impulse into its velocity [harting14] Eq. 14 and keeps the couples of the
/// stress as an acceleration.
template <class W, bool Couple, bool Local>
struct ReactionPass {
  W w;
  Span<const Real> mass;
  Span<const Real4> m_state;
  Span<const Real4> by_slip;  ///< of DragWeights
  Reactions reactions;
  Span<Real4> v_rho;
  Span<Real3> reaction;   ///< m/s2
  Span<Real3> drag_kick;  ///< m/s

  template <class N = Real>
  struct Sum {
    Vec3<N> v;
    N V;
    Vec3<N> impulse, force;
  };
  BL_HD Sum<> start(Index a) const { return {v_rho[a].xyz(), mixture_volume(m_state[a]), {}, {}}; }
  template <class N, class At>
  BL_HD void pair(Sum<N>& sum, Index, At j, const Vec3<N>& r_aj, N r2) const {
    const Vec4<N> impulse = reactions.impulse[j], force = reactions.force[j], spin = reactions.spin[j];
    const N vw = sum.V * w.W(root(r2));
    N weight = spin.w;
    Vec3<N> J = impulse.xyz(), F = force.xyz();
    if constexpr (Local) {
      const Vec4<N> grain = by_slip[j];
      const Vec3<N> slip = sum.v - grain.xyz();
      weight += grain.w * root(norm2(slip));
      J += impulse.w * slip;
    }
    if constexpr (Couple) {
      const Vec4<N> couple = reactions.couple[j];
      J -= cross(spin.xyz(), r_aj);
      F -= cross(couple.xyz(), r_aj);
    }
    sum.impulse += (vw * weight) * J;
    sum.force += (vw * force.w) * F;
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.impulse += other.impulse;
    into.force += other.force;
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    const Real inv_m = 1 / mass[a];
    const Real4 old = v_rho[a];
    const Real3 kick = -(inv_m * sum.impulse);
    v_rho[a] = {old.xyz() + kick, old.w};
    drag_kick[a] = kick;
    reaction[a] = -(inv_m * sum.force);
  }
};

}  // namespace bedload::inline BL_VARIANT
