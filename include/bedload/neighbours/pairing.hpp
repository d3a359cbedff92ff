#pragma once
// Which particles act on which.

#include "bedload/neighbours/for_each_tile.hpp"

namespace BL_SOLVER {

/// Targets, the sources that act on them, how far, and the list of those that are near: what passes run over.
/// Sources may be more than the particles that have rows.
template <class List = VerletList>
class Pairing {
 public:
  /// Between stores, whose `xp` pair loops read and which must stay where they are; reach: how far a pair
  /// acts, m. Returns the list, for what comes within that and half skins now.
  template <class Targets, class Sources>
  List& between(const Frame& frame, const Targets& targets, const Sources& sources, double reach) {
    frame_ = frame, targets_ = targets.owned(), reach_ = reach;
    at_ = &targets.xp.buffer(), from_ = &sources.xp.buffer();
    return list_;
  }
  const List& list() const { return list_; }
  Range targets() const { return targets_; }
  double reach() const { return reach_; }  ///< m

  /// Over all pairs that are closer than reach() now.
  template <class Pass>
  void run(const Pass& pass) const {
    for_each_pair(targets_, list_, separation(), reach_, pass);
  }
  /// Over those closer than `reach` (m), which is no farther.
  template <class Pass>
  void run_within(double reach, const Pass& pass) const {
    for_each_pair(targets_, list_, separation(), reach, pass);
  }
  /// Over those of some targets.
  template <class Pass>
  void run_for(Span<const Index> targets, const Pass& pass) const {
    for_each_pair_of(targets, list_, separation(), reach_, pass);
  }
  /// Over these pairs and then those of the same targets with others.
  template <class Pass>
  void run_with(const Pairing<VerletList>& others, const Pass& pass) const {
    const ListRow<PairSeparation, Pass> other{others.list().view(), others.separation(),
                                              Real(reach_ * reach_)};
    for_each_pair(targets_, list_, separation(), reach_, pass, other);
  }

  PairSeparation separation() const { return {frame_, at_->span(), from_->span()}; }

 private:
  Frame frame_;
  Range targets_{};
  double reach_ = 0;
  const Buffer<PairPosition>*at_ = nullptr, *from_ = nullptr;
  List list_;
};

}  // namespace BL_SOLVER
