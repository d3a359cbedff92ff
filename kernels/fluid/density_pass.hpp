#pragma once
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/smoothing/half_space_share.hpp"

namespace bedload::inline BL_VARIANT {

/// Continuity [H (6)], [R (7)] with density diffusion (Fourtakas et al. 2019): advances
/// s = rho~/rho0 - 1 over `dt`. Kick-drift-kick evaluates pairs half a step back (`back` = dt/2,
/// with the half-step velocities), which makes the step reversible; Euler where they are (0).
/// Continuity is how the sum of m W changes; a wall's mass changes with its porosity, which belongs to it:
/// else fluid that enters a bed in its midst and leaves it along a wall comes out ever denser. Walls count at
/// rho0: with the density of their pressure, a wall that slides past resting fluid would change the fluid's
/// density for as long as it slides.
/// Continuity tells changes of that sum alone. Fluid that has been torn, whose density does not follow how
/// thin it is, keeps what it then missed when it joins again, and would stand under pressure with room
/// between its particles. So pressure fades where less of the kernel is filled than a plane surface would
/// leave, as fast as it is high and the room wide, until the fluid fills its volume.
template <class W>
struct DensityPass {
  W w;
  Span<const Real4> v_rho, m_state, wall_v_rho, wall_m_state;
  Span<const Real> eps;
  Real diffusion;       ///< 2 delta h c [m2/s]
  Real3 hydrostatic;    ///< rho0 g / c^2 [kg/m4]: how density grows downwards at rho0
  Real stiffening;      ///< and by which power of rho0 / rho elsewhere: gamma - 2
  Real rho0, dt, back;  ///< kg/m3, s, s
  Span<const Real> s;
  Span<Real> s_new;
  CutShare cut;
  Real fading;        ///< of pressure where there is room [1/s]
  Span<Real> filled;  ///< share of the kernel that fluid and walls fill at the end

  template <class N = Real>
  struct Sum {
    Vec3<N> v;
    N rho, eps, rate, diffused, came, filled;
    Vec3<N> gradient;
  };
  BL_HD Sum<> start(Index a) const { return {v_rho[a].xyz(), m_state[a].z, eps[a], 0, 0, 0, 0, {}}; }

  template <class N, class J>
  BL_HD void pair(Sum<N>& sum, Index, J b, const Vec3<N>& r, N) const {
    const Vec4<N> vb = v_rho[b], mb = m_state[b];
    const Vec3<N> v = sum.v - vb.xyz();
    const Vec3<N> rm = r - back * v;
    const N F = w.F(norm(rm));
    sum.rate += mb.x * F * dot(v, rm);
    const N V = mb.x / vb.w;
    sum.filled += V * w.W(norm(r));
    sum.gradient += V * F * rm;
    const N still = 1 - stiffening * (Real(0.5) * (sum.rho + mb.z) / rho0 - 1);
    const N shared = Real(0.5) * (sum.eps + vb.w / mb.z);  // what one gains the other loses
    sum.diffused += shared * V * F * (mb.z - sum.rho + still * dot(Vec3<N>(hydrostatic), rm));
  }
  template <class N, class J>
  BL_HD void wall_pair(Sum<N>& sum, Index, J b, const Vec3<N>& r, N) const {
    const Vec4<N> vb = wall_v_rho[b], mb = wall_m_state[b];
    const Vec3<N> v = sum.v - vb.xyz();
    const Vec3<N> rm = r - back * v;
    const N V = mb.x / vb.w, F = w.F(norm(rm));
    sum.rate += mb.x * rho0 / mb.z * F * dot(v, rm);
    // m W changes by m dW on the way and by W dm where it began: walls that slide past a bed bring nothing
    sum.came += mb.w * w.W(norm(r - dt * v));
    sum.filled += V * w.W(norm(r));
    sum.gradient += V * F * rm;
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.rate += other.rate;
    into.diffused += other.diffused;
    into.came += other.came;
    into.filled += other.filled;
    into.gradient += other.gradient;
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    filled[a] = m_state[a].x / v_rho[a].w * w.W(Real(0)) + sum.filled;
    const Real room = max_of(Real(0), 1 - filled[a] - cut(norm(sum.gradient)));
    const Real pressed = max_of(Real(0), sum.rho / rho0 - 1);
    s_new[a] = s[a] + (dt * (diffusion * sum.diffused - sum.rate) + sum.came) / rho0 -
               min_of(dt * fading * room, Real(1)) * eps[a] * pressed;
  }
};

}  // namespace bedload::inline BL_VARIANT
