#pragma once
// Work off the critical path, in order, by one thread.

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace bedload {

/// Runs the jobs posted to it one after another. The first job that throws ends
/// the work: later jobs are dropped and the error is rethrown to every later caller.
class WriterThread {
 public:
  using Job = std::function<void()>;

  /// At most `depth` jobs wait; more make post() wait, which bounds the memory they hold.
  explicit WriterThread(std::size_t depth = 4) : depth_(depth), thread_([this] { work(); }) {}
  /// Does what is still waiting, then ends; errors are lost, so drain() first.
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
  std::deque<Job> jobs_;  ///< the first one stays here while it runs
  std::exception_ptr error_;
  bool ending_ = false;
  std::thread thread_;  ///< last: starts when all of the above is ready
};

}  // namespace bedload
