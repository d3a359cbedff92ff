#pragma once
// Runs a pass over the pairs of a list of tiles: what it reads of a tile's sources is staged in shared
// memory, if the pass fades.

#include "bedload/neighbours/for_each_pair.hpp"
#include "bedload/neighbours/tile_list.hpp"

#if BL_CUDA
#include <cuda_pipeline.h>

namespace BL_SOLVER {

namespace detail {

/// Of one source in shared memory, bytes.
template <class Field>
constexpr std::size_t kStagedBytes = 0;
template <class T>
constexpr std::size_t kStagedBytes<Span<T>> = sizeof(T);

/// Copies a source's value there, asynchronously.
template <class T>
__device__ void stage(const Span<T>& to, const Span<T>& from, Index local, Index j) {
  constexpr std::size_t piece = sizeof(T) % 16 == 0 ? 16 : sizeof(T) % 8 == 0 ? 8 : 4;
  auto* const there = reinterpret_cast<std::byte*>(const_cast<std::remove_const_t<T>*>(to.data) + local);
  const auto* const here = reinterpret_cast<const std::byte*>(from.data + j);
  for (std::size_t k = 0; k < sizeof(T); k += piece) __pipeline_memcpy_async(there + k, here + k, piece);
}
__device__ inline void stage(Unread, Unread, Index, Index) {}

/// Something for what has no weight.
template <class T>
__device__ void stage_one(const Span<T>& to, Index local) {
  Real one[sizeof(T) / sizeof(Real)];
  for (Real& n : one) n = 1;
  memcpy(const_cast<std::remove_const_t<T>*>(to.data) + local, one, sizeof(T));
}
__device__ inline void stage_one(Unread, Index) {}

/// The fields of a tile's sources in shared memory, one after another.
template <class All>
struct Staged;
template <std::size_t... k, class... Field>
struct Staged<SourceFields<std::index_sequence<k...>, Field...>> {
  using All = Sources<Field...>;
  static constexpr std::size_t bytes = (kStagedBytes<Field> + ... + 0);

  __device__ static All at(std::byte* memory, Index capacity) {
    All all;
    (place<k>(all, memory, capacity), ...);
    return all;
  }
  __device__ static void copy(const All& to, const All& from, Index local, Index j) {
    (stage(to.SourceField<k, Field>::field, from.SourceField<k, Field>::field, local, j), ...);
  }
  __device__ static void end(const All& to, Index local) {
    (stage_one(to.SourceField<k, Field>::field, local), ...);
  }

 private:
  template <std::size_t n, class T>
  __device__ static void place(SourceField<n, Span<T>>& source, std::byte* memory, Index capacity) {
    constexpr std::size_t before = ((k < n ? kStagedBytes<Field> : 0) + ... + 0);
    source.field = {reinterpret_cast<T*>(memory + capacity * before), capacity};
  }
  template <std::size_t n>
  __device__ static void place(SourceField<n, Unread>&, std::byte*, Index) {}
};
template <class Pass>
using StagedOf = Staged<decltype(std::declval<const Pass&>().sources())>;

}  // namespace detail

struct NoWalls {};

template <class Pass, class WallRow>
struct TileLoop {
  TileListView list;
  PairSeparation separation;
  Real range2;
  WallRow wall_row;
  Pass pass;
  Index capacity;  ///< sources that can be staged; 0 for none

  __device__ void operator()() const {
    const Tile tile = list.tile[blockIdx.x];
    const Index end = list.tile[blockIdx.x + 1].row;
    const Lane lane(threadIdx.x, list.bits);
    const Index i = tile.row + lane.row;
    const auto among_all = [&](auto& sum) {
      each_entry(lane, [&](Index local) {
        if (local == tile.sources) return;
        const Index j = list.source[tile.source + local];
        const auto b = separation.b[j];
        const Real3 r = separation(i, b);
        const Real r2 = norm2(r);
        if (r2 < range2) add_pair(pass, sum, j, r, r2, Real(b.weight));
      });
    };
    if constexpr (kFades<Pass>) {
      if (tile.sources < capacity) return among_staged(tile, i, end, lane);
    }
    finish(i, end, lane, among_all);
  }

 private:
  /// Places are staged as distances from the first row, with the weight.
  __device__ void among_staged(const Tile& tile, Index i, Index end, const Lane& lane) const {
    extern __shared__ uint4 memory[];
    using Fields = detail::StagedOf<Pass>;
    auto* const place = reinterpret_cast<Real4*>(memory);
    const auto fields = Fields::at(reinterpret_cast<std::byte*>(place + capacity), capacity);
    const auto origin = separation.b[tile.row];
#pragma unroll 4
    for (Index local = threadIdx.x; local < tile.sources; local += kTileThreads) {
      const Index j = list.source[tile.source + local];
      Fields::copy(fields, pass.sources(), local, j);
      const auto b = separation.b[j];
      place[local] = {separation.frame.separation(b, origin), Real(b.weight)};
    }
    if (threadIdx.x == 0) {
      Fields::end(fields, tile.sources);
      place[tile.sources] = {};
    }
    __pipeline_commit();
    __pipeline_wait_prior(0);
    __syncthreads();
    const Real3 a = separation.frame.separation(separation.a[min_of(i, end - 1)], origin);
    finish(i, end, lane, [&](auto& sum) {
      const auto pairs = [&](const auto& nearest_image) {
        each_entry(lane, [&](Index local) {
          const Real4 b = place[local];
          const Real3 r = nearest_image(a - b.xyz());
          fields.load(local, [&](const auto&... of_b) { pass.pair(sum, r, norm2(r), b.w, of_b...); });
        });
      };
      list.periods.any ? pairs(list.periods) : pairs([](const Real3& r) { return r; });
    });
  }
  /// f(local) for each entry of a row.
  template <class F>
  __device__ void each_entry(const Lane& lane, const F& f) const {
    const Index threads = Mergeable<Pass> ? 1 : lane.count;  // whose entries this one takes
    for (Index thread = threadIdx.x; thread < threadIdx.x + threads; ++thread) {
      const uint2* entry = list.entry + list.first_word(blockIdx.x, thread);
      int left = list.count[blockIdx.x * kTileThreads + thread];
      uint2 next = left > 0 ? *entry : uint2{};
      for (; left > 0; left -= 4) {
        const uint2 word = next;
        entry += kTileThreads;
        if (left > 4) next = *entry;  // while these pairs are worked on
        f(word.x & 0xffff);
        f(word.x >> 16);
        f(word.y & 0xffff);
        f(word.y >> 16);
      }
    }
  }
  /// A whole row, whose fluid `among` adds up.
  template <class F>
  __device__ void finish(Index i, Index end, const Lane& lane, const F& among) const {
    if (i >= end || (!Mergeable<Pass> && lane.index > 0)) return;
    auto sum = pass.start(i);
    among(sum);
    if constexpr (!std::is_same_v<WallRow, NoWalls>)
      wall_row(i, lane, [&](auto j, const auto& r, auto r2, auto) { add_wall_pair(pass, sum, j, r, r2); });
    finish_row(pass, i, lane, sum);
  }
};

template <class Loop>
__global__ void __launch_bounds__(kTileThreads) tile_kernel(Loop loop) {
  begin_loop();
  loop();
}

/// wall_row: of a second list, with as many lanes a row.
template <class Pass, class WallRow = NoWalls>
void for_each_pair(Range, const TileList& list, const PairSeparation& separation, double cutoff,
                   const Pass& pass, const WallRow& wall_row = {}) {
  if (list.tiles() == 0) return;
  using Loop = TileLoop<Pass, WallRow>;
  std::size_t each = 0;
  if constexpr (kFades<Pass>) each = sizeof(Real4) + detail::StagedOf<Pass>::bytes;
  static const Index blocks = blocks_at_a_time(tile_kernel<Loop>, kTileThreads, 0);
  const Index capacity = list.capacity(each, blocks);
  if (each > 0)
    check_cuda(cudaFuncSetAttribute(tile_kernel<Loop>, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                    int(tile_memory())),
               "shared memory of a pass");
  launch(tile_kernel<Loop>, list.tiles(), kTileThreads, capacity * each,
         Loop{list.view(), separation, Real(cutoff * cutoff), wall_row, pass, capacity});
}

}  // namespace BL_SOLVER
#endif
