#pragma once
// Runs a pass over the pairs of a Verlet list or, list-free, over the cells. A pass has
//   Sum start(i); void pair(Sum&, i, j, r_ij, r2); void finish(i, Sum);
// and knows nothing of where its neighbours come from. Where it can also
//   void merge(Sum& into, const Sum& other);
// two partial sums of one row, several GPU lanes share a row of a small system.

#include <utility>

#include "bedload/neighbours/verlet_list.hpp"
#include "bedload/parallel/lanes.hpp"

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

template <class Pass, class Sum>
concept Mergeable = requires(const Pass& pass, Sum& into, const Sum& other) { pass.merge(into, other); };

template <class Pass>
unsigned pass_lane_bits(const Pass&, Range range) {
  using Sum = decltype(std::declval<const Pass&>().start(Index()));
  return Mergeable<Pass, Sum> ? lane_bits(range.size()) : 0;
}

/// One lane's share of the pairs of row i that are closer than the cut-off now.
template <class Separation>
struct ListRow {
  VerletListView list;
  Separation separation;
  Real range2;
  template <class F>
  BL_HD void operator()(Index i, const Lane& lane, F&& f) const {
    const std::uint32_t n = list.count[i];
    std::uint64_t slot = list.slot(i, lane.index);
    for (std::uint32_t k = lane.index; k < n; k += lane.count, slot += lane.count * kSlice) {
      const Index j = list.entry[slot];
      const Real3 r = separation(i, j);
      const Real r2 = norm2(r);
      if (r2 < range2) f(j, r, r2);
    }
  }
};

/// Ends a row: a pass without `merge` has one lane.
template <class Pass, class Sum>
BL_HD void finish_row(const Pass& pass, Index i, const Lane& lane, Sum& sum) {
  if constexpr (Mergeable<Pass, Sum>)
    lane.combine(sum, [&](Sum& into, const Sum& other) { pass.merge(into, other); });
  if (lane.index == 0) pass.finish(i, sum);
}

template <class Separation, class Pass>
struct ListLoop {
  ListRow<Separation> row;
  Pass pass;
  Index begin;
  unsigned bits;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, bits);
    const Index i = begin + lane.row;
    auto sum = pass.start(i);
    row(i, lane, [&](Index j, const Real3& r, Real r2) { pass.pair(sum, i, j, r, r2); });
    finish_row(pass, i, lane, sum);
  }
};

/// The pairs of `list` that are closer than `cutoff` (m) now.
template <class Separation, class Pass>
void for_each_pair(Range range, const VerletList& list, const Separation& separation, double cutoff,
                   const Pass& pass) {
  const unsigned bits = pass_lane_bits(pass, range);
  for_each({0, range.size() << bits},
           ListLoop<Separation, Pass>{{list.view(), separation, Real(cutoff * cutoff)}, pass, range.begin, bits});
}

/// A pass over two lists in one go: `pair` for the first, `wall_pair` for the second.
template <class Separation, class Pass>
struct TwoListLoop {
  ListRow<Separation> row, wall_row;
  Pass pass;
  Index begin;
  unsigned bits;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, bits);
    const Index i = begin + lane.row;
    auto sum = pass.start(i);
    row(i, lane, [&](Index j, const Real3& r, Real r2) { pass.pair(sum, i, j, r, r2); });
    wall_row(i, lane, [&](Index j, const Real3& r, Real r2) { pass.wall_pair(sum, i, j, r, r2); });
    finish_row(pass, i, lane, sum);
  }
};

template <class Separation, class Pass>
void for_each_pair(Range range, const VerletList& list, const Separation& separation, const VerletList& wall_list,
                   const Separation& wall_separation, double cutoff, const Pass& pass) {
  const unsigned bits = pass_lane_bits(pass, range);
  const Real range2 = Real(cutoff * cutoff);
  for_each({0, range.size() << bits},
           TwoListLoop<Separation, Pass>{{list.view(), separation, range2},
                                         {wall_list.view(), wall_separation, range2},
                                         pass, range.begin, bits});
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
