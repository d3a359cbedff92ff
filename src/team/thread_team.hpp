#pragma once
// Ranks as threads of one process.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bedload/parallel/link.hpp"

namespace bedload {

class ThreadTeam {
 public:
  /// timeout: how long a rank waits for the others, s.
  explicit ThreadTeam(int ranks, double timeout = 60);
  ~ThreadTeam();

  int size() const { return int(links_.size()); }
  Link& link(int rank);
  /// All ranks that wait for others, or will, get RankLost instead.
  void fail() { failed_ = true; }
  /// After a failure, when no rank waits any more.
  void recover();

 private:
  class RankLink;
  /// Returns when all ranks are here.
  void wait(int rank);
  std::string too_long(int rank) const;

  double timeout_;
  std::atomic<bool> failed_{false};
  std::atomic<int> impatient_{-1};  ///< rank that has waited too long
  std::atomic<int> here_{0};
  std::atomic<std::uint64_t> round_{0};
  /// What ranks give the others, by turns: a rank that begins a round has read all of the one before the last.
  std::array<std::vector<std::vector<std::byte>>, 2> given_;
  std::vector<std::unique_ptr<RankLink>> links_;
};

}  // namespace bedload
