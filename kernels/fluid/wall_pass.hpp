#pragma once
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/fluid/equation_of_state.hpp"
#include "kernels/fluid/views.hpp"
#include "kernels/smoothing/lengths.hpp"

namespace BL_SOLVER {

/// State of wall particles extrapolated from the fluid around [adami12], [he18] Eqs. 13-15. With <> the mean
/// over fluid particles a weighted by W_wa, r from a to w, and x_f the mean position of that fluid:
///   P_w = <P + rho r . (g - a_w + `rate` drag_kick)>,     rho_w by the equation of state,
///   v_noslip = 2 v_w - <v> + v_body(x_f) - v_body(x_w).
/// a_w: acceleration of the wall; its centripetal part counts by the square of the fraction of the rotation
/// that the fluid has (turning_along): fluid that does not rotate with a drum is not held on a circle. The
/// last two terms of v_noslip leave fluid in rigid rotation with its vessel without friction. Inlets, single
/// layers and frozen walls: v_noslip = v_w.
/// Other kinds (WallKind): frozen and mirrored particles take P from their own `compression`, if they have
/// one; frozen ones have a fixed mass. Single layers keep rho0 and its pressure: fluid near them becomes
/// denser by their mass and is repelled by its own pressure.
template <class W, class Lengths = OneLength>
struct WallPass {
  W w;
  EquationOfState eos;
  FluidView fluid;
  Span<const Real3> drag_kick;  ///< velocity that the grains' drag gave the fluid this step, m/s
  Real rate;                    ///< 1 / step, 1/s; 0 without grains
  Span<const Vec3d> x0;         ///< at t = 0, m
  WallBodies bodies;
  Real3 gravity;   ///< m/s2
  Real least_sum;  ///< inactive below this sum of W, 1/m3
  Span<VelocityDensity<>> v_rho;
  Span<NoSlip<>> no_slip;
  Span<WallState<>> state;
  Span<Real> compression;
  Lengths lengths = {};

  template <class N = Real>
  struct Sum {
    N weight, p;
    Vec3<N> v, rho_r;  ///< r from the fluid to the wall
  };
  BL_HD Sum<> start(Index) const { return {}; }
  BL_HD auto sources() const {
    return lengths.sources(fluid.flux, fluid.state, read_where(rate > 0, drag_kick));
  }
  /// h_a: if lengths vary.
  template <class N, class... H>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r_wf, N r2, N, const VelocityDensity<N>& a,
                  const EosState<N>& m, const Vec3<N>& kick, const H&... h_a) const {
    const N wk = lengths.W(w, lengths.template own_of<N>(h_a...), root(r2));
    const Vec3<N> rho_r = wk * m.rho * r_wf;
    sum.weight += wk;
    sum.p += wk * m.p_over_rho2 * square(m.rho);
    sum.p += rate * dot(kick, rho_r);
    sum.v += wk * a.v;
    sum.rho_r += rho_r;
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.weight += other.weight;
    into.p += other.p;
    into.v += other.v;
    into.rho_r += other.rho_r;
  }
  BL_HD void finish(Index b, const Sum<>& sum) const {
    const BodyPose& k = bodies[b];
    const Vec3d at = k.place(x0[b]);
    const Real3 v_wall = Real3(k.velocity(at)), v_surface = v_wall + Real3(k.rotation.rotate(k.slide));
    if (sum.weight < least_sum || !k.present) {
      v_rho[b] = {v_wall, eos.rho0};
      no_slip[b] = {v_wall, 0};
      state[b] = {.rho = eos.rho0};
      return;
    }
    const bool was_dry = state[b].mass == 0;
    const Real3 v_fluid = sum.v / sum.weight;
    const Real3 push = gravity - Real3(k.speeding_up(at)) -
                       square(turning_along(k, v_wall, v_fluid)) * Real3(k.centripetal(at));
    Real p = (sum.p + dot(push, sum.rho_r)) / sum.weight, x = eos.compression(p);
    const Real own = compression[b];
    bool frozen = false, prescribed = k.flows;  // mass; velocity for friction
    switch (k.kind) {
      case WallKind::extrapolated:
        break;
      case WallKind::frozen:
        frozen = prescribed = true;
        if (own == kNoCompression)
          p = eos.pressure(x = 0);
        else if (was_dry)
          compression[b] = x;  // begins in balance with the fluid that has come
        else
          p = eos.pressure(x = own);
        break;
      case WallKind::mirrored:
        if (own != kNoCompression) p = eos.pressure(x = own);
        break;
      case WallKind::single_layer:
        prescribed = true;
        p = eos.pressure(x = 0);
        break;
    }
    const Real rho = eos.rho0 * (1 + x), mass = (frozen ? eos.rho0 : rho) * Real(k.volume);
    v_rho[b] = {v_wall, rho};
    const Real3 away = sum.rho_r / (sum.weight * eos.rho0);  // of the wall from the middle of the fluid, m
    const Real3 inward = Real3(k.velocity(at - Vec3d(away))) - v_wall;
    no_slip[b] = {.v = prescribed ? v_surface : 2 * v_surface + inward - v_fluid,
                  .mass = k.slip ? Real(0) : mass};
    state[b] = {.mass = mass, .p_over_rho2 = p / square(rho), .rho = rho, .frozen = Real(frozen ? 1 : 0)};
  }

 private:
  /// Fraction of the wall's velocity of rotation that fluid next to it has, 0..1.
  BL_HD static Real turning_along(const BodyPose& k, const Real3& v_wall, const Real3& v_fluid) {
    const Real3 turn = v_wall - Real3(k.v);
    const Real speed2 = norm2(turn);
    return speed2 > 0 ? clamp(dot(v_fluid - Real3(k.v), turn) / speed2, Real(0), Real(1)) : Real(1);
  }
};

/// Work of the pressure that WallPass extrapolates, P_w = sum_a s_wa P_a, s_wa = W_wa / sum_b W_wb, on the
/// fluid around a wall particle: its power is P_w V_w D_w with
///   D_w = sum_b V_b F_wb (v_w - q_b) . r_wb.
/// Wall particles have no elastic energy, so the fluid pays: DensityPass adds rho_a^2 / M_a sum_w W_wa
/// work_w, work_w = V_w D_w / sum_b W_wb, the adjoint of the mean, to its continuity sum. Between walls at
/// rest pressure then conserves energy, unless walls have no suction. The hydrostatic, inertial and drag
/// parts of the extrapolation are not compensated. Frozen walls have a density, hence an energy, and need
/// none.
template <class W, class Lengths = OneLength>
struct WallWorkPass {
  W w;
  Real least_sum;  ///< walls are dry below this sum of W, 1/m3
  FluidView fluid;
  WallView walls;
  WallBodies bodies;
  Span<Real> work;  ///< V_w D_w / sum W, m6/s
  Lengths lengths = {};

  template <class N = Real>
  struct Sum {
    Vec3<N> v;
    N opening, weight;  ///< sums of V F v . r, 1/s, and W, 1/m3
  };
  BL_HD Sum<> start(Index b) const { return {walls.v_rho[b].v, 0, 0}; }
  BL_HD auto sources() const { return lengths.sources(fluid.flux); }
  /// h_a: if lengths vary.
  template <class N, class... H>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& qa,
                  const H&... h_a) const {
    const N distance = root(r2);
    const auto own = lengths.template own_of<N>(h_a...);
    sum.opening += quotient(M, qa.rho) * own_factor(lengths.F(w, own, distance)) * dot(sum.v - qa.v, r);
    sum.weight += lengths.W(w, own, distance);
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.opening += other.opening;
    into.weight += other.weight;
  }
  BL_HD void finish(Index b, const Sum<>& sum) const {
    const WallState<> m = walls.state[b];
    const BodyPose& k = bodies[b];
    const bool pays = sum.weight >= least_sum && k.kind == WallKind::extrapolated && !k.flows;
    work[b] = pays ? m.mass / m.rho * sum.opening / sum.weight : 0;
  }
};

}  // namespace BL_SOLVER
