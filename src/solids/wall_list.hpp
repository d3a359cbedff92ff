#pragma once
// List of the grains near each surface of the walls.

#include <limits>

#include "bedload/parallel/compact.hpp"
#include "bedload/particles/grains.hpp"
#include "kernels/contact/wall_pass.hpp"
#include "src/walls/wall_geometry.hpp"

namespace BL_SOLVER {

/// Lists all pairs that may be in contact while grains stay within half a skin of x_list. It is rebuilt when
/// walls have moved further than allowed for. Superfluous entries do not change results.
class WallList {
 public:
  static constexpr double kAnywhere = std::numeric_limits<double>::infinity();

  /// `walls` must outlive it; skin: of the grains' list, m; gap: up to which grain and wall act on each
  /// other, m.
  WallList(const Frame& frame, const WallGeometry& walls, double skin, double gap)
      : frame_(frame), walls_(walls), skin_(skin), gap_(gap) {}

  /// Call after grains were sorted or x_list has changed.
  void forget() { stale_ = true; }
  /// Call before walls move from `poses` by up to `travel` (m). remembered: number of wall contacts of each
  /// grain.
  void cover(const GrainStore& grains, Span<const BodyPose> poses, const Index* remembered, double travel);

  Index size() const { return Index(grain_.size()); }
  Index everywhere() const { return everywhere_; }  ///< on all ranks
  WallRows rows() const { return {grain_.span(), count_.data(), entry_.data()}; }
  /// Row of each grain; kNone: it is far from walls.
  Span<const Index> row_of() const { return row_of_.span(); }

 private:
  Frame frame_;
  const WallGeometry& walls_;
  double skin_, gap_;
  bool stale_ = true;
  double covered_ = 0, moved_ = 0;  ///< allowed and actual wall displacement since the build, m
  Index everywhere_ = 0;
  Buffer<Index> grain_, row_of_;
  Buffer<std::uint32_t> count_;
  Buffer<Index> entry_;
};

}  // namespace BL_SOLVER
