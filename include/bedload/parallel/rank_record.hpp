#pragma once
// What one of several ranks does and has done so far; a rank is a thread.

#include <atomic>
#include <cstdint>

namespace bedload {

struct RankRecord {
  std::int64_t exchanges = 0;  ///< of values of ghosts and of particles that go to other ranks
  std::int64_t migrated = 0;   ///< particles that others own since
  double sent = 0;             ///< bytes to others
  double waited = 0;           ///< for others, s

  std::atomic<const char*> stage{nullptr};  ///< of a step, which runs now; text that lasts
  std::atomic<std::int64_t> steps{0};       ///< done when it began

  void enter(const char* now, std::int64_t done) { stage = now, steps = done; }
};

/// That of the thread that asks; one for all builds of the solver in a program (src/team/rank_record.cpp).
RankRecord& rank_record();

}  // namespace bedload
