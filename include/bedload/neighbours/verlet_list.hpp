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

namespace BL_SOLVER {

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

  /// f(slot, j) for each entry of row i.
  template <class F>
  BL_HD void each(Index i, F&& f) const {
    for (std::uint32_t k = 0; k < count[i]; ++k) f(slot(i, k), entry[slot(i, k)]);
  }
  /// The same for those entries that are a lane's; the next one is read while f works on one.
  template <class F>
  BL_HD void each(const Lane& lane, F&& f) const {
    const std::uint32_t n = count[lane.row];
    std::uint64_t at = slot(lane.row, lane.index);
    Index next = entry[at];
    for (std::uint32_t k = lane.index; k < n; k += lane.count) {
      const Index j = next;
      next = entry[at + kTurn];
      f(at, j);
      at += kTurn;
    }
  }
};

class VerletList {
 public:
  Index rows() const { return Index(count_.size()); }
  std::uint64_t slots() const { return slots_; }
  VerletListView view() const { return {offset_.data(), count_.data(), entry_.data(), bits_}; }
  std::size_t bytes() const { return entry_.size() * sizeof(Index); }  ///< that entries take
  /// To put the entries of a row into another order.
  Index* entries() { return entry_.data(); }

  /// Rows: all of `targets`; entries: sources near them, in the order of the sources' cells.
  /// Near(i, j) decides whether to keep a pair; `reach(i)` is how far to look (m). As many lanes are to share
  /// a row as keep the device busy, or 2^bits.
  template <class Near>
  void build(Index rows, const CellGridView& sources, const Near& near) {
    build(rows, sources, near, lane_bits(rows));
  }
  template <class Near>
  void build(Index rows, const CellGridView& sources, const Near& near, unsigned bits);
  /// Rows of these lengths, to be filled in by slot; 2^bits lanes share one.
  void make_rows(const Buffer<std::uint32_t>& lengths, unsigned bits);

 private:
  friend struct HostVerletList;
  /// Slots that there is memory for, without those that loops read at the end.
  std::uint64_t room() const { return entry_.size() > kBeyond ? entry_.size() - kBeyond : 0; }
  /// And for a few more, so that a list that grows slowly seldom moves.
  void make_room(std::uint64_t slots) { entry_.resize(slots + slots / 32 + kBeyond); }
  static constexpr std::uint64_t kBeyond = 2 * VerletListView::kTurn;
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

/// A warp searches for a slice, row after row. What it finds stands in shared memory in the order of the
/// slice until it is known how long that is; then the slice takes the next place in the list. A slice too
/// long for that is searched for once more.
template <class Near>
struct SliceSearch {
  static constexpr Index kThreads = 128, kTurns = 64;          // of a block; of a slice in shared memory
  static constexpr Index kStride = VerletListView::kTurn + 1;  // so that a row lies in many banks
  static constexpr unsigned kAll = 0xffffffffu;

  CellGridView sources;
  Near near;
  VerletListView list;
  Index rows;
  std::uint64_t room;  ///< entries
  std::uint32_t* count;
  std::uint64_t *offset, *slots;  ///< slots: taken by all slices
  Index* entry;

  __device__ void operator()() const {
    __shared__ Index found[kThreads / 32][kTurns * kStride];
    const Index slice = (blockIdx.x * kThreads + threadIdx.x) / 32, lane = threadIdx.x % 32;
    const Index begin = slice << list.row_bits();
    if (begin >= rows) return;
    const Index row = begin + lane, end = min_of(rows, begin + (1u << list.row_bits()));
    const bool some = row < end && sources.any_near(near.place(row), near.reach(row));
    Index* const own = found[threadIdx.x / 32];
    const auto fill = [&](Index* out, Index stride, std::uint32_t most) {
      std::uint32_t n = 0;  // of the lane's row
      for (unsigned left = __ballot_sync(kAll, some); left != 0; left &= left - 1) {
        const Index r = Index(__ffs(int(left)) - 1), column = r << list.bits;
        const std::uint32_t of_row = search(begin + r, lane, [&](std::uint32_t k, Index j) {
          const std::uint32_t turn = k >> list.bits;
          if (turn < most) out[std::size_t(turn) * stride + column + (k & ((1u << list.bits) - 1))] = j;
        });
        if (lane == r) n = of_row;
      }
      return n;
    };
    const std::uint32_t n = fill(own, kStride, kTurns);
    std::uint32_t turns = (n + (1u << list.bits) - 1) >> list.bits;
    for (unsigned step = 1; step < 32; step *= 2) turns = max_of(turns, __shfl_xor_sync(kAll, turns, step));
    unsigned long long first = 0;
    if (lane == 0) {
      first = atomicAdd(reinterpret_cast<unsigned long long*>(slots), turns * VerletListView::kTurn);
      offset[slice] = first;
    }
    first = __shfl_sync(kAll, first, 0);
    if (row < end) count[row] = n;
    if (first + turns * VerletListView::kTurn > room) return;  // to be done again with more
    if (turns > kTurns) {
      fill(entry + first, VerletListView::kTurn, turns);
      return;
    }
    __syncwarp();  // all see what all have found
    const std::uint32_t of_column = __shfl_sync(kAll, n, int(lane >> list.bits));
    const std::uint32_t k = lane & ((1u << list.bits) - 1);
    for (std::uint32_t turn = 0; (turn << list.bits) + k < of_column; ++turn)
      entry[first + turn * VerletListView::kTurn + lane] = own[turn * kStride + lane];
  }

 private:
  /// keep(k, j) for each j near i, in the order of their cells, k = 0, 1, ...; how many there are. Lanes look
  /// up cells side by side and then test what is in these, one particle each.
  template <class F>
  __device__ std::uint32_t search(Index i, Index lane, const F& keep) const {
    const auto block = sources.block(near.place(i), near.reach(i));
    std::uint32_t n = 0;
    for (int q = 0; q < block.size(); q += 32) {
      Index end = 0, upto = 0;  // of the lane's cell; particles in the cells up to that
      if (const int cell = q + int(lane); cell < block.size() && block.touches(cell)) {
        const std::uint32_t key = sources.key(block, cell);
        end = sources.last(key);
        upto = end - sources.first(key);
      }
      for (unsigned step = 1; step < 32; step *= 2) {
        const Index before = __shfl_up_sync(kAll, upto, step);
        if (lane >= step) upto += before;
      }
      const Index all = __shfl_sync(kAll, upto, 31), shift = end - upto;
      for (Index c = lane; c - lane < all; c += 32) {
        unsigned of = 0;  // whose cell candidate c is in
        for (unsigned step = 16; step > 0; step /= 2)
          if (__shfl_sync(kAll, upto, int(of + step - 1)) <= c) of += step;
        const Index j = c + __shfl_sync(kAll, shift, int(of));
        const bool hit = c < all && near(i, j);
        const unsigned hits = __ballot_sync(kAll, hit);
        if (hit) keep(n + std::uint32_t(__popc(hits & ((1u << lane) - 1))), j);
        n += std::uint32_t(__popc(hits));
      }
    }
    return n;
  }
};

template <class Search>
__global__ void __launch_bounds__(Search::kThreads) slice_search(Search search) {
  begin_loop();
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
  if (entry_.size() == 0) make_room(0);  // loops read ahead, also where nothing is near
  using Search = detail::SliceSearch<Near>;
  const Index blocks = Index((slices() * 32 + Search::kThreads - 1) / Search::kThreads);
  for (;;) {
    const std::uint64_t room = this->room();
    taken_.zero();
    launch(detail::slice_search<Search>, blocks, Search::kThreads, 0,
           Search{sources, near, view(), rows, room, count_.data(), offset_.data(), taken_.data(),
                  entry_.data()});
    slots_ = taken_.to_host()[0];
    if (slots_ <= room) return;
    make_room(slots_);
  }
#else
  // one search instead of two: blocks of rows grow separate lists, which are then joined
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
  if (entry_.size() < slots_ + kBeyond) make_room(slots_);
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

/// The range of pairs of particles with variable smoothing lengths: `times` the larger length.
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

/// Pairs across the phases closer than `range` and their half skins, in fp64.
template <class PA, class PB>
struct CrossNear {
  Frame frame;
  Span<const PA> a;
  Span<const PB> b;
  double range;  ///< m
  HalfSkins skin_a = {}, skin_b = {};
  BL_HD Vec3d place(Index i) const { return coordinates(frame, a[i]); }
  BL_HD double reach(Index i) const { return range + skin_a[i] + skin_b.most; }
  BL_HD bool operator()(Index i, Index j) const {
    return norm2(frame.separation(coordinates(frame, a[i]), coordinates(frame, b[j]))) <
           square(range + skin_a[i] + skin_b[j]);
  }
};

}  // namespace BL_SOLVER
