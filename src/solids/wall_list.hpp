#pragma once
// List of the grains near each surface of the walls, and what they remember of it.

#include <limits>
#include <memory>
#include <vector>

#include "bedload/host_data.hpp"
#include "bedload/parallel/compact.hpp"
#include "bedload/particles/grains.hpp"
#include "kernels/contact/wall_pass.hpp"
#include "src/domain/divide.hpp"
#include "src/walls/wall_geometry.hpp"

namespace BL_SOLVER {

/// Lists all pairs that may be in contact while grains stay within half a skin of x_list. It is rebuilt when
/// walls have moved further than allowed for. Superfluous entries do not change results. Grains that remember
/// contacts have a row wherever they are.
class WallList {
 public:
  static constexpr double kAnywhere = std::numeric_limits<double>::infinity();

  /// Adds fields to `grains`. `walls` must outlive it; skin: of the grains' list, m; gap: up to which grain
  /// and wall act on each other, m.
  WallList(const Frame& frame, const WallGeometry& walls, GrainStore& grains, double skin, double gap);

  /// Call after grains were sorted or x_list has changed.
  void forget() { stale_ = true; }
  /// Call before walls move from `poses` by up to `travel` (m).
  void cover(const GrainStore& grains, Span<const BodyPose> poses, double travel);

  Index size() const { return Index(grain_.size()); }
  Index everywhere() const { return everywhere_; }  ///< on all ranks
  WallRows rows() const { return {grain_.span(), count_.data(), entry_.data()}; }
  /// Row of each grain; kNone: it is far from walls. Empty without walls.
  Span<const Index> row_of() const { return row_of_ ? std::as_const(*row_of_).span() : Span<const Index>(); }

  // --- memories: stay with their grains, in rows of the last cover(), until the next ---

  /// Number of contacts that each grain remembers; null without walls.
  Index* remembered() const { return remembered_ ? remembered_->buffer().data() : nullptr; }
  WallMemory* const* memories() const;
  /// To host, of each grain; those that it does not have are zero.
  std::vector<WallMemory> memory(int k, Index grains) const;
  std::vector<Index> remembered(Index grains) const;
  /// What passes read and write of grains: how much each remembers, and where.
  std::vector<const FieldBase*> counts() const;
  std::vector<const FieldBase*> places() const;
  /// Bytes of a grain in the list.
  std::size_t row_bytes() const {
    return memory_.empty() ? 0 : (memory_.size() + 1) * sizeof(WallMemory) + sizeof(ContactSum);
  }
  /// With several ranks, all at the same time: before and after grains move to theirs. before, kept: of
  /// move().
  void send(const Migrants& migrants);
  void settle(Index before, Span<const Index> kept);
  /// Adds the memories to what was saved of the grains, and takes them from there, once the grains are there.
  void save(HostStore& grains) const;
  void load(const HostStore& saved, const GrainStore& grains);

 private:
  struct Records;

  Frame frame_;
  const WallGeometry& walls_;
  double skin_, gap_;
  bool stale_ = true;
  double covered_ = 0, moved_ = 0;  ///< allowed and actual wall displacement since the build, m
  Index everywhere_ = 0;
  Buffer<Index> grain_;
  Buffer<std::uint32_t> count_;
  Buffer<Index> entry_;
  std::unique_ptr<Field<Index>> remembered_, row_of_;
  std::vector<Buffer<WallMemory>> memory_;  ///< [walls_.contacts()]
  Buffer<WallMemory> next_;
  mutable std::vector<WallMemory*> pointers_;  ///< to memory_, whose buffers change
  mutable Buffer<WallMemory*> device_pointers_;
  std::shared_ptr<Records> going_;  ///< between send() and settle()
};

}  // namespace BL_SOLVER
