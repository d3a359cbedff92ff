#pragma once
#include "kernels/coupling/drag_pass.hpp"

namespace bedload::inline BL_VARIANT {

/// What each grain gives back: fluid particle a at r from it receives -w (impulse - A x r), w being its share
/// of the drag (DragShares), and -phi (force - B x r). A couple has no net force; with M A = arm x impulse -
/// torque it takes the torque on the grain out of the fluid and cancels the moment of spreading off its
/// centre.
///
/// With local slip the drag of a particle follows its own velocity: it receives -w K dt (v_a - u) besides,
/// u being the mean motion around the grain, with the couple a rigid one. These parts have neither net
/// impulse nor, with the couple, net moment; the grain feels nothing of them.
struct Reactions {
  Span<Real4> impulse;       ///< N s, + A x arm; w: 1/S_j
  Span<Real3> force;         ///< N, + B x arm
  Span<Real3> spin_couple;   ///< A, N s/m
  Span<Real3> force_couple;  ///< B, N/m
  Span<Real4> mean;          ///< u at the grain's centre, m/s; w: K dt, kg
};

/// What becomes of differences of velocity around a grain.
struct LocalSlip {
  Real dt;  ///< s
  Span<const Real> K;
  Span<const Real3> U, omega_f;
};

/// Grain j makes up what it gives back.
template <bool Couple, bool Local>
struct SharePass {
  Span<const Real3> impulse, spin_impulse, fluid_force;
  GrainSurroundings surroundings;
  LocalSlip slip;
  Reactions reactions;

  BL_HD void operator()(Index j) const {
    Real3 J = impulse[j], F = fluid_force[j], u, omega;
    const Real Kdt = Local ? slip.dt * slip.K[j] : Real(0);
    if constexpr (Local) u = slip.U[j];
    if constexpr (Couple) {
      const Carriers &drag = surroundings.drag, &pressure = surroundings.pressure;
      const Real3 A = drag.couple(j, J, spin_impulse[j]), B = pressure.couple(j, F, {});
      J += cross(A, drag.arm[j]);
      F += cross(B, pressure.arm[j]);
      if constexpr (Local) {
        omega = slip.omega_f[j];
        u -= cross(omega, drag.arm[j]);
      }
      reactions.spin_couple[j] = A + Kdt * omega;
      reactions.force_couple[j] = B;
    }
    if constexpr (Local) reactions.mean[j] = {u, Kdt};
    reactions.impulse[j] = {J, surroundings.inv_S[j]};
    reactions.force[j] = F;
  }
};

/// Fluid particle a takes the drag impulse into its velocity and keeps the pressure part as an
/// acceleration [harting14] Eq. 14.
template <class W, bool Couple, bool Local>
struct ReactionPass {
  FluidWeight<W> weight;
  DragShares shares;
  Reactions reactions;
  Span<Real4> v_rho;
  Span<Real3> reaction;   ///< m/s2
  Span<Real3> drag_kick;  ///< m/s

  template <class N = Real>
  struct Sum {
    Vec3<N> impulse, force;
  };
  BL_HD Sum<> start(Index) const { return {}; }
  template <class N, class At>
  BL_HD void pair(Sum<N>& sum, Index a, At j, const Vec3<N>& r_aj, N r2) const {
    const Vec4<N> impulse = reactions.impulse[j];
    const N vw = weight(a, r2);
    const Vec3<N> v(v_rho[a].xyz());
    Vec3<N> J = impulse.xyz(), F = reactions.force[j];
    if constexpr (Local) {
      const Vec4<N> mean = reactions.mean[j];
      J += mean.w * (v - mean.xyz());
    }
    if constexpr (Couple) {
      const Vec3<N> A = reactions.spin_couple[j], B = reactions.force_couple[j];
      J -= cross(A, r_aj);
      F -= cross(B, r_aj);
    }
    sum.impulse += shares.of<Local>(j, vw, v) * J;
    sum.force += (vw * impulse.w) * F;
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.impulse += other.impulse;
    into.force += other.force;
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    const Real inv_m = 1 / weight.mass[a];
    const Real4 old = v_rho[a];
    const Real3 kick = -(inv_m * sum.impulse);
    v_rho[a] = {old.xyz() + kick, old.w};
    drag_kick[a] = kick;
    reaction[a] = -(inv_m * sum.force);
  }
};

}  // namespace bedload::inline BL_VARIANT
