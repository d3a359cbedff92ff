#pragma once
// Energy budget of the fluid by terms.

#include "kernels/fluid/density_pass.hpp"
#include "kernels/fluid/fluid_powers.hpp"
#include "kernels/fluid/force_pass.hpp"

namespace BL_SOLVER {

/// FluidPowers of each particle, by the passes that move the fluid: power of the viscous forces; rate of
/// elastic energy by diffusion and voids; power of the rest of the stress, which is pressure, less the rate
/// of elastic energy by continuity. Among fluid particles the last is zero; at walls it is the work of moving
/// walls and of the walls' own pressure.
template <class Force, class Density>
struct PowerPass {
  Force friction, artificial;  ///< with physical viscosity alone; with artificial alone
  Density density;             ///< without fit
  EquationOfState eos;
  Span<const Real3> stress_acceleration;
  Span<FluidPowers> out;

  template <class N = Real>
  struct Sum {
    typename Force::template Sum<N> friction, artificial;  ///< without pressure
    typename Density::template Sum<N> density;
  };
  BL_HD Sum<> start(Index a) const {
    Sum<> sum{friction.start(a), artificial.start(a), density.start(a)};
    sum.friction.m.p_over_rho2 = sum.artificial.m.p_over_rho2 = 0;
    return sum;
  }
  BL_HD auto sources() const {
    return friction.lengths.sources(friction.fluid.flux, friction.species(), density.fluid.state,
                                    density.shift.sources());
  }
  template <class N, class Relative, class Exposure, class... H>
  BL_HD void pair(Sum<N>& sum, const Vec3<N>& r, N r2, N M, const VelocityDensity<N>& vb,
                  const Relative& viscosity_b, const EosState<N>& state, const Exposure& exposure,
                  const H&... h_b) const {
    friction.pair(sum.friction, r, r2, M, vb, N(0), viscosity_b, h_b...);
    artificial.pair(sum.artificial, r, r2, M, vb, N(0), viscosity_b, h_b...);
    density.pair(sum.density, r, r2, M, vb, state, exposure, h_b...);
  }
  BL_HD auto wall_sources() const {
    return sources_of(friction.walls.v_rho, friction.walls.state, friction.walls.no_slip,
                      read_where(bool(density.wall_work), density.wall_work));
  }
  template <class N>
  BL_HD void wall_pair(Sum<N>& sum, const Vec3<N>& r, N r2, const VelocityDensity<N>& vb,
                       const WallState<N>& mb, const NoSlip<N>& no_slip, N work) const {
    WallState<N> without_pressure = mb;
    without_pressure.p_over_rho2 = N(0);
    friction.wall_pair(sum.friction, r, r2, vb, without_pressure, no_slip);
    density.wall_pair(sum.density, r, r2, vb, mb, work);
  }
  BL_HD void merge(Sum<>& into, const Sum<>& other) const {
    friction.merge(into.friction, other.friction);
    artificial.merge(into.artificial, other.artificial);
    density.merge(into.density, other.density);
  }
  BL_HD void finish(Index a, const Sum<>& sum) const {
    const Real3 q = density.fluid.flux[a].v;
    const EosState<> m = density.fluid.state[a];
    const Real3 rubbed = sum.friction.stress, damped = sum.artificial.stress;
    Real3 pressed = stress_acceleration[a] - rubbed - damped;
    if (friction.correction) pressed -= friction.correction[a].xyz();
    const auto change = density.of(a, sum.density);
    const Real rate = density.lengths.corrected(a, sum.density.rate), share = 1 / (m.eps * density.rho0);
    const Real diffusion = density.diffusion * sum.density.diffused * share,
               settled = density.dt > 0 ? change.settled / density.dt : 0;
    // of the elastic energy with s, J
    const Real stiffness =
        m.mass_over_eps * m.eps * eos.pressure(density.compression[a]) * density.rho0 / square(m.rho);
    FluidPowers p;
    p.viscosity = m.mass_over_eps * dot(q, rubbed);
    p.artificial_viscosity = m.mass_over_eps * dot(q, damped);
    p.density_diffusion = stiffness * diffusion;
    p.voids = stiffness * (change.rate + rate * share - diffusion + settled);
    p.pressure =
        m.mass_over_eps * (dot(q, pressed) - density.lengths.corrected(a, m.p_over_rho2) * sum.density.rate);
    const Real s = density.compression[a];
    p.fades = density.fading > 0 && s > 0 && change.void_fraction > Density::slack;
    p.spreads = density.spreading > 0 && change.excess > 0;
    if constexpr (Density::kShifts) {
      const Real exposed = 1 - density.shift.moment(sum.density.shift).least_eigenvalue();
      const auto drift = density.shift.drift(sum.density.shift, exposed, sum.density.gradient);
      p.shift = drift.velocity;
      p.shift_limited = density.dt > 0 && drift.limited;
    }
    out[a] = p;
  }
};

}  // namespace BL_SOLVER
