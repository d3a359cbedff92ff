#include "src/team/thread_team.hpp"

#include <chrono>
#include <cmath>
#include <cstring>
#include <string>
#include <thread>

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
    team_.wait(rank_);
    for (std::size_t r = 0; r < given.size() && bytes > 0; ++r)
      std::memcpy(static_cast<std::byte*>(all) + r * bytes, given[r].data(), bytes);
  }
  void restart() { turn_ = 0; }

 private:
  ThreadTeam& team_;
  int rank_;
  int turn_ = 0;
};

ThreadTeam::ThreadTeam(int ranks, double timeout) : timeout_(timeout) {
  for (auto& given : given_) given.resize(std::size_t(ranks));
  for (int r = 0; r < ranks; ++r) links_.push_back(std::make_unique<RankLink>(*this, r));
}
ThreadTeam::~ThreadTeam() = default;

Link& ThreadTeam::link(int rank) { return *links_[std::size_t(rank)]; }

std::string ThreadTeam::too_long(int rank) const {
  return "rank " + std::to_string(rank) + " has waited " + std::to_string(int(std::ceil(timeout_))) +
         " s for another";
}

void ThreadTeam::recover() {
  failed_ = false;
  impatient_ = -1;
  here_ = 0;
  for (const auto& link : links_) link->restart();
}

void ThreadTeam::wait(int rank) {
  using Clock = std::chrono::steady_clock;
  const std::uint64_t round = round_;
  if (++here_ == size()) {
    here_ = 0;
    ++round_;
    return;
  }
  const auto began = Clock::now();
  for (int turns = 0; round_ == round; ++turns) {
    if (failed_) throw RankLost(impatient_ < 0 ? "another rank has failed" : too_long(impatient_));
    if (turns < 1000) continue;  // most waits are short
    const std::chrono::duration<double> waited = Clock::now() - began;
    if (waited.count() > timeout_) {
      impatient_ = rank;
      fail();
      throw RankLost(too_long(rank));
    }
    waited.count() < 1e-3 ? std::this_thread::yield()
                          : std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

}  // namespace bedload
