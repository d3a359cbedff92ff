#pragma once
#include "kernels/fluid/drive.hpp"
#include "src/motion/drive_factor.hpp"

namespace bedload::inline BL_VARIANT {

/// The drive of a case at time t (s) for particles at x (m; may be empty where its factor is the same
/// everywhere). `factors` keeps what it refers to.
inline DriveField drive_field(const DriveConfig& drive, const DriveFactor& factor, const Frame& frame,
                              const std::vector<Vec3d>& x, double t, Buffer<Real>& factors) {
  const int opposed = int(DriveReversal(drive.opposed)) - int(DriveReversal::x);
  if (!factor.varies()) return {frame, factor.at(t) * drive.f, {}, opposed};
  const std::vector<double> at = factor.at(x, t);
  factors.assign(std::vector<Real>(at.begin(), at.end()));
  return {frame, drive.f, factors, opposed};
}

}  // namespace bedload::inline BL_VARIANT
