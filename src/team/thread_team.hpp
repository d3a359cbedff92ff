#pragma once
// Ranks as threads of one process.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bedload/parallel/link.hpp"
#include "bedload/parallel/rank_record.hpp"

namespace bedload {

class ThreadTeam {
 public:
  /// timeout: how long a rank waits for the others, s. names: of ranks, for messages.
  explicit ThreadTeam(int ranks, double timeout = 60, std::vector<std::string> names = {});
  ~ThreadTeam();

  int size() const { return int(links_.size()); }
  Link& link(int rank);
  /// All ranks that wait for others, or will, get RankLost instead.
  void fail() { failed_ = true; }
  bool failed() const { return failed_; }
  /// After a failure, when no rank waits any more.
  void recover();
  /// How often all ranks have met.
  std::uint64_t rounds() const { return round_; }
  /// That a rank has not responded within the time-out, and what it does.
  std::string silence_of(int rank) const;

 private:
  class RankLink;
  /// Where a rank is.
  struct Place {
    std::atomic<std::uint64_t> met{0};               ///< rounds to which it has come
    std::atomic<const RankRecord*> record{nullptr};  ///< of its thread
  };
  /// Returns when all ranks are here.
  void wait(int rank);

  std::vector<std::string> names_;
  double timeout_;
  std::atomic<bool> failed_{false};
  std::atomic<int> silent_{-1};  ///< rank for which others have waited too long
  std::atomic<int> here_{0};
  std::atomic<std::uint64_t> round_{0};
  std::vector<Place> places_;
  /// What ranks give the others, by turns: a rank that begins a round has read all of the one before the
  /// last.
  std::array<std::vector<std::vector<std::byte>>, 2> given_;
  std::vector<std::unique_ptr<RankLink>> links_;
};

}  // namespace bedload
