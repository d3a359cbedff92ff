#pragma once
// Inflow: the buffer layer next to an orifice becomes fluid.

#include "bedload/core/frame.hpp"
#include "bedload/particles/fluid.hpp"
#include "kernels/fluid/equation_of_state.hpp"
#include "kernels/fluid/views.hpp"

namespace BL_SOLVER {

/// Runs over the particles of a layer that this rank owns, with ids from `first` on: they become fluid at their position, with
/// their velocity and the pressure extrapolated from the fluid in front. There are no grains in an orifice.
struct InLayer {
  Id first;     ///< id of the first particle of the layer
  Index count;  ///< particles of the layer
  Span<const Id> wall_id;
  BL_HD bool operator()(Index w) const { return wall_id[w] - first < count; }
};
struct InsertPass {
  Frame frame;
  EquationOfState eos;
  Id first;       ///< id of the first particle of the layer
  Index place;    ///< index of the first new fluid particle
  Id id;          ///< its id
  Real mass;      ///< of each, kg
  Real3 acc;      ///< of the layer, m/s2
  Real3 gravity;  ///< effective, m/s2
  Span<const Index> layer;  ///< its wall particles, of this rank
  Span<const Id> wall_id;
  Span<const Vec3d> wall_x;
  Span<const VelocityDensity<>> wall_v_rho;
  Span<const WallState<>> wall_state;
  Span<Id> fluid_id;
  Span<FluidPosition> x;
  Span<VelocityDensity<>> v_rho, flux;  ///< flux, solid_factor: empty without grains
  Span<EosState<>> eos_state;
  Span<Real> compression, fluid_mass, eps, solid_factor;
  FluidAccelerations out;

  BL_HD void operator()(Index n) const {
    const Index w = layer[n], a = place + n;
    const bool touches_fluid = wall_state[w].mass > 0;
    const Real pressure = wall_state[w].p_over_rho2 * square(wall_v_rho[w].rho);
    const Real s = touches_fluid ? eos.compression(pressure) : Real(0);
    fluid_id[a] = id + (wall_id[w] - first);
    x[a] = as_position<FluidPosition>(frame, wall_x[w]);
    const Real rho = eos.rho0 * (1 + s), p = eos.pressure(s);
    v_rho[a] = {wall_v_rho[w].v, rho};
    if (flux) flux[a] = v_rho[a];
    eos_state[a] = {.mass_over_eps = mass, .p_over_rho2 = p / square(rho), .rho = rho, .eps = 1};
    compression[a] = s;
    fluid_mass[a] = mass;
    eps[a] = 1;
    if (solid_factor) solid_factor[a] = 0;
    out.set(a, acc - gravity, acc);  // by the stress what gives the prescribed acceleration
  }
};

}  // namespace BL_SOLVER
