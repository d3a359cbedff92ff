#pragma once
// Grains settle before t = 0; the result is kept for the next run of the same bed.

#include <filesystem>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

class Progress;

/// $XDG_CACHE_HOME/bedload/settled-<hash>.h5, or below ~/.cache. The hash covers all
/// that settling depends on: grains, contacts, walls, initial places, precision,
/// backend and version. Empty if there is no home.
std::filesystem::path settled_file(const Config& config, const Setup& setup, const Device& device);

/// Settles the grains, or takes them from settled_file() and then returns true. A cache that cannot
/// be read or written is remarked in `warnings` and otherwise ignored.
bool settle_grains(Simulation& simulation, const Config& config, const Setup& setup, const Device& device,
                   Progress& progress, std::vector<std::string>& warnings);

}  // namespace bedload
