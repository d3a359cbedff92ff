#pragma once
// On how many GPUs a case has room, and keeps them busy.

#include <string>
#include <vector>

#include "prepare.hpp"

namespace bedload {

/// The least number of GPUs, above that of `memory`, on which these particles have room, of GPUs with so many
/// bytes free; 0: there are too few.
int devices_with_room(MemoryEstimate memory, const Counts& n, const std::vector<std::size_t>& free);
/// "; --devices 2 has room", if so many of this machine's GPUs have.
std::string room_text(const Prepared& prepared, const Counts& n);
/// What a case needs and has free, "about 210 GB; NVIDIA H200 has 139 GB free", with room_text().
std::string lack_of_memory_text(const Prepared& prepared);
/// A warning of ranks that have nothing to do; empty if all have.
std::string idle_ranks_text(const std::vector<RankReport>& ranks, const Config& config);

}  // namespace bedload
