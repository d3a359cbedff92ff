#pragma once
// Grains settle before t = 0; the settled bed is cached for later runs.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

class Progress;

/// $XDG_CACHE_HOME/bedload/settled-<hash>.h5, or in ~/.cache/bedload. The hash covers everything that
/// settling depends on: grains, contacts, walls, initial positions, precision, backend and version. Empty
/// without a home directory.
std::filesystem::path settled_file(const Config& config, const Setup& setup, const Device& device);

/// The cached bed, if there is one that can be read.
std::optional<SavedState> cached_bed(const Config& config, const Setup& setup, const Device& device);
/// The grains at their given positions as a settled bed, for Simulation::load_grains.
SavedState bed_of(const Config& config, const Setup::Grains& grains, const Device& device);

struct SettledGrains {
  SavedState state;              ///< for Simulation::load_grains
  std::filesystem::path cached;  ///< file it was read from; empty: settled just now
};

/// The grains at rest without fluid, from settled_file() or from a dry simulation; the run that follows is
/// the same either way. A cache that cannot be read or written only adds to `warnings`.
SettledGrains settled_grains(const Config& config, const Setup& setup, const Device& device,
                             Progress& progress, std::vector<std::string>& warnings);

}  // namespace bedload
