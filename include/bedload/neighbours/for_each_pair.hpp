#pragma once
// Runs a pass over the pairs of a list or, list-free, over the cells. A pass has
//   Sum start(i); auto sources(); void pair(Sum&, r_ij, r2, weight, ...); void finish(i, Sum);
// and knows nothing of where its neighbours come from: `sources` lists what it reads of each, in the order in
// which `pair` takes it after the weight that comes with a position; what of its own row `pair` needs is in
// the Sum. What it reads in some cases alone is there in all of them, in the others as an Unread (`read_if`)
// or, where only the case decides, as a value in its place (`read_where`). A pass that also runs
// over a second list has
//   auto wall_sources(); void wall_pair(Sum&, r_ij, r2, ...);
// for that. Where a pass can also
//   void merge(Sum& into, const Sum& other);
// two partial sums of one row, several GPU lanes share a row of a small system. Where its Sum is a template
//   template <class N = Real> struct Sum;
// of nothing but N, `pair` must add nothing at and beyond the cut-off, nor for what has no weight: all listed
// pairs are taken, on the CPU in packs.

#include <utility>

#include "bedload/neighbours/verlet_list.hpp"
#include "bedload/parallel/lanes.hpp"

namespace BL_SOLVER {

/// A copy of positions as pair loops read them.
template <class P>
struct PackPass {
  Frame frame;
  Span<const P> x;
  Span<PairPosition> xp;
  BL_HD void operator()(Index i) const { xp[i] = pair_position(frame, coordinates(frame, x[i])); }
};

/// r_i - r_j, nearest image.
struct PairSeparation {
  Frame frame;
  Span<const PairPosition> a, b;
  template <class Source>
  BL_HD auto operator()(Index i, const Source& source) const {
    return frame.separation(a[i], source);
  }
};

/// In place of a field that a pass does not read, and of its values.
struct Unread {};
/// A field that a pass reads in some cases alone.
template <bool kReads, class T>
BL_HD auto read_if(Span<T> field) {
  if constexpr (kReads)
    return field;
  else
    return Unread{};
}

/// A field that a pass reads of neighbours in some runs alone, and the value used in the others.
/// Tiles stage none: it is for the rows of Verlet lists.
template <class T>
struct ReadWhere {
  bool reads;
  Span<const T> field;
  T otherwise;
};
template <class T>
BL_HD ReadWhere<T> read_where(bool reads, Span<const T> field, const T& otherwise = {}) {
  return {reads, field, otherwise};
}

/// Of the neighbour j.
template <class T, class J>
BL_HD auto value_of(const Span<T>& field, J j) {
  return field[j];
}
template <class J>
BL_HD Unread value_of(Unread, J) {
  return {};
}
template <class T, class J>
BL_HD auto value_of(const ReadWhere<T>& field, J j) {
  using Value = decltype(value_of(field.field, j));
  return field.reads ? field.field[j] : Value(field.otherwise);
}

/// The k-th of the fields that a pass reads of a neighbour.
template <std::size_t k, class Field>
struct SourceField {
  Field field;
};
template <class Places, class... Field>
struct SourceFields;
template <std::size_t... k, class... Field>
struct SourceFields<std::index_sequence<k...>, Field...> : SourceField<k, Field>... {
  /// f(value of each field)
  template <class J, class F>
  BL_HD void load([[maybe_unused]] J j, F&& f) const {
    f(value_of(SourceField<k, Field>::field, j)...);
  }
};
/// What a pass reads of a neighbour: one of each field.
template <class... Field>
using Sources = SourceFields<std::index_sequence_for<Field...>, Field...>;

/// Fields: spans, or what read_if and read_where make of them.
template <class... Field>
BL_HD Sources<Field...> sources_of(const Field&... field) {
  return {{field}...};
}

template <class Pass, class Sum, class J, class R, class N>
BL_HD void add_pair(const Pass& pass, Sum& sum, const J& j, const R& r, const N& r2, const N& weight) {
  pass.sources().load(j, [&](const auto&... of_j) BL_INLINE { pass.pair(sum, r, r2, weight, of_j...); });
}

/// Of the second of two lists.
template <class Pass, class Sum, class J, class R, class N>
BL_HD void add_wall_pair(const Pass& pass, Sum& sum, const J& j, const R& r, const N& r2) {
  pass.wall_sources().load(j, [&](const auto&... of_j) BL_INLINE { pass.wall_pair(sum, r, r2, of_j...); });
}

/// A pass of which several lanes can share a row.
template <class Pass>
concept Mergeable = requires(const Pass& pass, decltype(std::declval<const Pass&>().start(Index()))& sum) {
  pass.merge(sum, sum);
};

/// A pass to which a pair at or beyond the cut-off adds nothing.
template <class Pass>
constexpr bool kFades = requires {
  typename Pass::template Sum<Real>;
};

/// A pass of few registers, which can wait for what it reads of two neighbours at a time.
template <class Pass>
constexpr bool kSideBySide = requires {
  Pass::kSideBySide;
};

template <class Pass>
unsigned pass_lane_bits(const Pass&, const VerletList& list) {
  return Mergeable<Pass> ? list.view().bits : 0;
}

#if BL_CUDA
template <class Pass>
constexpr bool kInPacks = false;
#else
template <class Pass>
constexpr bool kInPacks = kFades<Pass>;

/// Partial sums of one row, one for each lane of a pack. Fields are taken one by one, so that they can stay
/// in registers.
template <class Pass>
class LaneSums {
 public:
  using One = typename Pass::template Sum<Real>;
  using All = typename Pass::template Sum<Pack>;
  static_assert(sizeof(All) == kLanes * sizeof(One), "the sums of a pass in packs hold nothing but N");

  [[gnu::always_inline]] static All spread(const One& sum) { return spread(sum, Fields()); }
  [[gnu::always_inline]] static One total(const Pass& pass, const All& all) {
    One sum = lane(all, 0, Fields());
    for (int l = 1; l < kLanes; ++l) pass.merge(sum, lane(all, l, Fields()));
    return sum;
  }

 private:
  using Fields = std::make_index_sequence<sizeof(One) / sizeof(Real)>;
  using Field [[gnu::may_alias]] = Real;
  using PackedField [[gnu::may_alias]] = Pack::Native;

  template <std::size_t... k>
  [[gnu::always_inline]] static All spread(const One& sum, std::index_sequence<k...>) {
    All all;
    ((reinterpret_cast<PackedField*>(&all)[k] = Pack(reinterpret_cast<const Field*>(&sum)[k]).v), ...);
    return all;
  }
  template <std::size_t... k>
  [[gnu::always_inline]] static One lane(const All& all, int l, std::index_sequence<k...>) {
    One sum;
    ((reinterpret_cast<Field*>(&sum)[k] = reinterpret_cast<const PackedField*>(&all)[k][l]), ...);
    return sum;
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

/// One lane's part of the pairs of row i that are closer than the cut-off now; of a pass that fades all
/// listed pairs, in packs on the CPU.
template <class Separation, class Pass>
struct ListRow {
  VerletListView list;
  Separation separation;
  Real range2;
  template <class F>
  BL_HD void operator()(Index i, const Lane& lane, F&& f) const {
    if constexpr (kInPacks<Pass>) {
      in_packs(i, list.entry + list.slot(i, 0), int(list.count[i]), f);
    } else {
      const std::uint32_t n = list.count[i];
      if constexpr (Mergeable<Pass>) {  // the list was built for as many lanes
        const Index* entry = list.entry + list.slot(i, lane.index);
        std::uint32_t k = lane.index;
        if constexpr (kSideBySide<Pass>)
          for (; k + lane.count < n; k += 2 * lane.count, entry += 2 * VerletListView::kTurn) {
            const Index j[2] = {entry[0], entry[VerletListView::kTurn]};
            visit(i, j[0], f);
            visit(i, j[1], f);
          }
        Index next = *entry;
        for (; k < n; k += lane.count) {
          const Index j = next;
          entry += VerletListView::kTurn;
          next = *entry;  // while this pair is worked on; after the last row there is space for it
          visit(i, j, f);
        }
      } else {
        for (std::uint32_t k = 0; k < n; ++k) visit(i, list.entry[list.slot(i, k)], f);
      }
    }
  }
  /// The same of entries begin..end of row i.
  template <class F>
  BL_HD void part(Index i, std::uint32_t begin, std::uint32_t end, const Lane& lane, F&& f) const {
    if constexpr (kInPacks<Pass>)
      in_packs(i, list.entry + list.slot(i, begin), int(end - begin), f);
    else
      for (std::uint32_t k = begin + lane.index; k < end; k += lane.count)
        visit(i, list.entry[list.slot(i, k)], f);
  }

 private:
  template <class F>
  BL_HD void visit(Index i, Index j, F& f) const {
    const auto source = separation.b[j];
    const Real3 r = separation(i, source);
    const Real r2 = norm2(r);
    if (kFades<Pass> || r2 < range2) f(j, r, r2, Real(source.weight));
  }
#if !BL_CUDA
  // One call of f for whole packs and the rest: f is long, and inlined.
  template <class F>
  [[gnu::always_inline]] void in_packs(Index i, const Index* entry, int left, F& f) const {
    Index rest[kLanes];
    for (; left > 0; left -= kLanes, entry += kLanes) {
      Pack away{};
      if (left < kLanes) {  // lanes without an entry repeat the last one, out of reach
        for (int l = 0; l < kLanes; ++l) {
          rest[l] = entry[l < left ? l : left - 1];
          if (l >= left) away.v[l] = 100 * std::sqrt(range2);
        }
        entry = rest;
      }
      const PackIndex j{entry};
      const auto sources = separation.b[j];
      auto r = separation(i, sources);
      r.x += away;
      f(j, r, norm2(r), sources.weight);
    }
  }
#endif
};

/// What all lanes of a row have summed: a pass without `merge` has one lane.
template <class Pass, class Sum>
BL_HD decltype(auto) sum_of_row(const Pass& pass, const Lane& lane, Sum& sum) {
#if !BL_CUDA
  if constexpr (kInPacks<Pass>) {
    return LaneSums<Pass>::total(pass, sum);
  } else
#endif
  {
    if constexpr (Mergeable<Pass>)
      lane.combine(sum, [&](Sum& into, const Sum& other) { pass.merge(into, other); });
    return (sum);
  }
}

template <class Pass, class Sum>
BL_HD void finish_row(const Pass& pass, Index i, const Lane& lane, Sum& sum) {
  const auto& all = sum_of_row(pass, lane, sum);
  if (lane.index == 0) pass.finish(i, all);
}

template <class Separation, class Pass>
struct ListLoop {
  ListRow<Separation, Pass> row;
  Pass pass;
  Index begin;
  Span<const Index> rows;  ///< empty: all from `begin` on
  unsigned bits;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, bits);
    const Index i = rows ? rows[lane.row] : begin + lane.row;
    auto sum = start_row(pass, i);
    row(i, lane, [&](auto j, const auto& r, auto r2, auto weight) BL_INLINE {
      add_pair(pass, sum, j, r, r2, weight);
    });
    finish_row(pass, i, lane, sum);
  }
};

/// The pairs of `list` that are closer than `cutoff` (m) now.
template <class Separation, class Pass>
void for_each_pair(Range range, const VerletList& list, const Separation& separation, double cutoff,
                   const Pass& pass) {
  const unsigned bits = pass_lane_bits(pass, list);
  for_each({0, range.size() << bits},
           ListLoop<Separation, Pass>{
               {list.view(), separation, Real(cutoff * cutoff)}, pass, range.begin, {}, bits});
}

/// The same of some rows alone.
template <class Separation, class Pass>
void for_each_pair_of(Span<const Index> rows, const VerletList& list, const Separation& separation,
                      double cutoff, const Pass& pass) {
  const unsigned bits = pass_lane_bits(pass, list);
  for_each({0, rows.size << bits},
           ListLoop<Separation, Pass>{{list.view(), separation, Real(cutoff * cutoff)}, pass, 0, rows, bits});
}

/// A pass over two lists in one go: `pair` for the first, `wall_pair` for the second.
template <class Separation, class Pass>
struct TwoListLoop {
  ListRow<Separation, Pass> row, wall_row;
  Pass pass;
  Index begin;
  unsigned bits;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, bits);
    const Index i = begin + lane.row;
    auto sum = start_row(pass, i);
    row(i, lane, [&](auto j, const auto& r, auto r2, auto weight) BL_INLINE {
      add_pair(pass, sum, j, r, r2, weight);
    });
    wall_row(i, lane,
             [&](auto j, const auto& r, auto r2, auto) BL_INLINE { add_wall_pair(pass, sum, j, r, r2); });
    finish_row(pass, i, lane, sum);
  }
};

template <class Separation, class Pass>
void for_each_pair(Range range, const VerletList& list, const Separation& separation, double cutoff,
                   const Pass& pass, const ListRow<Separation, Pass>& wall_row) {
  const unsigned bits = pass_lane_bits(pass, list);
  for_each({0, range.size() << bits},
           TwoListLoop<Separation, Pass>{
               {list.view(), separation, Real(cutoff * cutoff)}, wall_row, pass, range.begin, bits});
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
      const auto source = separation.b[j];
      const Real3 r = separation(i, source);
      const Real r2 = norm2(r);
      if (r2 < range2) add_pair(pass, sum, j, r, r2, Real(source.weight));
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

}  // namespace BL_SOLVER
