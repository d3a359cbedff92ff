#pragma once
// Stored neighbours of each particle: every j within range of i at the time of building.
// Rows are cut into slices that one warp reads: the entries of its 32 lanes stand side by side, those of
// lanes that share a row first, so that loads are coalesced however many lanes a row has. On the CPU a slice
// is one row. The GPU counts, then fills; the CPU joins what blocks of rows found: never too small, never
// padded beyond the longest row of a slice and a turn of its lanes.

#include <algorithm>
#include <vector>

#include "bedload/neighbours/cell_grid.hpp"
#include "bedload/parallel/lanes.hpp"

namespace bedload::inline BL_VARIANT {

/// log2 of the entries that a slice reads in one go.
#if BL_CUDA
constexpr unsigned kSliceBits = 5;
#else
constexpr unsigned kSliceBits = 0;
#endif

struct VerletListView {
  const std::uint64_t* offset = nullptr;  ///< [slices + 1]
  const std::uint32_t* count = nullptr;   ///< [rows]
  const Index* entry = nullptr;
  unsigned bits = 0;  ///< log2 of the lanes that share a row

  BL_HD unsigned row_bits() const { return kSliceBits - bits; }  ///< log2 of the rows of a slice
  /// Where entry k of row i is, also for arrays that go with the entries.
  BL_HD std::uint64_t slot(Index i, std::uint32_t k) const {
    const Index row = i & ((1u << row_bits()) - 1);
    return offset[i >> row_bits()] + (std::uint64_t(k >> bits) << kSliceBits) + (row << bits) +
           (k & ((1u << bits) - 1));
  }
  /// From an entry of a lane to its next. Loops read one turn ahead, so there are two more at the end.
  static constexpr std::uint64_t kTurn = 1u << kSliceBits;
};

class VerletList {
 public:
  Index rows() const { return Index(count_.size()); }
  std::uint64_t slots() const { return slots_; }
  VerletListView view() const { return {offset_.data(), count_.data(), entry_.data(), bits_}; }
  /// To put the entries of a row into another order.
  Index* entries() { return entry_.data(); }

  /// Rows: all of `targets`; entries: sources near them, in the order of the sources' cells.
  /// Near(i, j) says whether to keep a pair; `reach(i)` is how far to look (m). As many lanes are to share a
  /// row as keep the device busy, or 2^bits.
  template <class Near>
  void build(Index rows, const CellGridView& sources, const Near& near) {
    build(rows, sources, near, lane_bits(rows));
  }
  template <class Near>
  void build(Index rows, const CellGridView& sources, const Near& near, unsigned bits);

 private:
  friend struct HostVerletList;
  std::size_t slices() const { return (rows() + (1u << view().row_bits()) - 1) >> view().row_bits(); }

  unsigned bits_ = 0;
  Buffer<std::uint32_t> count_;
  Buffer<std::uint64_t> width_, offset_;
  Buffer<Index> entry_;
  std::uint64_t slots_ = 0;
  Sorter sorter_;
};

#if BL_CUDA
namespace detail {

template <class Near>
struct CountPass {
  CellGridView sources;
  Near near;
  unsigned bits;
  Span<std::uint32_t> count;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, bits);
    const Index i = lane.row;
    std::uint32_t n = 0;
    const auto look = [&](Index j) { n += near(i, j) ? 1u : 0u; };
    const Vec3d place = near.place(i);
    if (sources.any_near(place, near.reach(i)))
      sources.each_near(place, near.reach(i), look, lane.index, lane.count);
    lane.combine(n, [](std::uint32_t& into, std::uint32_t other) { into += other; });
    if (lane.index == 0) count[i] = n;
  }
};

struct WidthPass {
  Span<const std::uint32_t> count;
  VerletListView list;
  Span<std::uint64_t> width;
  BL_HD void operator()(Index s) const {
    std::uint32_t widest = 0;
    const Index end = min_of(count.size, (s + 1) << list.row_bits());
    for (Index i = s << list.row_bits(); i < end; ++i) widest = max_of(widest, count[i]);
    const std::uint64_t turns = (std::uint64_t(widest) + (1u << list.bits) - 1) >> list.bits;
    width[s] = turns << kSliceBits;
  }
};

/// Each lane takes every count-th cell; all lanes test one candidate at a time.
template <class Near>
struct FillPass {
  CellGridView sources;
  Near near;
  unsigned bits;
  VerletListView list;
  Index* entry;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, bits);
    const Index i = lane.row;
    std::uint32_t n = 0;
    if (list.count[i] == 0) return;
    if (lane.count == 1 && list.bits == 0) {
      Index* next = entry + list.slot(i, 0);
      sources.each_near(near.place(i), near.reach(i), [&](Index j) {
        if (near(i, j)) *next = j, next += VerletListView::kTurn;
      });
      return;
    }
    if (lane.count == 1) {
      sources.each_near(near.place(i), near.reach(i), [&](Index j) {
        if (near(i, j)) entry[list.slot(i, n++)] = j;
      });
      return;
    }
    const auto block = sources.block(near.place(i), near.reach(i));
    int q = int(lane.index);
    Index j = 0, end = 0;
    for (;;) {
      while (j == end && q < block.size()) {
        if (block.touches(q)) {
          const std::uint32_t c = sources.key(block, q);
          j = sources.start[c], end = sources.start[c + 1];
        }
        q += int(lane.count);
      }
      const bool some = j < end;
      if (lane.ballot(some) == 0) return;
      const bool keep = some && near(i, j);
      const unsigned kept = lane.ballot(keep);
      if (keep) entry[list.slot(i, n + Lane::bits_in(kept & ((1u << lane.index) - 1)))] = j;
      n += Lane::bits_in(kept);
      j += some;
    }
  }
};

}  // namespace detail
#endif

#if !BL_CUDA
namespace detail {

/// Appends rows to a list: those of a run of particles that are near i.
template <class Near>
class NearSearch {
 public:
  NearSearch(const Near& near, std::vector<Index>& found) : near_(near), found_(found) {}

  std::uint32_t row(Index i, const CellGridView& sources) {
    const std::size_t before = n_;
    if (!sources.any_near(near_.place(i), near_.reach(i))) return 0;
    sources.each_run(near_.place(i), near_.reach(i), [&](Index j, Index end) {
      if (found_.size() < n_ + (end - j)) found_.resize(2 * (n_ + (end - j)));
      Index* out = found_.data() + n_;
      if constexpr (requires { near_.lanes(i, PackRun{j}); })
        for (; j + kLanes <= end; j += kLanes) {
          const PackMask kept = near_.lanes(i, PackRun{j});
          for (int l = 0; l < kLanes; ++l) {
            *out = j + Index(l);
            out += kept.v[l] & 1;
          }
        }
      for (; j < end; ++j) {
        *out = j;
        out += near_(i, j);
      }
      n_ = std::size_t(out - found_.data());
    });
    return std::uint32_t(n_ - before);
  }
  ~NearSearch() { found_.resize(n_); }

 private:
  const Near& near_;
  std::vector<Index>& found_;
  std::size_t n_ = 0;
};

}  // namespace detail
#endif

template <class Near>
void VerletList::build(Index rows, const CellGridView& sources, const Near& near, unsigned bits) {
  count_.resize(rows);
  bits_ = bits;
#if BL_CUDA
  const unsigned search = lane_bits(rows);
  for_each({0, rows << search}, detail::CountPass<Near>{sources, near, search, count_});
  width_.resize(slices());
  for_each({0, Index(slices())}, detail::WidthPass{count_, view(), width_});
  slots_ = sorter_.exclusive_scan(width_, offset_);
  entry_.reserve_and_resize(slots_ + 2 * VerletListView::kTurn);
  for_each({0, rows << search}, detail::FillPass<Near>{sources, near, search, view(), entry_.data()});
#else
  // one search instead of two: blocks of rows grow lists of their own, which are then joined
  static_assert(kSliceBits == 0);
  constexpr Index block = 256;
  const Index blocks = (rows + block - 1) / block;
  const auto end = [&](Index b) { return min_of(rows, (b + 1) * block); };
  std::vector<std::vector<Index>> found(blocks);
#pragma omp parallel for schedule(dynamic, 1)
  for (Index b = 0; b < blocks; ++b) {
    detail::NearSearch<Near> search{near, found[b]};
    for (Index i = b * block; i < end(b); ++i) count_.data()[i] = search.row(i, sources);
  }
  offset_.resize(rows + 1);
  slots_ = 0;
  for (Index i = 0; i <= rows; ++i) {
    offset_.data()[i] = slots_;
    if (i < rows) slots_ += count_.data()[i];
  }
  entry_.reserve_and_resize(slots_ + 2 * VerletListView::kTurn);
#pragma omp parallel for schedule(dynamic, 1)
  for (Index b = 0; b < blocks; ++b) {
    std::copy(found[b].begin(), found[b].end(), entry_.data() + offset_.data()[b * block]);
    std::vector<Index>().swap(found[b]);
  }
#endif
}

/// A list as it stands, on the host.
struct HostVerletList {
  std::vector<std::uint64_t> offset;
  std::vector<std::uint32_t> count;
  std::vector<Index> entry;
  unsigned bits;

  explicit HostVerletList(const VerletList& list)
      : offset(list.slices() + 1), count(list.rows()), entry(list.slots()), bits(list.view().bits) {
    const VerletListView from = list.view();
    copy_to_host(offset.data(), from.offset, offset.size() * sizeof offset[0]);
    copy_to_host(count.data(), from.count, count.size() * sizeof count[0]);
    copy_to_host(entry.data(), from.entry, entry.size() * sizeof entry[0]);
  }
  VerletListView view() const { return {offset.data(), count.data(), entry.data(), bits}; }
};

/// Pairs of SPH particles (fluid or wall) closer than `range`.
template <class PA>
struct SphNear {
  Frame frame;
  Span<const PA> x;  ///< full positions of the targets
  Span<const PairPosition> a, b;
  double range;  ///< m
  bool same;     ///< targets are the sources: a particle is not its own neighbour
  BL_HD Vec3d place(Index i) const { return coordinates(frame, x[i]); }
  BL_HD double reach(Index) const { return range; }
  BL_HD bool operator()(Index i, Index j) const {
    return !(same && i == j) && norm2(frame.separation(a[i], b[j])) < Real(range * range);
  }
#if !BL_CUDA
  PackMask lanes(Index i, PackRun j) const {
    PackMask near = norm2(frame.separation(a[i], b[j])) < Real(range * range);
    if (same && i - j.first < Index(kLanes)) near.v[i - j.first] = 0;
    return near;
  }
#endif
};

/// How far pairs of particles with smoothing lengths of their own are listed: `times` the larger length, and
/// `beyond`.
struct PairReach {
  Real times, beyond, other;  ///< -, m; length of what has none, m
};

/// SphNear among such particles; it looks as far as the largest of them reaches.
template <class PA>
struct LengthNear {
  SphNear<PA> near;
  PairReach reaches;
  Span<const Real> h_a, h_b;  ///< m; empty for what has none
  BL_HD Vec3d place(Index i) const { return near.place(i); }
  BL_HD double reach(Index i) const { return near.reach(i); }
  BL_HD bool operator()(Index i, Index j) const {
    const Real h = max_of(own(i), h_b ? h_b[j] : reaches.other), r = reaches.times * h + reaches.beyond;
    return !(near.same && i == j) && norm2(near.frame.separation(near.a[i], near.b[j])) < r * r;
  }
#if !BL_CUDA
  PackMask lanes(Index i, PackRun j) const {
    const Pack h = max_of(Pack(own(i)), h_b ? Pack(h_b[j]) : Pack(reaches.other));
    const Pack r = Pack(reaches.times) * h + Pack(reaches.beyond);
    PackMask listed = norm2(near.frame.separation(near.a[i], near.b[j])) < r * r;
    if (near.same && i - j.first < Index(kLanes)) listed.v[i - j.first] = 0;
    return listed;
  }
#endif

 private:
  BL_HD Real own(Index i) const { return h_a ? h_a[i] : reaches.other; }
};

/// SphNear among positions that are sheared back by `strain` (MeanShear), by true distances.
template <class PA>
struct ShearedNear {
  SphNear<PA> near;
  Real strain;
  double longest;  ///< that near.range may be among such positions, m
  BL_HD Vec3d place(Index i) const { return near.place(i); }
  BL_HD double reach(Index) const { return longest; }
  BL_HD bool operator()(Index i, Index j) const {
    return !(near.same && i == j) && distance2(i, near.b[j]) < Real(near.range * near.range);
  }
#if !BL_CUDA
  PackMask lanes(Index i, PackRun j) const {
    PackMask listed = distance2(i, near.b[j]) < Real(near.range * near.range);
    if (near.same && i - j.first < Index(kLanes)) listed.v[i - j.first] = 0;
    return listed;
  }
#endif

 private:
  template <class Source>
  BL_HD auto distance2(Index i, const Source& source) const {
    auto r = near.frame.separation(near.a[i], source);
    r.x += strain * r.z;
    return norm2(r);
  }
};

/// Pairs across the phases closer than `range`, in fp64.
template <class PA, class PB>
struct CrossNear {
  Frame frame;
  Span<const PA> a;
  Span<const PB> b;
  double range;  ///< m
  BL_HD Vec3d place(Index i) const { return coordinates(frame, a[i]); }
  BL_HD double reach(Index) const { return range; }
  BL_HD bool operator()(Index i, Index j) const {
    return norm2(frame.separation(coordinates(frame, a[i]), coordinates(frame, b[j]))) < range * range;
  }
};

}  // namespace bedload::inline BL_VARIANT
