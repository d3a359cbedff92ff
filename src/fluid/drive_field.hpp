#pragma once
#include "bedload/case/config/drive.hpp"
#include "bedload/case/formula.hpp"
#include "bedload/parallel/loops.hpp"
#include "kernels/fluid/drive.hpp"

namespace bedload::inline BL_VARIANT {

/// By what drive.factor multiplies drive.f, over time and place.
class DriveFactor {
 public:
  explicit DriveFactor(const DriveConfig& drive)
      : formula_(drive.factor, "xyzt"),
        varies_(formula_.uses('x') || formula_.uses('y') || formula_.uses('z')) {
    if (varies_) steps_.assign(formula_.steps());
  }

  /// The drive of a case at time t (s) for particles at x; it holds until the next call.
  template <class Position>
  DriveField field(const DriveConfig& drive, const Frame& frame, Span<const Position> x, double t) {
    const int opposed = int(DriveReversal(drive.opposed)) - int(DriveReversal::x);
    if (!varies_) return {frame, formula_({}, t) * drive.f, {}, opposed};
    at_.resize(x.size);
    const FormulaCode code{steps_.data(), int(steps_.size())};
    for_each({0, x.size}, DriveFactorPass<Position>{frame, code, t, x, at_});
    return {frame, drive.f, at_, opposed};
  }

 private:
  Formula formula_;
  bool varies_;  ///< from place to place
  Buffer<FormulaStep> steps_;
  Buffer<Real> at_;  ///< of each particle
};

}  // namespace bedload::inline BL_VARIANT
