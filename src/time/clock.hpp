#pragma once
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bedload/case/config/time.hpp"
#include "bedload/core/error.hpp"
#include "bedload/step_limits.hpp"

namespace bedload {

/// Time, steps, and which limit binds the next one.
class Clock {
 public:
  explicit Clock(const TimeConfig& parameters) : parameters_(parameters) {}

  double time = 0;  ///< s
  std::int64_t step = 0;
  double last_dt = 0;  ///< s

  /// The least of the limits; adaptive steps grow by at most 5 %. A fixed step above a limit is
  /// a KeyError unless forced.
  double next_dt(const std::vector<StepLimit>& limits, Limit& binding) const {
    if (parameters_.dt > 0) {
      binding = Limit::fixed;
      for (const auto& l : limits)
        if (parameters_.dt > l.seconds * (1 + 1e-9) && !parameters_.force_dt)
          throw KeyError("time.dt", "time.dt = " + std::to_string(parameters_.dt * 1e6) +
                                        " us: must be at most " + std::to_string(l.seconds * 1e6) +
                                        " us; limited by " + with_key(l.limit) +
                                        " at t = " + std::to_string(time) + " s");
      return parameters_.dt;
    }
    double dt = last_dt > 0 ? 1.05 * last_dt : std::numeric_limits<double>::infinity();
    binding = Limit::growth;
    for (const auto& l : limits)
      if (l.seconds < dt) dt = l.seconds, binding = l.limit;
    return dt;
  }

 private:
  TimeConfig parameters_;
};

}  // namespace bedload
