#pragma once
#include <vector>

#include "bedload/case/config.hpp"
#include "kernels/boundaries/orifice.hpp"

namespace bedload::inline BL_VARIANT {

/// Those of all inlets of fluid, in the order of the case.
std::vector<Orifice> orifices_of(const Config& config);

}  // namespace bedload::inline BL_VARIANT
