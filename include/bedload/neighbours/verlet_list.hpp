#pragma once
// Stored neighbours of each particle: every j within range of i at the time of building.
// Rows are cut into slices that one warp reads: the entries of its 32 lanes stand side by side, those of
// lanes that share a row first, so that loads are coalesced however many lanes a row has. On the CPU a slice
// is one row. On the GPU slices take places as they are found, on the CPU what blocks of rows found is
// joined: never too small, never padded beyond the longest row of a slice and a turn of its lanes.

#include <algorithm>
#include <vector>

#include "bedload/neighbours/cell_grid.hpp"
#include "bedload/neighbours/half_skins.hpp"
#include "bedload/parallel/lanes.hpp"

namespace bedload::inline BL_VARIANT {

/// log2 of the entries that a slice reads in one go.
#if BL_CUDA
constexpr unsigned kSliceBits = 5;
#else
constexpr unsigned kSliceBits = 0;
#endif

struct VerletListView {
  const std::uint64_t* offset = nullptr;  ///< [slices] in any order
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
  Buffer<std::uint64_t> offset_;
  Buffer<std::uint64_t> taken_;  ///< slots, while slices are searched for
  Buffer<Index> entry_;
  std::uint64_t slots_ = 0;
};

#if BL_CUDA
namespace detail {

/// A warp searches for a slice. What it finds stands in shared memory in the order of the slice until it is
/// known how long that is; then the slice takes the next place in the list. A slice too long for that is
/// searched for once more.
template <class Near>
struct SliceSearch {
  static constexpr Index kThreads = 128, kTurns = 64;  ///< of a block; of a slice in shared memory

  CellGridView sources;
  Near near;
  VerletListView list;
  Index rows;
  std::uint64_t room;  ///< entries
  std::uint32_t* count;
  std::uint64_t *offset, *slots;  ///< slots: taken by all slices
  Index* entry;

  __device__ void operator()() const {
    __shared__ Index found[kThreads * kTurns];
    const Index thread = blockIdx.x * kThreads + threadIdx.x, in_warp = threadIdx.x % 32;
    const Lane lane(thread, list.bits);
    Index* const own = found + (threadIdx.x - in_warp) * kTurns;
    const std::uint32_t n = lane.row < rows ? search(lane, own, kTurns) : 0;
    std::uint32_t turns = (n + lane.count - 1) >> list.bits;
    for (unsigned step = 1; step < 32; step *= 2)
      turns = max_of(turns, __shfl_xor_sync(0xffffffffu, turns, step));
    unsigned long long first = 0;
    if (in_warp == 0) {
      first = atomicAdd(reinterpret_cast<unsigned long long*>(slots), turns * VerletListView::kTurn);
      if (lane.row < rows) offset[thread / 32] = first;
    }
    __syncwarp(), first = __shfl_sync(0xffffffffu, first, 0);  // all see what all have found
    if (lane.row >= rows) return;
    if (lane.index == 0) count[lane.row] = n;
    if (first + turns * VerletListView::kTurn > room) return;  // to be done again with more
    if (turns > kTurns) {
      search(lane, entry + first, turns);
      return;
    }
    for (std::uint32_t k = lane.index, turn = 0; k < n; k += lane.count, ++turn)
      entry[first + turn * VerletListView::kTurn + in_warp] = own[turn * VerletListView::kTurn + in_warp];
  }

 private:
  /// Writes the first `turns` turns of a row to its lanes of a slice; how many entries there are.
  __device__ std::uint32_t search(const Lane& lane, Index* slice, std::uint32_t turns) const {
    const Index i = lane.row;
    const Vec3d place = near.place(i);
    const double reach = near.reach(i);
    if (!sources.any_near(place, reach)) return 0;
    slice += threadIdx.x % 32 - lane.index;
    std::uint32_t n = 0;
    const auto keep = [&](std::uint32_t k, Index j) {
      if (k >> list.bits < turns)
        slice[(k >> list.bits) * VerletListView::kTurn + (k & (lane.count - 1))] = j;
    };
    if (lane.count == 1) {
      sources.each_run(place, reach, [&](Index begin, Index end) {
        for (; begin < end; begin += 32) {
          unsigned hits = 0;
          const Index some = min_of(32u, end - begin);
          for (Index b = 0; b < some; ++b) hits |= unsigned(near(i, begin + b)) << b;
          for (; hits != 0; hits &= hits - 1) keep(n++, begin + Index(__ffs(int(hits)) - 1));
        }
      });
      return n;
    }
    // each lane takes every count-th cell; all test one candidate at a time
    const auto block = sources.block(place, reach);
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
      if (lane.ballot(some) == 0) return n;
      const bool hit = some && near(i, j);
      const unsigned kept = lane.ballot(hit);
      if (hit) keep(n + Lane::bits_in(kept & ((1u << lane.index) - 1)), j);
      n += Lane::bits_in(kept);
      j += some;
    }
  }
};

template <class Search>
__global__ void __launch_bounds__(Search::kThreads) slice_search(Search search) {
  search();
}

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
  offset_.resize(slices());
  slots_ = 0;
  if (rows == 0) return;
  taken_.resize(1);
  using Search = detail::SliceSearch<Near>;
  const Index blocks = Index((slices() * 32 + Search::kThreads - 1) / Search::kThreads);
  constexpr std::uint64_t beyond = 2 * VerletListView::kTurn;
  for (;;) {
    const std::uint64_t room = entry_.size() > beyond ? entry_.size() - beyond : 0;
    taken_.zero();
    detail::slice_search<<<blocks, Search::kThreads>>>(Search{
        sources, near, view(), rows, room, count_.data(), offset_.data(), taken_.data(), entry_.data()});
    check_cuda(cudaGetLastError(), "search for neighbours");
    slots_ = taken_.to_host()[0];
    if (slots_ <= room) return;
    entry_.resize(slots_ + slots_ / 32 + beyond);
  }
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
  offset_.resize(rows);
  slots_ = 0;
  for (Index i = 0; i < rows; ++i) {
    offset_.data()[i] = slots_;
    slots_ += count_.data()[i];
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
      : offset(list.slices()), count(list.rows()), entry(list.slots()), bits(list.view().bits) {
    const VerletListView from = list.view();
    copy_to_host(offset.data(), from.offset, offset.size() * sizeof offset[0]);
    copy_to_host(count.data(), from.count, count.size() * sizeof count[0]);
    copy_to_host(entry.data(), from.entry, entry.size() * sizeof entry[0]);
  }
  VerletListView view() const { return {offset.data(), count.data(), entry.data(), bits}; }
};

/// Pairs of SPH particles (fluid or wall) closer than `range` and their half skins.
template <class PA>
struct SphNear {
  Frame frame;
  Span<const PA> x;  ///< full positions of the targets
  Span<const PairPosition> a, b;
  double range;  ///< m
  bool same;     ///< targets are the sources: a particle is not its own neighbour
  HalfSkins skin_a = {}, skin_b = {};
  BL_HD Vec3d place(Index i) const { return coordinates(frame, x[i]); }
  BL_HD double reach(Index i) const { return range + skin_a[i] + skin_b.most; }
  BL_HD bool operator()(Index i, Index j) const {
    return !(same && i == j) &&
           norm2(frame.separation(a[i], b[j])) < square(Real(range) + skin_a[i] + skin_b[j]);
  }
#if !BL_CUDA
  PackMask lanes(Index i, PackRun j) const {
    PackMask near = norm2(frame.separation(a[i], b[j])) < square(Pack(Real(range) + skin_a[i]) + skin_b[j]);
    if (same && i - j.first < Index(kLanes)) near.v[i - j.first] = 0;
    return near;
  }
#endif
};

/// The range of pairs of particles with smoothing lengths of their own: `times` the larger length.
struct PairReach {
  Real times, other;  ///< -; length of what has none, m
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
    const Real h = max_of(own(i), h_b ? h_b[j] : reaches.other),
               r = reaches.times * h + near.skin_a[i] + near.skin_b[j];
    return !(near.same && i == j) && norm2(near.frame.separation(near.a[i], near.b[j])) < r * r;
  }
#if !BL_CUDA
  PackMask lanes(Index i, PackRun j) const {
    const Pack h = max_of(Pack(own(i)), h_b ? Pack(h_b[j]) : Pack(reaches.other));
    const Pack r = Pack(reaches.times) * h + Pack(near.skin_a[i]) + near.skin_b[j];
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
