#pragma once
// What a case starts with, to be looked at before it runs.

#include <filesystem>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

/// Writes fluid.vtkhdf, grains.vtkhdf and walls.vtkhdf with the particles of `setup` as initialised (grains
/// unsettled; walls sampled on their surfaces where the case has no fluid to meet them), and preview.png:
/// views from the front, from above and in perspective. Makes the folder. Throws FileError, also if a run
/// lies there.
void write_preview(const std::filesystem::path& folder, const Config& config, const Setup& setup);

}  // namespace bedload
