#pragma once
// Remarks of `bedload check`: properties of a case that may surprise, but are no reason for a warning.

#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

struct Remark {
  std::string about, text;
};

/// Numerical viscosity (from Simulation::numerical_viscosity), resolution, effects of defaults, whether the
/// viscometer takes the flow. free_surface: whether the fluid starts with one.
std::vector<Remark> remarks_on(const Config& config, const std::vector<Quantity>& numerical,
                               bool free_surface);

}  // namespace bedload
