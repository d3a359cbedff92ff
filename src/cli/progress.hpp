#pragma once
// The progress line of a run.

#include <chrono>
#include <cstdint>
#include <string>

#include "src/viewer/progress_meter.hpp"

namespace bedload {

/// Rewrites one line on a terminal four times a second, or prints a line now and then.
class Progress {
 public:
  Progress(bool quiet, double begin, double end, std::int64_t steps = 0);
  /// After every step; `particle_steps` so far.
  void update(const StepInfo& info, std::int64_t particle_steps);
  /// Another line, e.g. while grains settle.
  void note(const std::string& text);
  /// Ends the line.
  void close();

 private:
  using Clock = std::chrono::steady_clock;
  void show(const std::string& line);

  bool quiet_, terminal_, open_line_ = false;
  ProgressMeter meter_;
  Clock::time_point noted_;
};

}  // namespace bedload
