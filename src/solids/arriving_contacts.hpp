#pragma once
// Contacts of grains that go to other ranks.

#include "bedload/neighbours/verlet_list.hpp"
#include "bedload/particles/store.hpp"
#include "kernels/contact/contact_loss.hpp"
#include "kernels/contact/pair_histories.hpp"
#include "src/domain/divide.hpp"

namespace BL_SOLVER {

/// They go along with their grain, whose new rank finds both partners by their ids in its own list.
class ArrivingContacts {
 public:
  /// losses: contacts have them.
  explicit ArrivingContacts(bool losses) : records_(losses) {}
  /// From the rows of a list whose entries have these ids to the ranks to which grains are to move; rows: of
  /// each grain, empty where they are in the order of the list; `listed`: the list is of these grains;
  /// losses: by slots, null where nobody asks for them. By all ranks at the same time.
  void send(const Migrants& migrants, Span<const Index> rows, const VerletListView& list, bool listed,
            const PairHistories& histories, Span<const Id> id, const OpenContact* losses);
  /// Into the rows of grains that had none before (`order`: kNone) go what has come since the last call.
  void settle(Range grains, Span<const Index> order, Span<const Id> id, const VerletListView& list,
              const PairHistories& histories, OpenContact* losses);

 private:
  struct Records : Store {
    explicit Records(bool losses) : Store("contacts") {
      if (!losses) loss.leave_out();
    }
    Field<Id> own{*this, "own", "-", Lifetime::kept}, other{*this, "other", "-", Lifetime::kept};
    Field<ContactHistory> history{*this, "history", ContactHistory::units(), Lifetime::kept};
    Field<OpenContact> loss{*this, "loss", "J, N", Lifetime::kept};
  } records_;
  Buffer<std::uint32_t> own_;  ///< of those that have come, ascending
  Buffer<Index> order_;        ///< the record of each
};

}  // namespace BL_SOLVER
