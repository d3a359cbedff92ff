#pragma once
// Division of a box of blocks among ranks.

#include <array>
#include <cstdint>
#include <vector>

namespace bedload {

/// The rank of each block, so that all ranks have about the same load and few blocks at their borders: by
/// recursive bisection across the axis that gives the best halves. A cut goes through a layer of blocks where
/// it must; at each, the halves are equal to within a block. Blocks without load are divided as well.
/// places: of the blocks along each axis, in any order; load: of each, not negative.
std::vector<std::uint16_t> bisect(const std::vector<std::array<int, 3>>& places, const std::vector<double>& load,
                                  int ranks);

}  // namespace bedload
