#pragma once
#include "bedload/case/config.hpp"
#include "src/solids/parameters.hpp"

namespace BL_SOLVER {

/// The laws of contact between grains of a case, of the first material.
inline ContactLaw contact_law_of(const Config& config) { return solid_parameters(config).pair_laws[0]; }

}  // namespace BL_SOLVER
