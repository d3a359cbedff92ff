#pragma once
#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/openings.hpp"
#include "kernels/boundaries/orifice.hpp"

namespace bedload::inline BL_VARIANT {

/// Those of all inlets of fluid. walls: how many bodies stand before them; dx: spacing of the fluid, m.
std::vector<Orifice> orifices_of(const std::vector<InletConfig>& inlets, std::size_t walls, double dx,
                                 const DomainConfig& domain);

}  // namespace bedload::inline BL_VARIANT
