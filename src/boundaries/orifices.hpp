#pragma once
#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/openings.hpp"
#include "kernels/boundaries/orifice.hpp"

namespace BL_SOLVER {

/// Orifices of all fluid inlets. walls: number of bodies listed before them; dx: spacing of the fluid, m.
std::vector<Orifice> orifices_of(const std::vector<InletConfig>& inlets, std::size_t walls, double dx,
                                 const DomainConfig& domain);

}  // namespace BL_SOLVER
