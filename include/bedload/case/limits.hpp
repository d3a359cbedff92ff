#pragma once
// Step limits of grains and of contacts, from what a case says.

#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

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
