#pragma once
// Which grains may meet which surfaces of the walls.

#include <limits>

#include "bedload/parallel/compact.hpp"
#include "bedload/particles/grains.hpp"
#include "kernels/contact/wall_pass.hpp"
#include "src/walls/wall_geometry.hpp"

namespace bedload::inline BL_VARIANT {

/// A list of all that may touch while grains stay within half a skin of x_list. It is made anew where walls
/// have gone further than it was made for. What it holds too much does not change any result.
class WallList {
 public:
  static constexpr double kAnywhere = std::numeric_limits<double>::infinity();

  /// `walls` must outlive it; skin: of the grains' list, m; gap: between grain and wall across which they act
  /// on each other, m.
  WallList(const Frame& frame, const WallGeometry& walls, double skin, double gap)
      : frame_(frame), walls_(walls), skin_(skin), gap_(gap) {}

  /// Grains are in other places of their store, or x_list has changed.
  void forget() { stale_ = true; }
  /// Before walls move from `poses` by `travel` (m) at most. remembered: wall contacts of each grain.
  void cover(const GrainStore& grains, Span<const BodyPose> poses, const Index* remembered, double travel);

  Index size() const { return Index(grain_.size()); }
  WallRows rows() const { return {grain_.span(), count_.data(), entry_.data()}; }
  Span<const Index> row_of() const { return row_of_.span(); }  ///< of each grain; kNone: it has none

 private:
  Frame frame_;
  const WallGeometry& walls_;
  double skin_, gap_;
  bool stale_ = true;
  double covered_ = 0, moved_ = 0;  ///< how far walls may go and have gone since the list was made, m
  Buffer<Index> grain_, row_of_;
  Buffer<std::uint32_t> count_;
  Buffer<Index> entry_;
};

}  // namespace bedload::inline BL_VARIANT
