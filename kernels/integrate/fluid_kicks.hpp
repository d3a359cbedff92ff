#pragma once
#include "kernels/boundaries/edges.hpp"
#include "kernels/fluid/equation_of_state.hpp"
#include "kernels/fluid/views.hpp"

namespace BL_SOLVER {

/// v += kick (acc + reaction); x += drift (v + beside), both put back at edges; pair loops read x from xp
/// and, in the middle of the step, `back` earlier, from xp_mid. Of sheared fluid also the peculiar velocity
/// at the earlier of the two.
struct KickDriftPass {
  FluidMotion fluid;  ///< sheared as it is after the drift
  PairCopies copies;
  Real kick, drift, back;                   ///< s
  Span<const Real3> acc, reaction, beside;  ///< reaction empty without grains
  Edges edges;

  BL_HD void operator()(Index a) const {
    const auto& [frame, shear, x, v_rho] = fluid;
    const auto& [xp, xp_mid, flux] = copies;
    const VelocityDensity<> old = v_rho[a];
    Real3 v = old.v + kick * acc[a];
    if (reaction) v += kick * reaction[a];
    v_rho[a] = {v, old.rho};
    if (drift == 0) return;
    const Real3 move = beside ? v + beside[a] : v;
    const Vec3d from = fluid.at(a);
    Vec3d at = from + Vec3d(move) * double(drift);
    if (edges.any()) {
      edges.put_back(from, at, v);
      v_rho[a] = {v, old.rho};
    }
    if (shear.acts()) {
      shear.wrap(at, v);
      at = frame.wrap(at);
      v_rho[a] = {v, old.rho};
    }
    x[a] = as_position<FluidPosition>(frame, at);
    const Vec3d now = fluid.at(a);
    const Real weight = xp[a].weight;
    xp[a] = pair_position(frame, shear.lattice(now), weight);
    if (!xp_mid && !flux) return;
    const Vec3d mid = edges.inside(now, Vec3d(back * v));
    const MeanShear then = shear.before(double(back));
    if (xp_mid) xp_mid[a] = pair_position(frame, then.lattice(mid), weight);
    if (flux) flux[a] = {then.peculiar(v, mid.z), old.rho};
  }
};

/// s a step on from rates of it at the ends of former steps, by Adams and Bashforth with steps that vary:
/// exact for rates that are a parabola in time, or a line or constant where there are fewer.
struct DensityHistory {
  Span<const Real> rate, before, long_before;  ///< 1/s, the last first; empty where there are none
  Real weight[3] = {0, 0, 0};                  ///< s

  DensityHistory() = default;
  /// Over a step dt, after steps of h1 and, before it, h2, s; 0: there was none.
  DensityHistory(Span<const Real> r0, Span<const Real> r1, Span<const Real> r2, double dt, double h1,
                 double h2)
      : rate(r0), weight{Real(dt), 0, 0} {
    if (h1 == 0) return;
    before = r1;
    if (h2 == 0) {
      weight[0] = Real(dt * (1 + 0.5 * dt / h1));
      weight[1] = Real(-0.5 * dt * dt / h1);
      return;
    }
    long_before = r2;
    const double both = h1 + h2;
    weight[0] = Real(dt * (1 + dt * (2 * dt + 6 * h1 + 3 * h2) / (6 * h1 * both)));
    weight[1] = Real(-dt * dt * (2 * dt + 3 * both) / (6 * h1 * h2));
    weight[2] = Real(dt * dt * (2 * dt + 3 * h1) / (6 * h2 * both));
  }
  BL_HD Real operator()(Index a) const {
    Real change = 0;
    if (rate) change += weight[0] * rate[a];
    if (before) change += weight[1] * before[a];
    if (long_before) change += weight[2] * long_before[a];
    return change;
  }
};

constexpr Real kThinnest = Real(-0.5);  // of s; thinner fluid is spray

/// Pressure from s, after `history` has advanced it, plus that of the acoustic damper [sun23],
///   damping ds/dt,    damping = a rho0 c h,
/// ds/dt being the rate by continuity alone: a bulk viscosity, which dissipates sound and not shear. Also
/// predicts, by `kick` (0: Euler), velocity and volume flux or, of sheared fluid, peculiar velocity.
struct StatePass {
  FluidMotion fluid;
  EquationOfState eos;
  Real damping;                       ///< a rho0 c h [Pa s]
  Span<const Real> compression_rate;  ///< ds/dt [1/s]; empty without damper
  DensityHistory history;
  Real kick;  ///< s
  Span<const Real3> acc, reaction;
  Span<Real> compression;
  Span<const Real> mass, eps;    ///< eps empty unless fluid gives way to grains
  Span<VelocityDensity<>> flux;  ///< empty without grains and shear
  Span<EosState<>> eos_state;
  Span<Real> p_rho2;

  BL_HD void operator()(Index a) const {
    Real3 gain = kick * acc[a];
    if (reaction) gain += kick * reaction[a];
    const Real strain = max_of(compression[a] + history(a), kThinnest), rho = eos.density(strain);
    compression[a] = strain;
    const Real3 v = fluid.v_rho[a].v + gain;
    const Real porosity = eps ? eps[a] : Real(1);
    fluid.v_rho[a] = {v, rho};
    if (fluid.shear.acts())
      flux[a] = {fluid.shear.peculiar(v, fluid.at(a).z), rho};
    else if (flux)
      flux[a] = {flux[a].v + porosity * gain, rho};
    Real pressure = eos.pressure(strain);
    if (compression_rate) pressure += damping * compression_rate[a];
    const Real p = pressure / square(rho);
    eos_state[a] = {.mass_over_eps = mass[a] / porosity, .p_over_rho2 = p, .rho = rho, .eps = porosity};
    p_rho2[a] = p;
  }
};

/// Both, where no pass over pairs stands between them.
struct AdvancePass {
  KickDriftPass move;
  StatePass state;
  BL_HD void operator()(Index a) const {
    move(a);
    state(a);
  }
};

}  // namespace BL_SOLVER
