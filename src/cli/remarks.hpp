#pragma once
// What a case comes to that its user may not expect: notes, no warnings.

#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

/// Numerical viscosity (as Simulation::numerical_viscosity tells it), resolution, what defaults do, whether
/// it is a flow for the viscometer; a line each. free_surface: whether fluid begins with one.
std::string remarks_text(const Config& config, const std::vector<Quantity>& numerical, bool free_surface);

}  // namespace bedload
