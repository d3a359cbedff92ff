#pragma once
// Runs a pass over the pairs of a Verlet list or, list-free, over the cells. A pass has
//   Sum start(i); void pair(Sum&, i, j, r_ij, r2); void finish(i, Sum);
// and knows nothing of where its neighbours come from.

#include "bedload/neighbours/verlet_list.hpp"

namespace bedload::inline BL_VARIANT {

/// r_i - r_j of SPH particles, nearest image.
struct SphSeparation {
  Frame frame;
  Span<const PairPosition> a, b;
  BL_HD Real3 operator()(Index i, Index j) const { return frame.separation(a[i], b[j]); }
};

/// r_i - r_j across the phases or between grains: formed in fp64, handed over as Real.
template <class PA, class PB>
struct CrossSeparation {
  Frame frame;
  Span<const PA> a;
  Span<const PB> b;
  BL_HD Real3 operator()(Index i, Index j) const {
    return Real3(frame.separation(coordinates(frame, a[i]), coordinates(frame, b[j])));
  }
};

template <class Separation, class Pass>
struct ListLoop {
  VerletListView list;
  Separation separation;
  Real range2;
  Pass pass;
  BL_HD void operator()(Index i) const {
    auto sum = pass.start(i);
    const std::uint32_t n = list.count[i];
    std::uint64_t slot = list.first(i);
    for (std::uint32_t k = 0; k < n; ++k, slot += kSlice) {
      const Index j = list.entry[slot];
      const Real3 r = separation(i, j);
      const Real r2 = norm2(r);
      if (r2 < range2) pass.pair(sum, i, j, r, r2);
    }
    pass.finish(i, sum);
  }
};

/// The pairs of `list` that are closer than `cutoff` (m) now.
template <class Separation, class Pass>
void for_each_pair(Range range, const VerletList& list, const Separation& separation, double cutoff,
                   const Pass& pass) {
  for_each(range, ListLoop<Separation, Pass>{list.view(), separation, Real(cutoff * cutoff), pass});
}

/// A pass over two lists in one go: `pair` for the first, `wall_pair` for the second.
template <class Separation, class Pass>
struct TwoListLoop {
  VerletListView list, wall_list;
  Separation separation, wall_separation;
  Real range2;
  Pass pass;
  BL_HD void operator()(Index i) const {
    auto sum = pass.start(i);
    std::uint32_t n = list.count[i];
    std::uint64_t slot = list.first(i);
    for (std::uint32_t k = 0; k < n; ++k, slot += kSlice) {
      const Index j = list.entry[slot];
      const Real3 r = separation(i, j);
      const Real r2 = norm2(r);
      if (r2 < range2) pass.pair(sum, i, j, r, r2);
    }
    n = wall_list.count[i];
    slot = wall_list.first(i);
    for (std::uint32_t k = 0; k < n; ++k, slot += kSlice) {
      const Index j = wall_list.entry[slot];
      const Real3 r = wall_separation(i, j);
      const Real r2 = norm2(r);
      if (r2 < range2) pass.wall_pair(sum, i, j, r, r2);
    }
    pass.finish(i, sum);
  }
};

template <class Separation, class Pass>
void for_each_pair(Range range, const VerletList& list, const Separation& separation, const VerletList& wall_list,
                   const Separation& wall_separation, double cutoff, const Pass& pass) {
  for_each(range, TwoListLoop<Separation, Pass>{list.view(), wall_list.view(), separation, wall_separation,
                                                Real(cutoff * cutoff), pass});
}

template <class Near, class Separation, class Pass>
struct CellLoop {
  CellGridView sources;
  Near near;
  Separation separation;
  Real range2;
  Pass pass;
  BL_HD void operator()(Index i) const {
    auto sum = pass.start(i);
    sources.each_near(near.place(i), near.reach(i), [&](Index j) {
      if (!near(i, j)) return;
      const Real3 r = separation(i, j);
      const Real r2 = norm2(r);
      if (r2 < range2) pass.pair(sum, i, j, r, r2);
    });
    pass.finish(i, sum);
  }
};

/// The same without a list: scans the cells. The oracle in tests, and the choice when lists would not last.
template <class Near, class Separation, class Pass>
void for_each_pair(Range range, const CellGridView& sources, const Near& near, const Separation& separation,
                   double cutoff, const Pass& pass) {
  for_each(range, CellLoop<Near, Separation, Pass>{sources, near, separation, Real(cutoff * cutoff), pass});
}

}  // namespace bedload::inline BL_VARIANT
