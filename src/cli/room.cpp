#include "room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "bedload/core/error.hpp"
#include "src/team/divisible.hpp"

namespace bedload {

int devices_with_room(MemoryEstimate memory, const Counts& n, const std::vector<std::size_t>& free) {
  const int tried = memory.ranks;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (memory.ranks = 1; memory.ranks <= int(free.size()); ++memory.ranks) {
    least = std::min(least, free[std::size_t(memory.ranks - 1)]);
    if (memory.ranks > tried && memory.of(n) <= least) return memory.ranks;
  }
  return 0;
}

std::string room_text(const Prepared& p, const Counts& n) {
  if (!p.device.cuda()) return "";
  try {
    refuse_undivided(p.config);
  } catch (const KeyError&) {
    return "";
  }
  const int enough = devices_with_room(p.memory, n, free_of_gpus());
  return enough > 0 ? fmt::format("; --devices {} has room", enough) : "";
}

std::string lack_of_memory_text(const Prepared& p) {
  const char* const each = p.device.ranks > 1 ? " on each device" : "";
  return fmt::format("about {}{}; {} has {} free{}{}", bytes_text(p.memory.of(p.counts)), each,
                     p.device.text(), bytes_text(p.device.memory), each, room_text(p, p.counts));
}

std::string idle_ranks_text(const std::vector<RankReport>& ranks, const Config& config) {
  const auto idle = std::ranges::count_if(
      ranks, [](const RankReport& r) { return r.own.fluid + r.own.walls + r.own.grains == 0; });
  if (idle == 0) return "";
  return fmt::format("{} of {} ranks have no particles: there are fewer blocks than ranks; use fewer ranks{}",
                     idle, ranks.size(),
                     config.block > 1 ? fmt::format(" or less than run.block = {}", config.block) : "");
}

}  // namespace bedload
