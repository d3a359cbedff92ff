#pragma once
// The fluid: what it is, where it is at the start, how its equations are solved.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bedload/case/choices.hpp"
#include "bedload/case/config/shapes.hpp"

namespace bedload {

/// A block of fluid, placed on a lattice of spacing fluid.dx, or the particles of a file.
struct FluidFill {
  Vec3d min, max;                              ///< box, m; of a shape or a file: around what is filled (resolved)
  std::array<std::string, 3> velocity{"0", "0", "0"};  ///< formulas in x, y, z, m/s
  std::string shape = {};                      ///< name of a shape to fill instead of a box
  double level = std::numeric_limits<double>::infinity();  ///< shape: filled up to this height, m
  Solid solid = {};                            ///< resolved
  std::string file{};                          ///< particles instead of a lattice; absolute (resolved)
  std::int64_t step = -1;                      ///< frame of a .vtkhdf file; -1: the last
  std::string species{};                       ///< which of fluid.species it is of; empty: the first
  bool operator==(const FluidFill&) const = default;
};

/// One of several fluids that differ in viscosity alone.
struct FluidSpecies {
  std::string name;
  double mu = 0;                               ///< Pa s
  bool operator==(const FluidSpecies&) const = default;
};

/// What the fluid is made of and how finely it is resolved.
struct FluidProperties {
  double dx = 0;                               ///< spacing of particles or nodes, m
  double h_over_dx = 1.5;
  bool variable_h = false;                     ///< each particle's smoothing length follows its volume
  double sigma_h = 1.5;                        ///< variable_h: smoothing length / cube root of the volume
  Chosen<FluidModel> model = FluidModel::wcsph;
  Chosen<KernelFunction> kernel = KernelFunction::wendland_c2;
  double rho0 = 1000;                          ///< kg/m3
  double mu = 1e-3;                            ///< Pa s; the largest of several species (resolved)
  double zeta = std::numeric_limits<double>::infinity();  ///< bulk viscosity of SDPD, Pa s (default 20 mu / 21)
  double c = 0;                                ///< numerical sound speed, m/s (resolved)
  /// Smoothing length, m; with variable_h that of a particle of volume dx^3.
  double h() const { return (variable_h ? sigma_h : h_over_dx) * dx; }
  bool lattice() const { return model->nodes; }  ///< on nodes, not by particles
  double h_least() const { return variable_h ? 0.5 * h() : h(); }  ///< m
  double h_most() const { return variable_h ? 2 * h() : h(); }     ///< m
  double reach() const { return kappa() * h_most(); }              ///< farthest that particles act, m
  double kappa() const { return kernel == KernelFunction::lucy ? 1 : 2; }  ///< support / h
  bool operator==(const FluidProperties&) const = default;
};

/// And where it is at the start.
struct FluidConfig : FluidProperties {
  bool present = false;
  double vmax = 0;                             ///< m/s; 0: sqrt(2 g H)
  double c_factor = 10;                        ///< sound speed / vmax
  double depth = 0;                            ///< H: height of the initial fluid along gravity, m (resolved)
  std::vector<FluidFill> fills;
  std::vector<FluidSpecies> species;           ///< none: the fluid is one
  /// Place in `species`; the first for an unknown name.
  std::uint32_t species_of(const FluidFill& fill) const {
    for (std::size_t k = 0; k < species.size(); ++k)
      if (species[k].name == fill.species) return std::uint32_t(k);
    return 0;
  }
  bool operator==(const FluidConfig&) const = default;
};

struct EosConfig {
  Chosen<EosType> type = EosType::tait;
  double gamma = 7;
  double p0 = 100, alpha = 7, beta = 100;      ///< democritus: Pa, -, Pa
  double background = 0;                       ///< tait: pressure at rho0, Pa
  bool clip_negative = false;
  bool filter = false;                         ///< pressure averaged over neighbours
  bool operator==(const EosConfig&) const = default;
};

/// What acts on the pressure besides the equation of state.
struct PressureConfig {
  double damper = 0.5;                         ///< acoustic damper: bulk viscosity over rho0 c h
  bool linear_exact = true;                    ///< forces are exact for a linear pressure where viscosity rules
  bool operator==(const PressureConfig&) const = default;
};

struct DensityConfig {
  double delta = 0.1;                          ///< density diffusion
  double void_relaxation = 3;                  ///< rate at which pressure fades in fluid with voids, c/h
  double cavitation_limit = 0.001;             ///< the fluid cavitates below rho/rho0 - 1 = minus this
  Chosen<DensityMethod> method = DensityMethod::continuity;
  std::int64_t reinit_every = 0;               ///< steps; 0: never
  bool count_grains = false;                   ///< summation counts grains as fluid of their volume
  bool operator==(const DensityConfig&) const = default;
};

struct ViscosityConfig {
  Chosen<ViscosityModel> model = ViscosityModel::morris;
  double alpha = 0, beta = 0;                  ///< artificial viscosity
  bool collision = false;                      ///< fluid particles closer than collision_range collide
  double collision_range = 0.5;                ///< / fluid.dx
  double collision_restitution = 0.2;
  bool operator==(const ViscosityConfig&) const = default;
};

/// Smoothed dissipative particle dynamics: what it adds to the fluid.
struct SdpdConfig {
  double kT = 0;                               ///< energy of fluctuations, k_B T, J
  double kI = 0.1;                             ///< moment of inertia of a particle / m dx^2
  Chosen<NoiseForm> noise = NoiseForm::vector;
  std::vector<double> force_scale{1, 1, 1, 1}; ///< of pressure, friction, its part by spin, noise
  bool operator==(const SdpdConfig&) const = default;
};

}  // namespace bedload
