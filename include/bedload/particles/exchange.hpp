#pragma once
// Values of particles that go from rank to rank.

#include <array>
#include <vector>

#include "bedload/parallel/ranks.hpp"
#include "bedload/particles/field.hpp"

namespace BL_SOLVER {

/// Copies of particles to other ranks. A rank gathers what others want into its outbox; once all have done so,
/// each takes its part from the outboxes of the others. There are two, used by turns: when a rank fills one
/// again, all have left the exchange in between, and so have read what was there.
class Exchange {
 public:
  /// This rank sends the particles at places[of_rank[r]] to places[of_rank[r + 1]] to rank r.
  void plan(const std::vector<Index>& of_rank, Span<const Index> places);
  /// How many come here; those of one rank stand together, in the order of ranks.
  Index incoming() const { return incoming_; }
  /// Sends the values of `fields`, which then stand at `first` and behind, as many as are coming.
  void run(const std::vector<FieldBase*>& fields, Index first);

 private:
  Index of(int from, int to) const { return begin_[from * (ranks_ + 1) + to]; }

  int ranks_ = 1;
  std::vector<Index> begin_;  ///< [rank][rank + 1]: where in its outbox what a rank sends to another begins
  Index incoming_ = 0;
  Buffer<Index> places_;
  std::array<Buffer<std::byte>, 2> outbox_;
  int turn_ = 0;
};

}  // namespace BL_SOLVER
