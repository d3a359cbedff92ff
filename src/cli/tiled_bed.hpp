#pragma once
// Large beds from copies of a small settled one.

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

/// Copies of a tile of grains as it has settled, side by side along x and y, `times` each way, in place of
/// the grains of as many of the last fills of `whole` as the tile has. Grains (or clumps) are left out where
/// they would be inside a wall or a grain of the other fills.
Setup::Grains tiled_bed(const Config& tile, const Setup::Grains& placed, const SavedState& settled,
                        const Config& whole, const Setup::Grains& others, int times);

}  // namespace bedload
