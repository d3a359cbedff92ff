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
  enum class Size { small, large };  ///< of the memory that it holds

  /// post() blocks while `depth` jobs wait.
  explicit WriterThread(std::size_t depth = 4) : depth_(depth), thread_([this] { work(); }) {}
  /// Finishes the waiting jobs; their errors are lost, so call drain() first.
  ~WriterThread();
  WriterThread(const WriterThread&) = delete;
  WriterThread& operator=(const WriterThread&) = delete;

  void post(Job job, Size size = Size::small);
  /// Returns when no more than so many large jobs wait or run, which bounds their memory.
  void wait_for_large(std::size_t most);
  /// Returns when every job is done.
  void drain();
  /// Time spent in jobs so far, s.
  double busy() const;

 private:
  struct Posted {
    Job job;
    Size size;
  };
  void work();

  std::size_t depth_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Posted> jobs_;  ///< the first one is running
  std::size_t large_ = 0;    ///< of these
  double busy_ = 0;          ///< s
  std::exception_ptr error_;
  bool ending_ = false;
  std::thread thread_;  ///< last: uses all of the above
};

}  // namespace bedload
