#pragma once
// Evaluates the layers of a plane shear flow: viscosity, quality of the fit, stress by part.

#include <string>
#include <vector>

#include "bedload/host_data.hpp"
#include "src/viscometer/layers.hpp"

namespace bedload {

/// A mean and its standard error, from block averages.
struct Measured {
  double mean = 0, error = 0;
};

/// A part of the stress, averaged over the flow except within the kernel radius of walls. Pa, tension
/// positive; [3 i + j]: force along i on a plane normal to j.
struct StressPart {
  std::string name;  ///< pressure, friction, noise, kinetic, contact, ...; total
  Tensor mean{};
};

/// A layer with enough fluid, merged with emptier adjacent ones.
struct ProfileRow {
  double z = 0, velocity = 0, fit = 0;   ///< mean position of its particles, m; m/s
  double grain_velocity = 0;             ///< m/s; NaN without grains in the layer
  double shear_stress = 0, imposed = 0;  ///< Pa
  double filled = 0;                     ///< volume fraction of the layer that its fluid fills
};

struct ViscosityResult {
  Measured viscosity;    ///< Pa s
  double r_squared = 0;  ///< of the whole profile, halves superimposed
  double imposed = 0;    ///< force density, N/m3; Couette: shear stress on the walls, Pa; Lees-Edwards:
                         ///< shear stress, Pa
  double peak = 0;       ///< fastest layer, m/s; Couette and Lees-Edwards: relative speed of the ends
  double reynolds = 0, mach = 0;  ///< of mean speed and gap; of peak speed, for Lees-Edwards of the shear
                                  ///< over a kernel radius
  double drift = 0,
         drift_limit = 0;       ///< relative change of the viscosity from the first to the second half
  double slip_length = 0;       ///< walls: mean distance behind them at which the fit has their velocity, m
  double offset = 0;            ///< walls: of the centre of the fit from that of the channel, m
  Measured stress_ratio;        ///< shear stress in the fluid over the imposed one
  Measured normal_1, normal_2;  ///< normal-stress differences: along - gradient, gradient - vorticity, Pa
  double pressure = 0;          ///< Pa
  double concentration = 0;     ///< volume fraction of grains
  std::vector<StressPart> stress;
  std::vector<ProfileRow> profile;
  int blocks = 0, samples = 0;

  static constexpr double kLeastR2 = 0.95;
  static constexpr double kLeastFilled = 0.5;  ///< emptier layers are merged
  bool accepted() const { return r_squared >= kLeastR2; }
  bool stationary() const { return drift <= drift_limit && drift >= -drift_limit; }
};

/// reach: kernel radius, m. Uses fluid.mu, rho0, the sound speed and the grain density of the case.
ViscosityResult evaluate(const Layers& layers, const Config& config, double reach);

/// What resolved spheres have at a concentration, over the viscosity of the fluid.
std::string resolved_viscosities(double concentration);
/// A caveat about the relative viscosity at a grain concentration; by_law: the case has a suspension
/// viscosity.
std::string relative_caveat(double concentration, bool by_law);

/// For summary.json; without the viscosity if the fit was rejected.
std::vector<Quantity> quantities_of(const ViscosityResult& result, const PlaneFlow& flow);

}  // namespace bedload
