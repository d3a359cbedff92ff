#pragma once
#include "kernels/coupling/averaging.hpp"
#include "kernels/coupling/carriers.hpp"
#include "kernels/coupling/fluid_records.hpp"

namespace BL_SOLVER {

/// Interpolated fluid around a grain, kept until the reaction is applied.
struct GrainSurroundings {
  Span<Real> inv_S;       ///< 0: dry
  Span<Real> rho;         ///< intrinsic fluid density, kg/m3
  Span<FlowSums<>> flow;  ///< by V_a W
  Span<FlowSums<>> fast;  ///< by V_a W |u|
  Span<Real> fast_slip;   ///< mean of |u| by that weight, m/s
  Carriers stress, drag;  ///< weighted with phi_ja and with phi_ja K_ja
  /// Of the stress that the grain takes at its centre instead of where the fluid is, N m.
  Span<Real3> lost_moment;
};

/// Interpolates the fluid to grain j: porosity, input of DragPass, and the moment lost because the grain
/// takes its part of the stress at its own centre; the part of its volume that walls cut off is left out,
/// since walls support it. Moments: rotation and couple are needed; Local: drag follows the slip of each
/// particle.
template <class W, bool Moments, bool Local, class Averages = OneAverage>
struct InterpolationPass {
  W w;
  Averages averages = {};
  Real S_least, eps_min;  ///< S_least: value of S below which no mean is defined
  Span<const VelocityDensity<>> v_rho;
  FluidRecords fluid;
  Span<const Real3> v, fluid_force;
  Span<const Real4> volume;  ///< w: of GrainVolumePass
  Span<const Real> wall_free;
  Span<Real> eps, bed_eps;  ///< bed_eps: porosity of the bed, also near orifices
  GrainSurroundings surroundings;

  /// Sums over the fluid of V_a W times what is named; velocities relative to the grain.
  template <class N = Real>
  struct Sum {
    Vec3<N> v_grain;
    N eps{}, counted{}, rho{}, speed2{};
    Vec3<N> turn;
    FlowSums<N> flow, fast;
    [[no_unique_address]] typename Averages::template Own<N> own;
  };
  BL_HD Sum<> start(Index j) const {
    Sum<> sum;
    sum.v_grain = v[j];
    sum.own = averages.own(j);
    return sum;
  }
  BL_HD auto sources() const {
    const Span<const Real> counted = fluid.counted;
    return sources_of(v_rho, fluid.push, read_where(bool(counted), counted, Real(1)));
  }
  template <class N>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r_ja, N r2, N M, const VelocityDensity<N>& a,
                  const Vec4<N>& push, const N& counted) const {
    const N W_ja = averages.W(w, sum.own, root(r2)), vw = mixture_volume(M, a.rho) * W_ja;
    const Vec3<N> u = a.v - sum.v_grain;
    sum.eps += vw * push.w;
    sum.rho += vw * a.rho;
    sum.counted += vw * counted;
    if constexpr (Moments) sum.turn -= W_ja * cross(r_ja, push.xyz());
    sum.flow.template add<Moments>(vw, u, -r_ja);
    if constexpr (Local) {
      const N speed2 = norm2(u);
      sum.fast.template add<Moments>(vw * root(speed2), u, -r_ja);
      sum.speed2 += vw * speed2;
    }
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    into.eps += other.eps;
    into.counted += other.counted;
    into.rho += other.rho;
    if constexpr (Moments) into.turn += other.turn;
    into.flow.template merge<Moments>(other.flow);
    if constexpr (Local) {
      into.speed2 += other.speed2;
      into.fast.template merge<Moments>(other.fast);
    }
  }
  BL_HD void finish(Index j, const Sum<>& sum) const {
    const double S = sum.flow.weight;
    const Real inv_S = S > S_least ? Real(1 / S) : Real(0);
    surroundings.inv_S[j] = inv_S;
    surroundings.rho[j] = sum.rho * inv_S;
    surroundings.flow[j] = sum.flow;
    if constexpr (Local) {
      surroundings.fast[j] = sum.fast;
      surroundings.fast_slip[j] = sum.fast.weight > 0 ? sum.speed2 / Real(sum.fast.weight) : Real(0);
    }
    eps[j] = S > 0 ? clamp(sum.eps / Real(S), eps_min, Real(1)) : Real(1);
    const Real counted = max_of(sum.counted * inv_S, Real(1e-3));
    bed_eps[j] = max_of(1 - (1 - eps[j]) / counted, eps_min);
    if constexpr (Moments) {
      surroundings.stress.set(j, sum.flow, inv_S);
      const Real hidden = 1 - wall_free[j], missing = 1 - Real(S);
      const Real by_walls = hidden > 0 && missing > 0 ? min_of(hidden / missing, Real(1)) : Real(0);
      surroundings.lost_moment[j] =
          volume[j].w * sum.turn - by_walls * cross(surroundings.stress.arm[j], fluid_force[j]);
    }
  }
};

}  // namespace BL_SOLVER
