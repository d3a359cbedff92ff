#pragma once
// Progress of a run: rate and remaining wall time.

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "bedload/simulation.hpp"

namespace bedload {

/// "8 s", "4 min 10 s", "2 h 05 min", "3 d 04 h"; "?" if unknown.
std::string duration_text(double seconds);

/// One line of progress.
struct ProgressLine {
  double time = 0, end = 0;  ///< s
  double fraction = 0;       ///< of the run, 0..1
  double steps_per_second = 0, particle_steps_per_second = 0;
  double dt = 0;  ///< s
  std::string_view limit;
  double seconds_left = -1;  ///< negative: unknown

  std::string text() const;
};

/// Rates of a run between two readings.
class ProgressMeter {
 public:
  /// Start and end time of the run, s; steps done before.
  ProgressMeter(double begin, double end, std::int64_t steps);
  /// Wall time since the last reading, s.
  double waited() const;
  /// After a step; `particle_steps` so far.
  ProgressLine read(const StepInfo& info, std::int64_t particle_steps);
  double end() const { return end_; }
  /// Fraction of the run done at that time, 0..1.
  double fraction(double time) const;

 private:
  using Clock = std::chrono::steady_clock;
  double begin_, end_;
  Clock::time_point read_at_ = Clock::now();
  double time_;
  std::int64_t steps_, particle_steps_ = 0;
  double speed_ = 0;  ///< simulated s per s, smoothed
};

}  // namespace bedload
