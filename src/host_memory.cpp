#include "bedload/core/host_memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <vector>

namespace bedload {
namespace {

/// In front of each block.
struct alignas(64) Head {
  std::size_t bytes;  ///< with the head
  HostMemory::Free free;
};

void* aligned(std::size_t bytes) { return std::aligned_alloc(64, (bytes + 63) / 64 * 64); }

constexpr std::size_t kSmall = 64 << 10;  ///< bytes below which nothing is kept

struct Blocks {
  std::mutex mutex;
  HostMemory::Allocate allocate = aligned;
  HostMemory::Free free = std::free;
  std::size_t most = std::size_t(2) << 30;  ///< bytes that are kept
  std::size_t made = 0, kept = 0;           ///< bytes of all large blocks, and of those that wait
  std::size_t count = 0;                    ///< of large blocks ever made
  std::vector<Head*> waiting;               ///< with space for all
};
/// Never destroyed: blocks may be given back while the program ends.
Blocks& blocks() {
  static auto* const all = new Blocks;
  return *all;
}

Head* make(std::size_t bytes, HostMemory::Allocate allocate, HostMemory::Free free) {
  auto* const head = static_cast<Head*>(allocate(bytes));
  if (head) *head = {bytes, free};
  return head;
}

}  // namespace

void HostMemory::use(Allocate allocate, Free free, std::size_t most) {
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  all.allocate = allocate, all.free = free, all.most = most;
}

void* HostMemory::take(std::size_t bytes) {
  bytes += sizeof(Head);
  Head* head = nullptr;
  if (bytes >= kSmall) {
    Blocks& all = blocks();
    const std::lock_guard lock(all.mutex);
    // the smallest that is large enough and not much larger
    auto best = all.waiting.end();
    for (auto b = all.waiting.begin(); b != all.waiting.end(); ++b)
      if ((*b)->bytes >= bytes && (*b)->bytes / 4 * 3 <= bytes &&
          (best == all.waiting.end() || (*b)->bytes < (*best)->bytes))
        best = b;
    if (best != all.waiting.end()) {
      head = *best;
      all.waiting.erase(best);
      all.kept -= head->bytes;
      return head + 1;
    }
    const std::size_t larger = bytes + bytes / 8;  // numbers of particles vary
    while (all.made + larger > all.most && !all.waiting.empty()) {
      Head* const oldest = all.waiting.front();
      all.waiting.erase(all.waiting.begin());
      all.made -= oldest->bytes, all.kept -= oldest->bytes;
      oldest->free(oldest);
    }
    if (all.made + larger <= all.most && (head = make(larger, all.allocate, all.free))) {
      all.made += larger;
      all.waiting.reserve(++all.count);
      return head + 1;
    }
  }
  head = make(bytes, aligned, std::free);
  if (!head) throw std::bad_alloc();
  head->free = nullptr;  // not kept
  return head + 1;
}

void HostMemory::give_back(void* block) noexcept {
  Head* const head = static_cast<Head*>(block) - 1;
  if (!head->free) return std::free(head);
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  all.waiting.push_back(head);
  all.kept += head->bytes;
}

std::size_t HostMemory::most_kept() {
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  return all.most;
}

std::size_t HostMemory::kept() {
  Blocks& all = blocks();
  const std::lock_guard lock(all.mutex);
  return all.kept;
}

}  // namespace bedload
