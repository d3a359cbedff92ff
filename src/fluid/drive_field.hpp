#pragma once
#include "bedload/case/config/drive.hpp"
#include "bedload/case/formula.hpp"
#include "bedload/parallel/loops.hpp"
#include "bedload/particles/scratch.hpp"
#include "kernels/fluid/drive.hpp"

namespace BL_SOLVER {

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
    of_each_.resize(x.size);
    const FormulaCode code{steps_.data(), int(steps_.size())};
    for_each({0, x.size}, DriveFactorPass<Position>{frame, code, t, x, at_});
    return {frame, drive.f, at_, opposed};
  }
  std::size_t scratch_bytes() const { return of_each_.entry_bytes(); }  ///< of one particle

 private:
  Formula formula_;
  bool varies_;  ///< from place to place
  Buffer<FormulaStep> steps_;
  Scratch of_each_;
  ScratchArray<Real> at_{of_each_, varies_};
};

}  // namespace BL_SOLVER
