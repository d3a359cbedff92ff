#pragma once
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/coupling/drag_pass.hpp"

namespace BL_SOLVER {

/// Reaction of each grain on the fluid: particle a at r from it receives -w (impulse - A x r), with the drag
/// weight w (DragWeights), and -phi (force - B x r). A couple has no net force. With M A = arm x impulse -
/// torque it applies the reaction to the grain's torque and cancels the moment of spreading off the centre;
/// with M B = lost_moment and force = B x arm it returns the moment that was lost when the grain took its
/// part of the stress.
///
/// With local slip the drag on a particle follows its own velocity: it also receives -w K dt (v_a - u), u
/// being the mean motion around the grain, a rigid one with the couple. These parts have no net impulse and,
/// with the couple, no net moment; they do not act on the grain.
struct Reactions {
  Span<Real4> impulse;  ///< N s, + A x arm - K dt (u - v_j), u at the grain's centre; w: K dt, kg
  Span<Real4> force;    ///< over S_j, N; w: DragLevers::at_centre
  Span<Real4> spin;     ///< A, N s/m; w: DragWeights::still
  Span<Real4> couple;   ///< B over S_j, N/m; w: DragLevers::off_centre
};

/// Computes the reaction of grain j.
template <bool Couple, bool Local>
struct ReactionTermsPass {
  Span<const Real3> impulse, spin_impulse;
  GrainSurroundings surroundings;
  DragWeights weights;
  DragLevers levers;
  Real dt;  ///< s
  DragView drag;
  Reactions reactions;

  BL_HD void operator()(Index j) const {
    Real3 J = impulse[j], F, A, u;
    Real lever = 1;
    const Real Kdt = dt * drag.coefficient[j];
    if constexpr (Local) u = drag.velocity[j] - weights.by_slip[j].xyz();
    if constexpr (Couple) {
      const Carriers &carriers = surroundings.drag, &stress = surroundings.stress;
      const Real3 B = stress.inv_M[j] * surroundings.lost_moment[j];
      A = carriers.couple(j, J, spin_impulse[j]);
      J += cross(A, carriers.arm[j]);
      F = cross(B, stress.arm[j]);
      if constexpr (Local) A += Kdt * drag.rotation[j];
      lever = levers.at_centre[j];
      reactions.couple[j] = {surroundings.inv_S[j] * B, levers.off_centre[j]};
    }
    reactions.impulse[j] = {J - Kdt * u, Kdt};
    reactions.force[j] = {surroundings.inv_S[j] * F, lever};
    reactions.spin[j] = {A, weights.still[j]};
  }
};

/// Applies the drag impulse to the velocity of fluid particle a [harting14] Eq. 14; the couples of the stress
/// become an acceleration. Also finds the rate of drag, as DragRatePass does.
template <class W, bool Couple, bool Local, class Averages = OneAverage>
struct ReactionPass {
  W w;
  Averages averages = {};
  Span<const Real> mass;
  Span<const EosState<>> eos_state;
  Span<const Real4> by_slip;  ///< of DragWeights
  Reactions reactions;
  Real per_dt;  ///< 1/s
  Span<VelocityDensity<>> v_rho;
  Span<Real3> reaction;   ///< m/s2
  Span<Real3> drag_kick;  ///< m/s
  Span<Real> rate;        ///< 1/s

  template <class N = Real>
  struct Sum {
    Vec3<N> v;
    N V;
    Vec3<N> impulse, force;
    N L;
  };
  BL_HD Sum<> start(Index a) const { return {v_rho[a].v, mixture_volume(eos_state[a]), {}, {}, 0}; }
  BL_HD auto sources() const {
    const auto& [impulse, force, spin, couple] = reactions;
    return sources_of(impulse, force, spin, read_if<Couple>(couple), read_if<Local>(by_slip),
                      averages.field());
  }
  template <class N, class C, class Slip, class Own>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r_aj, N r2, N, const Vec4<N>& impulse, const Vec4<N>& force,
                  const Vec4<N>& spin, [[maybe_unused]] const C& couple, [[maybe_unused]] const Slip& grain,
                  const Own& own) const {
    const N r = root(r2), vw = sum.V * averages.W(w, own, r);
    N weight = spin.w;
    Vec3<N> J = impulse.xyz(), F = force.xyz();
    if constexpr (Local) {
      weight += slip_weight(sum.v, grain);
      J += impulse.w * (sum.v - grain.xyz());
    }
    const N drag = vw * weight;
    N L = impulse.w * drag;
    if constexpr (Couple) {
      J -= cross(spin.xyz(), r_aj);
      F -= cross(couple.xyz(), r_aj);
      L *= force.w + couple.w * r;
    }
    sum.L += L;
    sum.impulse += drag * J;
    sum.force += vw * F;
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.impulse += other.impulse;
    into.force += other.force;
    into.L += other.L;
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    const Real inv_m = 1 / mass[a];
    const VelocityDensity<> old = v_rho[a];
    const Real3 kick = -(inv_m * sum.impulse);
    v_rho[a] = {old.v + kick, old.rho};
    drag_kick[a] = kick;
    reaction[a] = -(inv_m * sum.force);
    rate[a] = inv_m * per_dt * sum.L;
  }
};

}  // namespace BL_SOLVER
