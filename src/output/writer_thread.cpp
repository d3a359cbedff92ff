#include "bedload/output/writer_thread.hpp"

#include <chrono>
#include <utility>

#include "bedload/core/cores.hpp"

namespace bedload {

WriterThread::~WriterThread() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void WriterThread::post(Job job, Size size) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return error_ || jobs_.size() < depth_; });
  if (error_) std::rethrow_exception(error_);
  jobs_.push_back({std::move(job), size});
  large_ += size == Size::large;
  changed_.notify_all();
}

void WriterThread::wait_for_large(std::size_t most) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return error_ || large_ <= most; });
  if (error_) std::rethrow_exception(error_);
}

double WriterThread::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_;
}

void WriterThread::drain() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return error_ || jobs_.empty(); });
  if (error_) std::rethrow_exception(error_);
}

void WriterThread::work() {
  use_all_cores();
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    Job job = std::move(jobs_.front().job);
    lock.unlock();
    const auto from = std::chrono::steady_clock::now();
    std::exception_ptr error;
    try {
      job();
    } catch (...) {
      error = std::current_exception();
    }
    job = nullptr;  // with its memory
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - from;
    lock.lock();
    busy_ += spent.count();
    large_ -= jobs_.front().size == Size::large;
    jobs_.pop_front();
    if (error) {
      error_ = error;
      jobs_.clear();
      large_ = 0;
    }
    changed_.notify_all();
  }
}

}  // namespace bedload
