#pragma once

#include <map>
#include <string>
#include <vector>

#include "bedload/case/config/output.hpp"

namespace bedload {

/// The intervals at which a case writes. What is due more often than once a step is written once a step,
/// which is to be told.
class OutputIntervals {
 public:
  explicit OutputIntervals(const OutputConfig& out);
  /// One sentence for each interval below a step of dt (s) that was not told before.
  std::vector<std::string> newly_below(double dt);

 private:
  std::map<double, std::string> keys_;  ///< by interval, s; those not told
};

}  // namespace bedload
