#pragma once
// Grains settle before t = 0; the result is kept for the next run of the same bed.

#include <filesystem>
#include <optional>
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

/// The bed that is kept there, if it can be read.
std::optional<SavedState> kept_bed(const Config& config, const Setup& setup, const Device& device);
/// A bed of grains that lie where they are, for Simulation::load_grains.
SavedState bed_of(const Config& config, const Setup::Grains& grains, const Device& device);

struct SettledGrains {
  SavedState state;            ///< for Simulation::load_grains
  std::filesystem::path kept;  ///< where it was taken from; empty: settled just now
};

/// The grains at rest without fluid, from settled_file() or settled in a simulation of
/// their own, so that the run that follows is the same either way. A cache that cannot
/// be read or written is remarked in `warnings` and otherwise ignored.
SettledGrains settled_grains(const Config& config, const Setup& setup, const Device& device,
                             Progress& progress, std::vector<std::string>& warnings);

}  // namespace bedload
