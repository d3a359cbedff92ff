#pragma once
// What pressure.linear_exact adds to the pressure loads on closed bodies.

#include <vector>

#include "bedload/parallel/loops.hpp"
#include "bedload/particles/walls.hpp"
#include "kernels/fluid/body_pressure.hpp"

namespace BL_SOLVER {

/// For a moment: fit(), FluidSolver::body_pressures() with its result, find().
class PressureCorrection {
 public:
  /// dimensions: of the flow, to leave out bodies that do not have fluid all around, and none within; 0: does
  /// not look for that.
  explicit PressureCorrection(const std::vector<EnclosedSolid>& solids, int dimensions = 0);

  bool any() const { return !solids_.empty(); }
  /// Fits a linear pressure to the wet wall particles of each body. poses: one row at least.
  BodyPressures fit(const WallStore& walls, Span<const BodyPose> poses, const LoadBounds& bounds);
  void find(const WallStore& walls, Span<const BodyPose> poses, const LoadBounds& bounds);
  /// Load by wall body, 0 for others, about their reference points, on the device.
  Span<const LoadSum> added() const { return added_; }

 private:
  Range each() const { return {0, Index(solids_.size())}; }

  std::vector<EnclosedSolid> solids_;
  int dimensions_;
  Buffer<EnclosedSolid> device_solids_;
  Buffer<BodyPressureSums> sums_;  ///< [solids]
  Buffer<BodyPressure> fitted_;    ///< [poses]
  Buffer<PairsOfWall> of_walls_;   ///< [walls]
  Buffer<PairsOfBody> of_bodies_;  ///< [solids]
  Buffer<LoadSum> added_;          ///< [poses]
};

}  // namespace BL_SOLVER
