#pragma once
// How long the parts of a step take where the solver computes.

#include <array>
#if !BL_CUDA
#include <chrono>
#endif

#include "bedload/parallel/buffer.hpp"

namespace BL_SOLVER {

/// Times work that is queued in parts, one after another: a lap ends one part and begins the next. On a GPU
/// the marks lie between the kernels, so that the host need not wait for each part.
class Stopwatch {
 public:
  static constexpr int kMostLaps = 16;  ///< between start and stop
  static constexpr int kMostParts = 8;

#if BL_CUDA
  Stopwatch() {
    for (cudaEvent_t& mark : marks_) check_cuda(cudaEventCreate(&mark), "timing");
  }
  ~Stopwatch() {
    for (cudaEvent_t mark : marks_) cudaEventDestroy(mark);
  }
#else
  Stopwatch() = default;
#endif
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

  void start() {
    laps_ = 0;
    mark();
  }
  /// What has been queued since the last mark belonged to `part`; after kMostLaps - 1 of them no time
  /// is recorded.
  void lap(int part) {
    if (laps_ + 1 >= kMostLaps) return;
    part_[laps_++] = part;
    mark();
  }
  /// Adds the laps since start() up; waits for the last of them.
  void stop() {
    if (laps_ == 0) return;
#if BL_CUDA
    check_cuda(cudaEventSynchronize(marks_[laps_]), "timing");
#endif
    for (int k = 0; k < laps_; ++k) seconds_[part_[k]] += between(k);
  }

  /// Spent in a part so far, s.
  double seconds(int part) const { return seconds_[part]; }

 private:
#if BL_CUDA
  void mark() { check_cuda(cudaEventRecord(marks_[laps_], Context::current().stream()), "timing"); }
  double between(int k) const {
    float ms = 0;
    check_cuda(cudaEventElapsedTime(&ms, marks_[k], marks_[k + 1]), "timing");
    return 1e-3 * ms;
  }
  std::array<cudaEvent_t, kMostLaps> marks_{};
#else
  using Clock = std::chrono::steady_clock;
  void mark() { marks_[laps_] = Clock::now(); }
  double between(int k) const { return std::chrono::duration<double>(marks_[k + 1] - marks_[k]).count(); }
  std::array<Clock::time_point, kMostLaps> marks_{};
#endif
  std::array<int, kMostLaps> part_{};
  std::array<double, kMostParts> seconds_{};
  int laps_ = 0;
};

}  // namespace BL_SOLVER
