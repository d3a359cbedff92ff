#pragma once
// By what drive.factor multiplies drive.f, over time and place.

#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/formula.hpp"

namespace bedload {

class DriveFactor {
 public:
  explicit DriveFactor(const DriveConfig& drive);

  /// Whether it differs from place to place.
  bool varies() const { return varies_; }
  /// At time t (s), where it does not.
  double at(double t) const { return factor_({}, t); }
  /// At each of the places, m.
  std::vector<double> at(const std::vector<Vec3d>& x, double t) const;

 private:
  Formula factor_;
  bool varies_;
};

}  // namespace bedload
