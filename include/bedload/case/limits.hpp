#pragma once
// Step limits of grains and of contacts, from what a case says.

#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

/// An elastic impact by Hertz's law.
struct HertzImpact {
  double duration;   ///< s
  double stiffness;  ///< where it is deepest, dF/d(overlap), N/m
};
/// Of reduced mass m (kg), radius R (m) and modulus E (Pa), at v (m/s).
HertzImpact hertz_impact(double m, double R, double E, double v);

/// Longest stable step of a rolling spring [ai11] in a contact of the given stiffness (N/m), s; inertia:
/// reduced, about the contact, kg m2. Infinite without rolling friction.
double rolling_limit(double stiffness, double mu_r, double R_star, double inertia);

/// Rayleigh time, contact duration and rolling of the smallest grains, each times its fraction
/// (time.rayleigh, time.contact), s; impacts at `speed` (m/s), or at what gravity gives over a diameter if
/// that is more.
std::vector<StepLimit> substep_limits(const Config& config, double speed);

/// The same of grains at rest, known before anything moves; the least binds. Empty without grains or
/// contacts.
std::vector<StepLimit> grain_limits(const Config& config);

}  // namespace bedload
