#pragma once
// Steps and their limits.

#include "bedload/case/choices.hpp"

namespace bedload {

struct TimeConfig {
  double end = 0;                              ///< s
  double dt = 0;                               ///< s; 0: adaptive
  double dt_dem = 0;                           ///< s; 0: adaptive
  double cfl = 0.25, visc = 0.125, body = 0.25, drag = 0.5, rayleigh = 0.2, contact = 0.04;
  double friction = 0.025;                     ///< of SDPD
  Chosen<TimeIntegrator> integrator = TimeIntegrator::kdk;
  bool force_dt = false;
  bool operator==(const TimeConfig&) const = default;
};

}  // namespace bedload
