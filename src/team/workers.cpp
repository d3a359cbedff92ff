#include "src/team/workers.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "bedload/core/error.hpp"

namespace bedload {
namespace {

bool is_lost(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const RankLost&) {
    return true;
  } catch (...) {
    return false;
  }
}

}  // namespace

std::ptrdiff_t Workers::Shared::working() const { return std::ranges::count(busy, true); }

Workers::Workers(const TeamOptions& options) : shared_(std::make_shared<Shared>(options)) {
  for (int r = 0; r < options.ranks; ++r) threads_.emplace_back(work, shared_, r);
}

Workers::~Workers() {
  if (left_) return;
  try {
    run({});
  } catch (const DeviceError&) {
    return;
  }
  for (std::thread& thread : threads_) thread.join();
}

void Workers::run(const std::function<void(int)>& job) {
  if (left_) throw DeviceError(silence_);
  Shared& s = *shared_;
  std::unique_lock lock(s.mutex);
  s.job = job;
  s.busy.assign(s.busy.size(), true);
  ++s.number;
  s.wake.notify_all();
  const bool ended = all_end(lock);
  const std::exception_ptr error = take_error();
  if (!ended) leave();
  if (ended && error) s.team.recover();
  try {
    if (error) std::rethrow_exception(error);
  } catch (const RankLost& lost) {
    throw DeviceError(lost.what());
  }
  if (left_) throw DeviceError(silence_);
}

void Workers::work(const std::shared_ptr<Shared>& shared, int rank) {
  Shared& s = *shared;
  for (std::int64_t last = 0;;) {
    std::function<void(int)> job;
    {
      std::unique_lock lock(s.mutex);
      s.wake.wait(lock, [&] { return s.number != last; });
      last = s.number;
      job = s.job;
    }
    const bool end = !job;
    std::exception_ptr error;
    if (job) try {
        job(rank);
      } catch (...) {
        error = std::current_exception();
        s.team.fail();
      }
    job = nullptr;
    const std::lock_guard lock(s.mutex);
    s.errors[std::size_t(rank)] = error;
    s.busy[std::size_t(rank)] = false;
    if (s.working() == 0) s.done.notify_all();
    if (end) return;
  }
}

bool Workers::all_end(std::unique_lock<std::mutex>& lock) {
  using Clock = std::chrono::steady_clock;
  constexpr double grace = 1;  // s, for those that hear of a failure
  Shared& s = *shared_;
  auto since = Clock::now();
  for (auto before = std::pair(s.working(), s.team.rounds()); before.first > 0;) {
    s.done.wait_for(lock, std::chrono::milliseconds(50));
    const auto now = std::pair(s.working(), s.team.rounds());
    if (now != before || now.first == s.team.size()) since = Clock::now();
    before = now;
    const std::chrono::duration<double> still = Clock::now() - since;
    if (now.first > 0 && still.count() > grace + (s.team.failed() ? 0 : s.timeout)) return false;
  }
  return true;
}

std::exception_ptr Workers::take_error() {
  std::exception_ptr first;
  bool lost = false;
  for (std::exception_ptr& error : shared_->errors) {
    if (!error) continue;
    const bool only_lost = is_lost(error);
    if (!first || (lost && !only_lost)) first = error, lost = only_lost;
    error = nullptr;
  }
  return first;
}

/// Gives up the threads that still work. The process must then end without the driver of their devices, which
/// might wait for them.
void Workers::leave() {
  const auto first = std::ranges::find(shared_->busy, true);
  silence_ = shared_->team.silence_of(int(first - shared_->busy.begin()));
  left_ = true;
  for (std::thread& thread : threads_) thread.detach();
  on_exit(
      [](int status, void*) {
        std::fflush(nullptr);
        _exit(status);
      },
      nullptr);
}

}  // namespace bedload
