#pragma once
// Runs a pass over the pairs of a Verlet list or, list-free, over the cells. A pass has
//   Sum start(i); void pair(Sum&, i, j, r_ij, r2); void finish(i, Sum);
// and knows nothing of where its neighbours come from. Where it can also
//   void merge(Sum& into, const Sum& other);
// two partial sums of one row, several GPU lanes share a row of a small system. Where its Sum is a template
//   template <class N = Real> struct Sum;
// of nothing but N, and `pair` adds nothing at and beyond the cut-off, the CPU takes pairs in packs.

#include <cstring>
#include <iterator>
#include <utility>

#include "bedload/neighbours/verlet_list.hpp"
#include "bedload/parallel/lanes.hpp"

namespace bedload::inline BL_VARIANT {

/// A copy of positions as pair loops read them.
template <class P>
struct PackPass {
  Frame frame;
  Span<const P> x;
  Span<PairPosition> xp;
  BL_HD void operator()(Index i) const { xp[i] = as_position<PairPosition>(frame, coordinates(frame, x[i])); }
};

/// r_i - r_j, nearest image.
struct PairSeparation {
  Frame frame;
  Span<const PairPosition> a, b;
  template <class J>
  BL_HD auto operator()(Index i, J j) const {
    return frame.separation(a[i], b[j]);
  }
};

template <class Pass, class Sum>
concept Mergeable = requires(const Pass& pass, Sum& into, const Sum& other) {
  pass.merge(into, other);
};

template <class Pass>
unsigned pass_lane_bits(const Pass&, const VerletList& list) {
  using Sum = decltype(std::declval<const Pass&>().start(Index()));
  return Mergeable<Pass, Sum> ? list.view().bits : 0;
}

#if BL_CUDA
template <class Pass>
constexpr bool kInPacks = false;
#else
template <class Pass>
constexpr bool kInPacks = requires {
  typename Pass::template Sum<Pack>;
};

/// Partial sums of one row, one for each lane of a pack.
template <class Pass>
struct LaneSums {
  using One = typename Pass::template Sum<Real>;
  using All = typename Pass::template Sum<Pack>;
  static_assert(sizeof(All) == kLanes * sizeof(One), "the sums of a pass in packs hold nothing but N");

  static All spread(const One& sum) {
    Real field[sizeof(One) / sizeof(Real)];
    Pack fields[sizeof(One) / sizeof(Real)];
    std::memcpy(field, &sum, sizeof(One));
    for (std::size_t k = 0; k < std::size(field); ++k) fields[k] = Pack(field[k]);
    All all;
    std::memcpy(&all, fields, sizeof(All));
    return all;
  }
  static One total(const Pass& pass, const All& all) {
    Real fields[sizeof(One) / sizeof(Real)][kLanes];
    std::memcpy(fields, &all, sizeof(All));
    One sum[kLanes];
    for (int l = 0; l < kLanes; ++l) {
      Real field[std::size(fields)];
      for (std::size_t k = 0; k < std::size(fields); ++k) field[k] = fields[k][l];
      std::memcpy(&sum[l], field, sizeof(One));
    }
    for (int l = 1; l < kLanes; ++l) pass.merge(sum[0], sum[l]);
    return sum[0];
  }
};
#endif

template <class Pass>
BL_HD auto start_row(const Pass& pass, Index i) {
#if !BL_CUDA
  if constexpr (kInPacks<Pass>)
    return LaneSums<Pass>::spread(pass.start(i));
  else
#endif
    return pass.start(i);
}

/// One lane's share of the pairs of row i that are closer than the cut-off now; in packs, all listed pairs.
template <class Separation, bool InPacks>
struct ListRow {
  VerletListView list;
  Separation separation;
  Real range2;
  template <class F>
  BL_HD void operator()(Index i, const Lane& lane, F&& f) const {
    if constexpr (InPacks) {
      in_packs(i, f);
    } else {
      const std::uint32_t n = list.count[i];
      const bool turns = lane.count == 1u << list.bits;  // the list was built for as many lanes
      std::uint64_t slot = list.slot(i, lane.index);
      for (std::uint32_t k = lane.index; k < n; k += lane.count) {
        const Index j = list.entry[slot];
        slot = turns ? slot + VerletListView::kTurn : list.slot(i, k + lane.count);
        const Real3 r = separation(i, j);
        const Real r2 = norm2(r);
        if (r2 < range2) f(j, r, r2);
      }
    }
  }

 private:
#if !BL_CUDA
  template <class F>
  void in_packs(Index i, F& f) const {
    const Index* entry = list.entry + list.slot(i, 0);
    int left = int(list.count[i]);
    for (; left >= kLanes; left -= kLanes, entry += kLanes) {
      const PackIndex j{entry};
      const auto r = separation(i, j);
      f(j, r, norm2(r));
    }
    if (left == 0) return;
    // lanes without an entry repeat the last one, out of reach
    Index rest[kLanes];
    Pack away{};
    for (int l = 0; l < kLanes; ++l) {
      rest[l] = entry[l < left ? l : left - 1];
      if (l >= left) away.v[l] = 100 * std::sqrt(range2);
    }
    const PackIndex j{rest};
    auto r = separation(i, j);
    r.x += away;
    f(j, r, norm2(r));
  }
#endif
};

/// Ends a row: a pass without `merge` has one lane.
template <class Pass, class Sum>
BL_HD void finish_row(const Pass& pass, Index i, const Lane& lane, Sum& sum) {
#if !BL_CUDA
  if constexpr (kInPacks<Pass>) {
    pass.finish(i, LaneSums<Pass>::total(pass, sum));
    return;
  } else
#endif
  {
    if constexpr (Mergeable<Pass, Sum>)
      lane.combine(sum, [&](Sum& into, const Sum& other) { pass.merge(into, other); });
    if (lane.index == 0) pass.finish(i, sum);
  }
}

template <class Separation, class Pass>
struct ListLoop {
  ListRow<Separation, kInPacks<Pass>> row;
  Pass pass;
  Index begin;
  unsigned bits;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, bits);
    const Index i = begin + lane.row;
    auto sum = start_row(pass, i);
    row(i, lane, [&](auto j, const auto& r, auto r2) { pass.pair(sum, i, j, r, r2); });
    finish_row(pass, i, lane, sum);
  }
};

/// The pairs of `list` that are closer than `cutoff` (m) now.
template <class Separation, class Pass>
void for_each_pair(Range range, const VerletList& list, const Separation& separation, double cutoff,
                   const Pass& pass) {
  const unsigned bits = pass_lane_bits(pass, list);
  for_each(
      {0, range.size() << bits},
      ListLoop<Separation, Pass>{{list.view(), separation, Real(cutoff * cutoff)}, pass, range.begin, bits});
}

/// A pass over two lists in one go: `pair` for the first, `wall_pair` for the second.
template <class Separation, class Pass>
struct TwoListLoop {
  ListRow<Separation, kInPacks<Pass>> row, wall_row;
  Pass pass;
  Index begin;
  unsigned bits;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, bits);
    const Index i = begin + lane.row;
    auto sum = start_row(pass, i);
    row(i, lane, [&](auto j, const auto& r, auto r2) { pass.pair(sum, i, j, r, r2); });
    wall_row(i, lane, [&](auto j, const auto& r, auto r2) { pass.wall_pair(sum, i, j, r, r2); });
    finish_row(pass, i, lane, sum);
  }
};

template <class Separation, class Pass>
void for_each_pair(Range range, const VerletList& list, const Separation& separation,
                   const VerletList& wall_list, const Separation& wall_separation, double cutoff,
                   const Pass& pass) {
  const unsigned bits = pass_lane_bits(pass, list);
  const Real range2 = Real(cutoff * cutoff);
  for_each({0, range.size() << bits},
           TwoListLoop<Separation, Pass>{{list.view(), separation, range2},
                                         {wall_list.view(), wall_separation, range2},
                                         pass,
                                         range.begin,
                                         bits});
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
