#pragma once
#include "bedload/particles/store.hpp"

namespace BL_SOLVER {

/// Packed positions are no array that a reader could use.
constexpr bool kPackedFluid = std::is_same_v<FluidPosition, PackedPosition>;

/// Fluid particles. Densities are intrinsic: mass per volume of fluid, whatever grains share the space. Pair
/// loops see the mixture: particle a represents the volume m_a / (eps_a rho_a) of fluid and grains.
struct FluidStore : Store {
  FluidStore() : Store("fluid") {}

  Field<Id> id{*this, "id", "-", Lifetime::kept, Output{.order = 99}};
  Field<FluidPosition> x{*this, "x", "m", Lifetime::kept, Output{.order = 0, .uses = kPackedFluid ? kNobody : kViews, .name = "position"}};
  Field<FluidPosition> x_list{*this, "x_list", "m", Lifetime::renewed};  ///< where the neighbour lists were built
  Field<Real> half_skin{*this, "half_skin", "m", Lifetime::renewed};     ///< how far it may go from there until they are built anew
  Field<VelocityDensity<>> v_rho{*this, "v_rho", "m/s, kg/m3", Lifetime::kept, Output{.order = 1, .uses = kFrames | kViews | kRheology, .name = "velocity", .unit = "m/s", .components = 3}};  ///< velocity, density
  Field<VelocityDensity<>> flux{*this, "flux", "m/s, kg/m3", Lifetime::kept};     ///< volume flux of fluid and grains, eps v + sum w u, or, of sheared fluid, peculiar velocity; density
  Field<Real> compression{*this, "compression", "-", Lifetime::kept};  ///< s = density / rho0 - 1; lower than in eos_state where fluid cavitates
  Field<Real> mass{*this, "mass", "kg", Lifetime::kept, Output{.order = 2, .uses = kViews | kRheology}};
  Field<Real> eps{*this, "porosity", "-", Lifetime::kept, Output{.order = 5, .coupled = true}};
  Field<Real> solid_factor{*this, "solid_factor", "-", Lifetime::kept};  ///< of the grains around it as it counts them: below 1 next to orifices and at the least porosity
  Field<std::uint32_t> species{*this, "species", "-", Lifetime::kept, Output{.order = 13}};  ///< place in fluid.species; left out where there are none, as the next
  Field<Real> viscosity{*this, "relative_viscosity", "-", Lifetime::kept};  ///< over that of fluid.mu
  Field<Real3> stress_acceleration{*this, "stress_acceleration", "m/s2", Lifetime::kept};  ///< by the stress of the mixture: pressure, viscosity
  Field<Real3> acc{*this, "acceleration", "m/s2", Lifetime::kept};  ///< stress_acceleration + gravity + drive + repulsion
  Field<Real3> drift{*this, "drift", "m/s", Lifetime::kept};    ///< with which particles move in addition to their velocity: shifting, XSPH
  Field<Real> exposure{*this, "exposure", "-", Lifetime::kept};  ///< to free surfaces (Shifting): 0 within the fluid
  Field<Real> compression_rate{*this, "compression_rate", "1/s", Lifetime::kept};  ///< of compression by continuity alone; left out without acoustic damper
  Field<EosState<>> eos_state{*this, "eos_state", "kg, m5/(kg s2), kg/m3, -", Lifetime::kept, Output{.order = 4, .name = "density", .unit = "kg/m3", .components = 1, .first = 2}};
  Field<Real> drag_rate{*this, "drag_rate", "1/s", Lifetime::derived};  ///< of the drag of the grains; left out where it does not act on fluid
  Field<Real3> drag_kick{*this, "drag_kick", "m/s", Lifetime::derived};  ///< by the drag of the grains, this step
  Field<Real3> acc_next{*this, "acc_next", "m/s2", Lifetime::derived};
  Field<Real3> heading{*this, "heading", "m/s", Lifetime::derived};  ///< velocity in the middle of the next step but for the push of wall surfaces
  Field<Real> p_rho2{*this, "p_rho2", "m5/(kg s2)", Lifetime::derived};  ///< P / rho^2
  Field<Real> grains_around{*this, "grains_around", "-", Lifetime::derived};  ///< sum of V_j W(r_aj; h) over grains; left out where density does not count them
  Field<Real> exposure_next{*this, "exposure_next", "-", Lifetime::derived};
  Field<Real4> correction{*this, "pressure_correction", "m/s2, -", Lifetime::kept};  ///< of LinearFit; its weight
  Field<Real> compression_next{*this, "compression_next", "-", Lifetime::derived};
  Field<PairPosition> xp{*this, "xp", "m", Lifetime::derived};  ///< x as pair loops read it
  Field<PairPosition> xp_mid{*this, "xp_mid", "m", Lifetime::derived};  ///< where it is in the middle of the step, likewise; left out where no loop runs there
  Field<Real3> reaction{*this, "reaction", "m/s2", Lifetime::derived};  ///< couples that keep the angular momentum of the stress shared with grains
};

}  // namespace BL_SOLVER
