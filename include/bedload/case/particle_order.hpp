#pragma once
// When fluid particles are kept in order, and when pressure acts on them as if they were.

#include <string>

namespace bedload {

struct Config;
struct FluidProperties;

// Cell Reynolds numbers, of a flow by its speed or of a pressure by (P / rho)^(1/2).
constexpr double kViscousFlow = 1000;   ///< below it viscosity may rule the scale of a particle
constexpr double kExactPressure = 100;  ///< up to it forces of a linear pressure are exact, within the fluid
constexpr double kExactPressureAtSurface = 3.1622776601683795;  ///< and within a kernel's reach of a surface
constexpr double kExactPressureEnds = 3.1622776601683795;       ///< times either: from there on not at all

/// speed dx / nu; infinite without viscosity. speed: m/s.
double cell_reynolds_number(double speed, const FluidProperties& fluid);

/// Which of that a case has, and why not the rest: one clause each, empty where it has.
struct ParticleOrder {
  bool shifts = false;        ///< particles drift towards order (Shifting)
  bool linear_exact = false;  ///< forces of a linear pressure are made exact (LinearFit)
  std::string no_shifting, not_exact;
};
ParticleOrder particle_order(const Config& config);

}  // namespace bedload
