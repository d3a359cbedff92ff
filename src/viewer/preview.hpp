#pragma once
// The initial state of a case, written before it runs.

#include <filesystem>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

/// Writes fluid.vtkhdf, grains.vtkhdf and walls.vtkhdf with the initial particles of `setup` (grains
/// unsettled; walls sampled on their surfaces in a case without fluid) and preview.png: views from the front,
/// from above and in perspective. Creates the folder. Throws FileError, also if the folder holds a run.
void write_preview(const std::filesystem::path& folder, const Config& config, const Setup& setup);

}  // namespace bedload
