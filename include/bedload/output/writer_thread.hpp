#pragma once
// A background thread that runs jobs in order.

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace bedload {

/// Runs posted jobs in order. After a job throws, later jobs are dropped and every later call rethrows the
/// error.
class WriterThread {
 public:
  using Job = std::function<void()>;

  /// post() blocks while `depth` jobs wait, which bounds their memory.
  explicit WriterThread(std::size_t depth = 4) : depth_(depth), thread_([this] { work(); }) {}
  /// Finishes the waiting jobs; their errors are lost, so call drain() first.
  ~WriterThread();
  WriterThread(const WriterThread&) = delete;
  WriterThread& operator=(const WriterThread&) = delete;

  void post(Job job);
  /// Returns when every job is done.
  void drain();

 private:
  void work();

  std::size_t depth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;  ///< the first one is running
  std::exception_ptr error_;
  bool ending_ = false;
  std::thread thread_;  ///< last: uses all of the above
};

}  // namespace bedload
