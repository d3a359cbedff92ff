#pragma once
// The threads of ranks.

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "src/team/team_simulation.hpp"
#include "src/team/thread_team.hpp"

namespace bedload {

/// Threads, one a rank, that do the same work at the same time.
class Workers {
 public:
  explicit Workers(const TeamOptions& options);
  ~Workers();

  Link& link(int rank) { return shared_->team.link(rank); }
  /// job(rank) on all threads; rethrows what one of them throws, of the lowest rank that did not only lose
  /// another. An empty job ends them. Gives up threads that do not respond, and throws DeviceError then and
  /// ever after: what a job refers to must last, or belong to it.
  void run(const std::function<void(int)>& job);

 private:
  /// What threads use, also those that are left behind.
  struct Shared {
    explicit Shared(const TeamOptions& options)
        : team(options.ranks, options.timeout, options.names),
          timeout(options.timeout),
          errors(std::size_t(options.ranks)),
          busy(std::size_t(options.ranks), false) {}
    std::ptrdiff_t working() const;

    ThreadTeam team;
    const double timeout;  ///< s
    std::vector<std::exception_ptr> errors;
    std::mutex mutex;
    std::condition_variable wake, done;
    std::function<void(int)> job;
    std::int64_t number = 0;  ///< of the job
    std::vector<bool> busy;   ///< by rank
  };

  static void work(const std::shared_ptr<Shared>& shared, int rank);
  /// Waits until all threads have done the job; false: some do not respond although others have ended.
  bool all_end(std::unique_lock<std::mutex>& lock);
  /// What the job has thrown; null: nothing.
  std::exception_ptr take_error();
  void leave();

  std::shared_ptr<Shared> shared_;
  bool left_ = false;    ///< threads have been left behind
  std::string silence_;  ///< of these
  std::vector<std::thread> threads_;
};

}  // namespace bedload
