#pragma once
// Grains placed without overlap.

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

/// Adds every grain.fill: at the positions given, or at random inside the box, clear of
/// its sides, of walls and of all grains before them; a shaken cubic lattice where the
/// box is too full for random places. Depends on grain.seed alone. Throws CaseError if
/// the grains do not fit.
void add_grains(const Config& config, Setup::Grains& grains);

}  // namespace bedload
