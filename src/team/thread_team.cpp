#include "src/team/thread_team.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <thread>
#include <utility>

namespace bedload {

class ThreadTeam::RankLink final : public Link {
 public:
  RankLink(ThreadTeam& team, int rank) : team_(team), rank_(rank) {}

  int rank() const override { return rank_; }
  int size() const override { return team_.size(); }
  void all_gather(const void* own, void* all, std::size_t bytes) override {
    auto& given = team_.given_[turn_];
    turn_ = 1 - turn_;
    given[std::size_t(rank_)].resize(bytes);
    if (bytes > 0) std::memcpy(given[std::size_t(rank_)].data(), own, bytes);
    const auto from = std::chrono::steady_clock::now();
    team_.wait(rank_);
    rank_record().waited += std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
    for (std::size_t r = 0; r < given.size() && bytes > 0; ++r)
      std::memcpy(static_cast<std::byte*>(all) + r * bytes, given[r].data(), bytes);
  }
  void restart() { turn_ = 0; }

 private:
  ThreadTeam& team_;
  int rank_;
  int turn_ = 0;
};

ThreadTeam::ThreadTeam(int ranks, double timeout, std::vector<std::string> names)
    : names_(std::move(names)), timeout_(timeout), places_(std::size_t(ranks)) {
  for (auto& given : given_) given.resize(std::size_t(ranks));
  for (int r = 0; r < ranks; ++r) links_.push_back(std::make_unique<RankLink>(*this, r));
}
ThreadTeam::~ThreadTeam() = default;

Link& ThreadTeam::link(int rank) { return *links_[std::size_t(rank)]; }

std::string ThreadTeam::silence_of(int rank) const {
  const RankRecord* const record = places_[std::size_t(rank)].record;
  const char* const stage = record ? record->stage.load() : nullptr;
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.3g", timeout_);
  const std::string name = names_.empty() ? "rank " + std::to_string(rank) : names_[std::size_t(rank)];
  return name + " has not responded for " + seconds + " s" +
         (stage ? ", in " + std::string(stage) + " of step " + std::to_string(record->steps + 1) : "");
}

void ThreadTeam::recover() {
  failed_ = false;
  silent_ = -1;
  here_ = 0;
  for (Place& place : places_) place.met = round_.load();
  for (const auto& link : links_) link->restart();
}

void ThreadTeam::wait(int rank) {
  using Clock = std::chrono::steady_clock;
  const std::uint64_t round = round_;
  places_[std::size_t(rank)].record = &rank_record();
  ++places_[std::size_t(rank)].met;
  if (++here_ == size()) {
    here_ = 0;
    ++round_;
    return;
  }
  const auto began = Clock::now();
  for (int turns = 0; round_ == round; ++turns) {
    if (failed_) throw RankLost(silent_ < 0 ? "another rank has failed" : silence_of(silent_));
    if (turns < 1000) continue;  // most waits are short
    const std::chrono::duration<double> waited = Clock::now() - began;
    if (waited.count() > timeout_) {
      const auto late = std::ranges::find_if(places_, [&](const Place& p) { return p.met <= round; });
      if (late == places_.end()) continue;  // it has just come
      silent_ = int(late - places_.begin());
      fail();
      throw RankLost(silence_of(silent_));
    }
    waited.count() < 1e-3 ? std::this_thread::yield()
                          : std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

}  // namespace bedload
