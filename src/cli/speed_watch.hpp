#pragma once
// Fluid that comes to flow faster than its sound speed was chosen for.

#include <cstdint>
#include <optional>
#include <string>

#include "bedload/case/config.hpp"
#include "bedload/simulation.hpp"

namespace bedload {

/// Sound is as fast as fluid.vmax asks for; what flows faster is compressed by more than that allows. The
/// front of a column that collapses reaches 1.6 vmax, lone particles of spray more: so much is left.
class SpeedWatch {
 public:
  explicit SpeedWatch(const Config& config);
  /// After a step: one sentence, once, when a hundredth of the fluid is faster than 1.5 vmax or a thousandth
  /// faster than 2 vmax.
  std::optional<std::string> look(Simulation& simulation, const StepInfo& info);

 private:
  double vmax_, sound_, factor_;  ///< m/s, m/s, fluid.c_factor
  bool watching_;
  std::int64_t next_ = 0, gap_ = 20;  ///< steps: when to look next, and after it
};

}  // namespace bedload
