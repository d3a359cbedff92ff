#pragma once
// What the layers of a plane shear flow tell: viscosity, how good it is, stress by parts.

#include <string>
#include <vector>

#include "bedload/host_data.hpp"
#include "src/viscometer/layers.hpp"

namespace bedload {

/// A mean and the standard error of it, from blocks.
struct Measured {
  double mean = 0, error = 0;
};

/// A part of the stress, averaged over the flow: all of it where there are no walls, else the layers beyond
/// the kernel's reach of them. Pa, tension above 0; [3 i + j]: force along i through a plane across j.
struct StressPart {
  std::string name;  ///< pressure, friction, noise, kinetic, contact, ...; total
  Tensor mean{};
};

/// A layer with enough fluid, and what of emptier ones beside it counts there.
struct ProfileRow {
  double z = 0, velocity = 0, fit = 0;   ///< m, m/s; where the particles of the layer lie
  double grain_velocity = 0;             ///< m/s; NaN without grains in the layer
  double shear_stress = 0, imposed = 0;  ///< Pa
  double filled = 0;                     ///< volume that its fluid stands for, over that of a layer
};

struct ViscosityResult {
  Measured viscosity;    ///< Pa s
  double r_squared = 0;  ///< of the whole profile, of halves laid on each other
  double imposed = 0;    ///< force density, N/m3; Couette: shear stress on the walls, Pa; Lees-Edwards:
                         ///< shear stress, Pa
  double peak = 0;       ///< fastest layer, m/s; Couette and Lees-Edwards: of the ends against each other
  double reynolds = 0, mach = 0;  ///< by mean speed and gap; by peak and sound, Lees-Edwards: by what the
                                  ///< shear comes to over the kernel's reach
  double drift = 0,
         drift_limit = 0;  ///< of the viscosity from the first half of the blocks to the second, relative
  double slip_length = 0;  ///< walls: mean distance behind them at which the fit moves along with them, m
  double offset = 0;       ///< walls: of the middle of the fit from that of the channel, m
  Measured stress_ratio;   ///< shear stress within the fluid over that imposed
  Measured normal_1, normal_2;  ///< normal-stress differences: along - gradient, gradient - vorticity, Pa
  double pressure = 0;          ///< Pa
  double concentration = 0;     ///< volume of grains over that of all
  std::vector<StressPart> stress;
  std::vector<ProfileRow> profile;
  int blocks = 0, samples = 0;

  static constexpr double kLeastR2 = 0.95;
  static constexpr double kLeastFilled = 0.5;  ///< below it a layer has no row of its own
  bool accepted() const { return r_squared >= kLeastR2; }
  bool stationary() const { return drift <= drift_limit && drift >= -drift_limit; }
};

/// reach: of the kernel, m. The case gives fluid.mu, rho0, the speed of sound and the density of grains.
ViscosityResult evaluate(const Layers& layers, const Config& config, double reach);

/// What is to be known of a viscosity over that without grains: at `concentration`, of which a law of the
/// case makes the fluid more viscous or not. A sentence.
std::string relative_caveat(double concentration, bool by_law);

/// For summary.json; without a viscosity where the profile is none of a viscous flow.
std::vector<Quantity> quantities_of(const ViscosityResult& result, const PlaneFlow& flow);

}  // namespace bedload
