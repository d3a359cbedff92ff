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

/// A loop over some of its indices.
template <class F>
struct SomeOfLoop {
  Span<const Index> some;
  F f;
  BL_HD void operator()(Index k) const { f(some[k]); }
};

/// The rows of a list that have entries: lanes share these, one thread is enough for each of the others.
class FilledRows {
 public:
  /// After the list was built. Waits for the device where there are many rows.
  void find(const VerletList& list) {
    rows_.resize(0);
    listed_ = list.rows();
    apart_ = listed_ >= kMany;
    if (!apart_) return;
    find_all(listed_, HasEntries{list.view()}, rows_);
    apart_ = rows_.size() < listed_ / 4 * 3;
  }
  template <class Pass>
  void run(const Pairing<>& pairs, const Pass& pass) const {
    if (!apart_) return pairs.run(pass);
    pairs.run_for(rows_, pass);
    for_each(pairs.targets(), EmptyRowPass<Pass>{pairs.list().view(), pass});
  }
  /// f(i) for all rows with entries, at least, and for what has no row in the list.
  template <class F>
  void each(Range all, const F& f) const {
    if (!apart_) return for_each(all, f);
    for_each({0, Index(rows_.size())}, SomeOfLoop<F>{rows_, f});
    for_each({listed_, all.end}, f);
  }

 private:
#if BL_CUDA
  static constexpr Index kMany = 1u << 17;  ///< fewer do not keep a GPU busy, and finding these costs a wait
#else
  static constexpr Index kMany = 1;
#endif
  bool apart_ = false;
  Index listed_ = 0;
  Buffer<Index> rows_;
};

}  // namespace BL_SOLVER
