#pragma once
// Inflow: the buffer layer next to an orifice becomes fluid.

#include "bedload/core/frame.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/walls.hpp"
#include "kernels/fluid/equation_of_state.hpp"

namespace bedload::inline BL_VARIANT {

/// Runs over the wall store: the `count` particles with ids from `first` become fluid at their position, with
/// their velocity and the pressure extrapolated from the fluid in front. There are no grains in an orifice.
struct InsertPass {
  Frame frame;
  EquationOfState eos;
  Id first;       ///< id of the first particle of the layer
  Index count;    ///< particles of the layer
  Index place;    ///< index of the first new fluid particle
  Id id;          ///< its id
  Real mass;      ///< of each, kg
  Real3 acc;      ///< of the layer, m/s2
  Real3 gravity;  ///< effective, m/s2
  Span<const Id> wall_id;
  Span<const Vec3d> wall_x;
  Span<const Real4> wall_v_rho, wall_m_state;
  Span<Id> fluid_id;
  Span<FluidPosition> x;
  Span<Real4> v_rho, flux, m_state;  ///< flux, solid_factor: empty without grains
  Span<Real> s, fluid_mass, eps, solid_factor;
  Span<Real3> theta, fluid_acc;

  BL_HD void operator()(Index w) const {
    const Id k = wall_id[w] - first;
    if (k >= count) return;
    const Index a = place + k;
    const bool touches_fluid = wall_m_state[w].x > 0;
    const Real pressure = wall_m_state[w].y * square(wall_v_rho[w].w);
    const Real compression = touches_fluid ? eos.compression(pressure) : Real(0);
    fluid_id[a] = id + k;
    x[a] = as_position<FluidPosition>(frame, wall_x[w]);
    const Real rho = eos.rho0 * (1 + compression), p = eos.pressure(compression);
    v_rho[a] = {wall_v_rho[w].xyz(), rho};
    if (flux) flux[a] = v_rho[a];
    m_state[a] = {mass, p / square(rho), rho, 1};
    s[a] = compression;
    fluid_mass[a] = mass;
    eps[a] = 1;
    if (solid_factor) solid_factor[a] = 0;
    theta[a] = acc - gravity;  // gives the prescribed acceleration
    fluid_acc[a] = acc;
  }
};

}  // namespace bedload::inline BL_VARIANT
