#pragma once
// How a TileList is made: a search block by block, and the order of what it finds. Passes do not need it.

#include "bedload/neighbours/tile_list.hpp"

#if BL_CUDA
namespace BL_SOLVER {

/// Blocks of a kernel that the device runs at a time.
template <class Kernel>
Index resident_blocks(Kernel kernel, Index threads, std::size_t memory) {
  int device = 0, processors = 0;
  check_cuda(cudaGetDevice(&device), "GPU");
  check_cuda(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device), "GPU");
  return blocks_at_a_time(kernel, threads, memory) * Index(processors);
}

namespace detail {

/// How many tiles there are in a block of cells.
struct TilesOfBlock {
  CellGridView grid;
  Index rows;  ///< of a tile, at most
  Span<std::uint64_t> width;
  BL_HD Index first(Index block) const { return grid.start[block << grid.block_bits]; }
  BL_HD void operator()(Index b) const { width[b] = (first(b + 1) - first(b) + rows - 1) / rows; }
};
struct CutBlock {
  TilesOfBlock tiles;
  Span<const std::uint64_t> offset;
  Span<Tile> tile;
  BL_HD void operator()(Index b) const {
    const Index n = Index(offset[b + 1] - offset[b]);
    for (Index t = 0; t < n; ++t) tile[Index(offset[b]) + t].row = tiles.first(b) + t * tiles.rows;
    if (b + 2 == offset.size) tile[Index(offset[b + 1])].row = tiles.first(b + 1);
  }
};

/// Cells of a brick and around it.
struct BrickCells {
  static constexpr int kSide = 10, kCells = kSide * kSide * kSide;
  int base[3];
  /// Place of coordinate c along axis k, wrapped, next to or in the brick.
  BL_HD int place(const CellGridView& grid, int k, int c) const {
    const int d = c - base[k];
    const bool below = d == -1 || (base[k] == 0 && c == grid.n[k] - 1);
    return d >= 0 && d < 8 ? d + 1 : below ? 0 : 9;
  }
};

/// The cells, three a side at most, that a sphere reaches into, by their places among those of a brick.
struct CellsAround {
  std::uint32_t touched = 0;  ///< a bit each
  std::uint32_t place[3]{};   ///< along an axis, four bits each

  CellsAround() = default;
  BL_HD CellsAround(const CellGridView& grid, const BrickCells& brick, const CellGridView::Block& b) {
    double gap2[3][3];
    int c[3][3];
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) {
        gap2[k][i] = i < b.n[k] ? b.gap2(k, i) : 2 * b.range2;
        c[k][i] = grid.wrapped(b.lo[k] + i, k);
        place[k] |= std::uint32_t(brick.place(grid, k, c[k][i])) << 4 * i;
      }
    for (int q = 0; q < 27; ++q)
      if (gap2[0][q % 3] + gap2[1][q / 3 % 3] + gap2[2][q / 9] < b.range2) touched |= 1u << q;
  }
  /// f(place, cell q of 27) of every stride-th.
  template <class F>
  BL_HD void each(int first, int stride, const F& f) const {
    for (int q = first; q < 27; q += stride)
      if (touched >> q & 1) {
        const int along[3] = {q % 3, q / 3 % 3, q / 9};
        f(int((place[0] >> 4 * along[0] & 15) + BrickCells::kSide * (place[1] >> 4 * along[1] & 15) +
              BrickCells::kSide * BrickCells::kSide * (place[2] >> 4 * along[2] & 15)),
          along);
      }
  }
};

/// Sums over the threads of a block below each; `total` over all of them. `sums`: one a warp.
template <class T>
__device__ T sum_below(T own, T* sums, T& total) {
  const unsigned lane = threadIdx.x % 32, warp = threadIdx.x / 32;
  T sum = own;
  for (unsigned d = 1; d < 32; d *= 2) {
    const T below = __shfl_up_sync(0xffffffffu, sum, d);
    if (lane >= d) sum += below;
  }
  __syncthreads();
  if (lane == 31) sums[warp] = sum;
  __syncthreads();
  total = 0;
  for (unsigned w = 0; w < kTileThreads / 32; ++w) {
    if (w == warp) sum += total;
    total += sums[w];
  }
  __syncthreads();
  return sum - own;
}

/// The entries of one thread.
struct ThreadEntries {
  uint2* word;  ///< its first
  Index words;  ///< capacity
  Index n = 0;
  uint2 next{};

  __device__ void append(Index j) {
    next.x = __byte_perm(next.x, next.y, 0x5432);
    next.y = __byte_perm(next.y, j, 0x5432);
    ++n;
    if ((n & 3) == 0 && n <= 4 * words) word[std::size_t(n / 4 - 1) * kTileThreads] = next;
  }
  __device__ void end(Index padding) {
    const Index all = n;
    while ((n & 3) != 0) append(padding);
    n = all;
  }
  template <class F>
  __device__ void each(const F& f) const {
    for (Index k = 0; k < n; k += 4) {
      const uint2 w = word[std::size_t(k / 4) * kTileThreads];
      f(w.x & 0xffff);
      if (k + 1 < n) f(w.x >> 16);
      if (k + 2 < n) f(w.y & 0xffff);
      if (k + 3 < n) f(w.y >> 16);
    }
  }
};

/// So many particles can be numbered around a tile.
constexpr Index kMostAround = 65534;

/// One block, one tile after another, as they come: all particles of the cells around it are numbered and
/// searched; then those that are near any row alone are numbered, and what was found is written by their
/// numbers.
template <class P>
struct TileSearch {
  CellGridView grid;
  Frame frame;
  Span<const P> x;
  Span<const PairPosition> xp;
  double range;
  HalfSkins skins;
  ShortPeriods periods;
  unsigned bits;
  Index tiles, memory, third;    ///< memory: to stage in, bytes; that of each where three blocks run
  Index words, sources, places;  ///< there is room for: of a thread; of all tiles; words of all tiles
  Tile* tile;
  Index* source;
  std::uint16_t* count;
  uint2 *entry, *found;  ///< found: [blocks x words x threads]
  TileCounts* counts;
};

/// kAlone: one thread a row.
template <bool kAlone, class P>
__device__ void search_tile(const TileSearch<P>& s, const Index tile) {
  const unsigned bits = kAlone ? 0 : s.bits;
  constexpr Index kEach = (BrickCells::kCells + kTileThreads - 1) / kTileThreads,
                  kSlots = kEach * kTileThreads;
  constexpr Index kWarps = kTileThreads / 32;
  __shared__ std::uint32_t cell[kSlots];  // key of a cell that is near, kNone of others
  __shared__ Index local[kSlots];         // number of its first particle, or of the next cell's
  static_assert(kSlots > BrickCells::kCells);
  __shared__ Index sums[kWarps], first_source, first_word, most;
  __shared__ float widest[kWarps];  // half skin of the particles around
  extern __shared__ uint4 staged[];

  const Index t = threadIdx.x, warp = t / 32, lane_of_warp = t % 32;
  for (Index k = 0; k < kEach; ++k) cell[t + k * kTileThreads] = kNone;
  if (t == 0) most = 0;
  __syncthreads();

  // the cells that any row reaches into
  const Lane lane(t, bits);
  const Index first = s.tile[tile].row, end = s.tile[tile + 1].row;
  const Index i = first + lane.row;
  const bool some = i < end;
  CellsAround around;
  BrickCells brick;
  const Vec3d corner = coordinates(s.frame, s.x[first]);
  for (int k = 0; k < 3; ++k) brick.base[k] = s.grid.coordinate(corner[k], k) & ~7;
  const auto block_of = [&](double skin) {
    return s.grid.block(coordinates(s.frame, s.x[i]), s.range + s.skins[i] + skin);
  };
  if (some) {
    const CellGridView::Block block = block_of(s.skins.most);
    around = CellsAround(s.grid, brick, block);
    around.each(int(lane.index), int(lane.count), [&](int slot, const int(&along)[3]) {
      int c[3];
      for (int k = 0; k < 3; ++k) c[k] = s.grid.wrapped(block.lo[k] + along[k], k);
      atomicExch(&cell[slot], s.grid.key(c[0], c[1], c[2]));  // all who write here write the same
    });
  }
  __syncthreads();

  // number their particles
  const auto particles = [&](std::uint32_t c) {
    return c == kNone ? 0 : s.grid.start[c + 1] - s.grid.start[c];
  };
  Index own = 0, all = 0;
  for (Index k = 0; k < kEach; ++k) own += particles(cell[t * kEach + k]);
  Index at = sum_below(own, sums, all);
  for (Index k = 0; k < kEach; ++k) {
    local[t * kEach + k] = at;
    at += particles(cell[t * kEach + k]);
  }
  __syncthreads();
  const std::size_t to_stage = (all + (4u << bits)) * sizeof(Vec4<Real>);  // tests run on
  if (t == 0) {
    atomicMax(&s.counts->around, all);
    if (to_stage > s.third) atomicAdd(&s.counts->crowded, 1);
  }
  if (all > kMostAround) return;  // an error of the caller's
  const auto each_particle = [&](const auto& f) {
    for (Index slot = warp; slot < BrickCells::kCells; slot += kWarps) {
      if (cell[slot] == kNone) continue;
      const Index begin = s.grid.start[cell[slot]], n = local[slot + 1] - local[slot];
      for (Index k = lane_of_warp; k < n; k += 32) f(local[slot] + k, begin + k);
    }
  };

  // search among their places from the first row, which are staged where they fit
  auto* const near = reinterpret_cast<Vec4<Real>*>(staged);
  const PairPosition origin = s.xp[first];
  const auto from_origin = [&](Index j) { return s.frame.separation(s.xp[j], origin); };
  const bool fits = to_stage <= s.memory;
  float most_skin = 0;
  each_particle([&](Index number, Index j) {
    const Real skin = s.skins[j];
    if (fits) near[number] = {from_origin(j), skin};
    most_skin = fmaxf(most_skin, __double2float_ru(double(skin)));
  });
  for (unsigned step = 16; step > 0; step /= 2)
    most_skin = fmaxf(most_skin, __shfl_xor_sync(0xffffffffu, most_skin, step));
  if (lane_of_warp == 0) widest[warp] = most_skin;
  __syncthreads();
  for (Index w = 0; w < kWarps; ++w) most_skin = fmaxf(most_skin, widest[w]);
  // Where all are slow they need not look as far. That may change the order of cells along a short period, so
  // it must not depend on what fits, which searches before have decided.
  if (some && most_skin < 0.9 * s.skins.most)
    around = CellsAround(s.grid, brick, block_of(most_skin + 1e-6 * s.range));
  ThreadEntries list{s.found + std::size_t(blockIdx.x) * s.words * kTileThreads + t, s.words};
  if (some) {
    const Vec3<Real> a = from_origin(i);
    const Real reach = Real(s.range) + s.skins[i];
    around.each(0, 1, [&](int slot, const int(&)[3]) {
      const Index from = local[slot], to = local[slot + 1], begin = s.grid.start[cell[slot]];
      const Index self = from + (i - begin);
      const auto search = [&](const auto& is_near) {
        for (Index k = from + lane.index; k < to; k += 32 * lane.count) {
          const Index n = min_of(32u, (to - k + lane.count - 1) >> bits);
          unsigned hits = 0;
          for (Index b = 0; b < n; b += 4) {
            unsigned four = 0;
#pragma unroll
            for (Index c = 0; c < 4; ++c)
              if (is_near(k + ((b + c) << bits))) four |= 1u << c;
            hits |= four << b;
          }
          hits &= 0xffffffffu >> (32 - n);
          if (((self - k) & (lane.count - 1)) == 0 && self - k < 32 * lane.count)
            hits &= ~(1u << ((self - k) >> bits));
          while (hits != 0) {
            const int b = 31 - __clz(int(hits));
            hits ^= 1u << b;
            list.append(k + (Index(b) << bits));
          }
        }
      };
      if (fits && !s.periods.any)
        search([&](Index k) {
          const Vec4<Real> b = near[k];
          return norm2(a - b.xyz()) < square(reach + b.w);
        });
      else
        search([&](Index k) {
          const Index j = begin + (min_of(k, to - 1) - from);
          const Vec4<Real> b = fits ? near[k] : Vec4<Real>{from_origin(j), s.skins[j]};
          return norm2(s.periods(a - b.xyz())) < square(reach + b.w);
        });
    });
    list.end(all);
  }
  s.count[tile * kTileThreads + t] = std::uint16_t(list.n);
  atomicMax(&most, list.n);
  __syncthreads();
  if (t == 0) atomicMax(&s.counts->longest, most);
  if (most > 4 * s.words) return;  // to be done again with more capacity

  // number those that are near: a bit each, and how many there are before its word
  const Index fields = (all + 31) / 32;
  auto* const near_row = reinterpret_cast<std::uint32_t*>(staged);
  auto* const before = near_row + fields;
  for (Index k = t; k < fields; k += kTileThreads) near_row[k] = 0;
  __syncthreads();
  list.each([&](Index k) { atomicOr(&near_row[k / 32], 1u << (k % 32)); });
  __syncthreads();
  const Index each = (fields + kTileThreads - 1) / kTileThreads;
  const Index from = min_of(fields, t * each), to = min_of(fields, from + each);
  own = 0;
  for (Index k = from; k < to; ++k) own += __popc(near_row[k]);
  Index sources = 0;
  at = sum_below(own, sums, sources);
  for (Index k = from; k < to; ++k) {
    before[k] = at;
    at += __popc(near_row[k]);
  }
  const Index words = (most + 3) / 4;
  if (t == 0) {
    first_source = atomicAdd(&s.counts->sources, sources);
    first_word = atomicAdd(&s.counts->words, words);
    atomicMax(&s.counts->nearest, sources);
    atomicAdd(&s.counts->tiles[min_of(sources / TileCounts::kBin, TileCounts::kBins - 1)], 1);
    s.tile[tile].source = first_source;
    s.tile[tile].sources = sources;
    s.tile[tile].word = first_word;
  }
  __syncthreads();
  if (first_source + sources > s.sources || first_word + words > s.places) return;
  const auto number = [&](Index k) {
    return before[k / 32] + __popc(near_row[k / 32] & ((1u << (k % 32)) - 1));
  };
  each_particle([&](Index k, Index j) {
    if (near_row[k / 32] >> (k % 32) & 1) s.source[first_source + number(k)] = j;
  });
  if (!some) return;
  ThreadEntries numbered{s.entry + std::size_t(first_word) * kTileThreads + t, words};
  list.each([&](Index k) { numbered.append(number(k)); });
  numbered.end(sources);
}

template <bool kAlone, class P>
__global__ void __launch_bounds__(kTileThreads) tile_search(TileSearch<P> s) {
  begin_loop();
  __shared__ Index tile;
  for (;;) {
    if (threadIdx.x == 0) tile = atomicAdd(&s.counts->next, 1);
    __syncthreads();
    if (tile >= s.tiles) return;
    search_tile<kAlone>(s, tile);
    __syncthreads();
  }
}

/// Orders the entries of each thread t: at step k a source whose number is t + k modulo 8, or the next there
/// is.
template <class Word>
__global__ void __launch_bounds__(kTileThreads) tile_order(TileListView list, Word* entry) {
  begin_loop();
  extern __shared__ std::uint16_t sorted[];  // by remainder, [entries x threads]
  const Index t = threadIdx.x;
  ThreadEntries in{entry + list.first_word(blockIdx.x, t), 64};
  const Index n = in.n = list.count[blockIdx.x * kTileThreads + t];
  if (n > 255) return;
  std::uint64_t left = 0;  // entries of each remainder, a byte each
  in.each([&](Index k) { left += std::uint64_t(1) << 8 * (k & 7); });
  const std::uint64_t begin = left * 0x0101010101010100u;
  std::uint64_t next = begin;
  const auto take = [&](Index r) {
    const Index place = Index(next >> 8 * r) & 255;
    next += std::uint64_t(1) << 8 * r;
    return place * kTileThreads + t;
  };
  in.each([&](Index k) { sorted[take(k & 7)] = std::uint16_t(k); });
  Index least = 255;  // as often as every remainder is there
  for (Index r = 0; r < 8; ++r) least = min_of(least, Index(left >> 8 * r) & 255);
  ThreadEntries out{in.word, in.words};
  for (Index k = 0; k < 8 * least; ++k) {
    const Index r = (t + k) & 7;
    out.append(sorted[((Index(begin >> 8 * r) & 255) + k / 8) * kTileThreads + t]);
  }
  left -= least * 0x0101010101010101u;
  next = begin + least * 0x0101010101010101u;
  unsigned some = 0;  // which remainders are left, twice over
  for (Index r = 0; r < 8; ++r) some |= (left >> 8 * r & 255) != 0 ? 0x101u << r : 0;
  for (Index k = 8 * least; k < n; ++k) {
    const Index r = (Index(__ffs(int(some >> ((t + k) & 7)))) - 1 + t + k) & 7;
    left -= std::uint64_t(1) << 8 * r;
    if ((left >> 8 * r & 255) == 0) some &= ~(0x101u << r);
    out.append(sorted[take(r)]);
  }
  out.end(list.tile[blockIdx.x].sources);
}

}  // namespace detail

template <class P>
void TileList::build(Index of_rows, const CellGrid& grid, const Frame& frame, Span<const P> x,
                     Span<const PairPosition> xp, double range, const HalfSkins& skins, unsigned bits) {
  rows_ = of_rows;
  bits_ = min_of(bits, 5u);
  periods_ = ShortPeriods(frame, grid.view());
  const Index blocks = grid.blocks(), rows = kTileThreads >> bits_;
  width_.resize(blocks);
  const detail::TilesOfBlock tiles{grid.view(), rows, width_};
  for_each({0, blocks}, tiles);
  tiles_ = Index(exclusive_scan(width_, offset_));
  tile_.reserve_and_resize(tiles_ + 1);
  for_each({0, blocks}, detail::CutBlock{tiles, offset_, tile_});
  count_.reserve_and_resize(std::size_t(tiles_) * kTileThreads);
  if (tiles_ > 0)
    search(grid, frame, x, xp, range, skins);
  else
    numbers_ = {};
  everywhere_ = all_reduce(numbers_, [](detail::TileCounts& into, const detail::TileCounts& more) {
    into.nearest = max_of(into.nearest, more.nearest);
    into.longest = max_of(into.longest, more.longest);
    for (Index bin = 0; bin < detail::TileCounts::kBins; ++bin) into.tiles[bin] += more.tiles[bin];
  });
  all_tiles_ = all_reduce(std::uint64_t(tiles_), [](auto& into, auto more) { into += more; });
  most_ = everywhere_.nearest;
  if (tiles_ == 0) return;
  // by what there is now, not by the capacity that there has been, and on all ranks alike: a run that is
  // restarted from here, or divided otherwise, orders the same
  const std::size_t sorted =
      std::size_t(everywhere_.longest + 3) / 4 * 4 * kTileThreads * sizeof(std::uint16_t);
  if (sorted > tile_memory()) return;
  check_cuda(cudaFuncSetAttribute(detail::tile_order<uint2>, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                  int(tile_memory())),
             "shared memory of an order");
  launch(detail::tile_order<uint2>, tiles_, kTileThreads, sorted, view(), entry_.data());
}

template <class P>
void TileList::search(const CellGrid& grid, const Frame& frame, Span<const P> x, Span<const PairPosition> xp,
                      double range, const HalfSkins& skins) {
  counts_.resize(1);
  const auto search = bits_ == 0 ? detail::tile_search<true, P> : detail::tile_search<false, P>;
  check_cuda(cudaFuncSetAttribute(search, cudaFuncAttributeMaxDynamicSharedMemorySize, int(tile_memory())),
             "shared memory of a search");
  for (bool done = false; !done;) {
    constexpr std::size_t least = 2 * 65536 / 8;  // a bit for each of the most there may be, and sums of them
    const bool few_crowded = numbers_.crowded <= tiles_ / 64;  // at the last search
    const std::size_t third = shared_memory(3) - detail::kSearchMemory;
    const std::size_t memory =
        max_of(least, min_of(few_crowded ? third : tile_memory(), crowd_ * sizeof(Vec4<Real>)));
    const Index blocks = min_of(tiles_, resident_blocks(search, kTileThreads, memory));
    const Index places = Index(entry_.size() / kTileThreads);
    found_.reserve_and_resize(std::size_t(blocks) * words_ * kTileThreads);
    counts_.zero();
    launch(search, blocks, kTileThreads, memory,
           detail::TileSearch<P>{.grid = grid.view(),
                                 .frame = frame,
                                 .x = x,
                                 .xp = xp,
                                 .range = range,
                                 .skins = skins,
                                 .periods = periods_,
                                 .bits = bits_,
                                 .tiles = tiles_,
                                 .memory = Index(memory),
                                 .third = Index(third),
                                 .words = words_,
                                 .sources = Index(source_.size()),
                                 .places = places,
                                 .tile = tile_.data(),
                                 .source = source_.data(),
                                 .count = count_.data(),
                                 .entry = entry_.data(),
                                 .found = found_.data(),
                                 .counts = counts_.data()});
    const detail::TileCounts counts = numbers_ = counts_.to_host()[0];
    if (counts.around > detail::kMostAround)
      throw DeviceError("more than " + std::to_string(detail::kMostAround) + " particles around " +
                        std::to_string(kTileThreads >> bits_) + " that lie together");
    done = counts.sources <= source_.size() && counts.words <= places && counts.longest <= 4 * words_;
    crowd_ = counts.around + counts.around / 16 + (4u << bits_);
    // with room for a little more: what does not fit takes another search
    if (counts.longest > 4 * words_) words_ = (counts.longest + 3) / 4 + 1;
    if (counts.sources > source_.size()) source_.resize(counts.sources + counts.sources / 16);
    if (counts.words > places)
      entry_.resize(std::size_t(counts.words + counts.words / 32 + 1) * kTileThreads);
  }
}

}  // namespace BL_SOLVER
#endif
