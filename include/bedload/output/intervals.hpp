#pragma once

#include <map>
#include <string>
#include <vector>

#include "bedload/case/config/output.hpp"

namespace bedload {

/// The output intervals of a case. Intervals below the time step are written once per step, with a warning.
class OutputIntervals {
 public:
  explicit OutputIntervals(const OutputConfig& out);
  /// One sentence for each interval below the time step dt (s), once.
  std::vector<std::string> newly_below(double dt);

 private:
  std::map<double, std::string> keys_;  ///< by interval, s; not yet reported
};

}  // namespace bedload
