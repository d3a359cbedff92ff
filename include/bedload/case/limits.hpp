#pragma once
// Step limits of grains at rest, known before anything moves.

#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

/// Rayleigh time and contact duration of the smallest grains, each times its share
/// (time.rayleigh, time.contact), s; impacts at sqrt(2 g R). The least binds.
/// Empty without grains or contacts.
std::vector<StepLimit> grain_limits(const Config& config);

}  // namespace bedload
