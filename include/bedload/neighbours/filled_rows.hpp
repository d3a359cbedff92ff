#pragma once
// Passes over rows of which many may have no entries.

#include "bedload/neighbours/pairing.hpp"
#include "bedload/parallel/compact.hpp"

namespace BL_SOLVER {

struct HasEntries {
  VerletListView list;
  BL_HD bool operator()(Index i) const { return list.count[i] > 0; }
};

/// A pass over the rows without entries.
template <class Pass>
struct EmptyRowPass {
  VerletListView list;
  Pass pass;
  BL_HD void operator()(Index i) const {
    if (list.count[i] == 0) pass.finish(i, pass.start(i));
  }
};

/// The rows of a list that have entries: lanes share these, one thread is enough for each of the others.
class FilledRows {
 public:
  /// After the list was built. Waits for the device where there are many rows.
  void find(const VerletList& list) {
    rows_.resize(0);
    apart_ = list.rows() >= kMany;
    if (!apart_) return;
    find_all(list.rows(), HasEntries{list.view()}, rows_);
    apart_ = rows_.size() < list.rows() / 4 * 3;
  }
  template <class Pass>
  void run(const Pairing<>& pairs, const Pass& pass) const {
    if (!apart_) return pairs.run(pass);
    pairs.run_for(rows_, pass);
    for_each(pairs.targets(), EmptyRowPass<Pass>{pairs.list().view(), pass});
  }

 private:
#if BL_CUDA
  static constexpr Index kMany = 1u << 17;  ///< fewer do not keep a GPU busy, and finding these costs a wait
#else
  static constexpr Index kMany = 1;
#endif
  bool apart_ = false;
  Buffer<Index> rows_;
};

}  // namespace BL_SOLVER
