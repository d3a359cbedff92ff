#pragma once
// How long the parts of a step take where the solver computes.

#include <array>
#include <utility>
#if !BL_CUDA
#include <chrono>
#endif

#include "bedload/parallel/buffer.hpp"

namespace BL_SOLVER {

/// Times work that is queued in parts, one after another: a lap ends one part and begins the next. On a GPU
/// the marks lie between the kernels, so that the host need not wait for each part; those of one run of the
/// watch are read in the next one, when the device has work again.
class Stopwatch {
 public:
  static constexpr int kMostLaps = 16;  ///< between start and stop
  static constexpr int kMostParts = 8;

#if BL_CUDA
  Stopwatch() {
    for (Run* run : {&now_, &last_})
      for (cudaEvent_t& mark : run->marks) check_cuda(cudaEventCreate(&mark), "timing");
  }
  ~Stopwatch() {
    for (Run* run : {&now_, &last_})
      for (cudaEvent_t mark : run->marks) cudaEventDestroy(mark);
  }
#else
  Stopwatch() = default;
#endif
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

  void start() {
    now_.laps = 0;
    mark();
  }
  /// What has been queued since the last mark belonged to `part`; after kMostLaps - 1 of them no time
  /// is recorded.
  void lap(int part) {
    if (now_.laps + 1 >= kMostLaps) return;
    now_.part[now_.laps++] = part;
    mark();
    if (now_.laps == 2) read_last();
  }
  void stop() {
    read_last();
    std::swap(now_, last_);
  }

  /// Spent in a part so far, s. Waits for the last lap.
  double seconds(int part) const {
    double all = seconds_[part];
    last_.each([&](int of, double s) { all += of == part ? s : 0; });
    return all;
  }

 private:
  /// From start to stop.
  struct Run {
#if BL_CUDA
    double between(int k) const {
      float ms = 0;
      check_cuda(cudaEventElapsedTime(&ms, marks[k], marks[k + 1]), "timing");
      return 1e-3 * ms;
    }
    void wait() const { check_cuda(cudaEventSynchronize(marks[laps]), "timing"); }
    std::array<cudaEvent_t, kMostLaps> marks{};
#else
    using Clock = std::chrono::steady_clock;
    double between(int k) const { return std::chrono::duration<double>(marks[k + 1] - marks[k]).count(); }
    void wait() const {}
    std::array<Clock::time_point, kMostLaps> marks{};
#endif
    std::array<int, kMostLaps> part{};
    int laps = 0;

    /// f(part, s) for each lap.
    template <class F>
    void each(const F& f) const {
      if (laps == 0) return;
      wait();
      for (int k = 0; k < laps; ++k) f(part[k], between(k));
    }
  };

  void mark() {
#if BL_CUDA
    check_cuda(cudaEventRecord(now_.marks[now_.laps], Context::current().stream()), "timing");
#else
    now_.marks[now_.laps] = Run::Clock::now();
#endif
  }
  void read_last() {
    last_.each([&](int part, double s) { seconds_[part] += s; });
    last_.laps = 0;
  }

  Run now_, last_;
  std::array<double, kMostParts> seconds_{};
};

}  // namespace BL_SOLVER
