#pragma once
// Warns of fluid faster than its sound speed was chosen for.

#include <cstdint>
#include <optional>
#include <string>

#include "bedload/case/config.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

/// The sound speed follows from fluid.vmax; faster fluid is compressed more than intended. The front of a dam
/// break reaches 1.6 vmax and single particles of spray more, so the thresholds are above that.
class SpeedWatch {
 public:
  explicit SpeedWatch(const Config& config);
  /// After a step: one sentence, once, when 1 % of the fluid is faster than 1.5 vmax or 0.1 % faster than
  /// 2 vmax.
  std::optional<std::string> check(Simulation& simulation, const StepInfo& info);

 private:
  double vmax_, sound_, factor_;  ///< m/s, m/s, fluid.c_factor
  bool active_;
  std::int64_t next_ = 0, gap_ = 20;  ///< steps: of the next check, and until the one after
};

}  // namespace bedload
