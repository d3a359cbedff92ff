#pragma once
// Neighbours of one phase in itself, on the GPU: blocks of threads work on tiles of rows that lie together,
// and what they read of all particles near a tile, its sources, is staged in shared memory, where the entries
// of the list point with 16 bits. Tiles are runs of sorted particles of one block of cells. Shared memory has
// eight banks of 16 bytes, from which eight threads read at a time: so the entries of a thread stand in such
// an order that neighbouring threads read from different ones while that is possible.

#include "bedload/neighbours/cell_grid.hpp"
#include "bedload/neighbours/half_skins.hpp"
#include "bedload/parallel/lanes.hpp"
#include "bedload/parallel/ranks.hpp"

#if BL_CUDA
namespace BL_SOLVER {

constexpr Index kTileThreads = 256;

struct Tile {
  Index row;      ///< first row; the next tile's ends it
  Index source;   ///< where its sources begin
  Index sources;  ///< how many there are
  Index word;     ///< where the words of its entries begin
};

/// Takes differences of places seen from a tile's first row to the nearest image where a period is so short
/// that a tile and what is around it meet themselves.
struct ShortPeriods {
  bool any = false;            ///< else there is nothing to do, and loops over pairs are built without it
  Vec3<Real> length, inverse;  ///< m, 1/m; 0 along other axes

  ShortPeriods() = default;
  ShortPeriods(const Frame& frame, const CellGridView& grid) {
    for (int k = 0; k < 3; ++k)
      if (frame.periodic[k] && grid.n[k] < 20) {
        any = true;
        length[k] = Real(frame.length[k]), inverse[k] = Real(1 / frame.length[k]);
      }
  }
  BL_HD Vec3<Real> operator()(const Vec3<Real>& d) const {
    using std::rint;
    return {d.x - length.x * rint(d.x * inverse.x), d.y - length.y * rint(d.y * inverse.y),
            d.z - length.z * rint(d.z * inverse.z)};
  }
};

struct TileListView {
  const Tile* tile = nullptr;            ///< [tiles + 1]
  const Index* source = nullptr;         ///< places among all particles
  const std::uint16_t* count = nullptr;  ///< [tiles x threads] entries of a thread
  const uint2* entry = nullptr;          ///< four to a word: [words of all tiles x threads]
  unsigned bits = 0;                     ///< log2 of the threads that share a row
  Index most = 0;                        ///< sources of any tile
  ShortPeriods periods;

  /// Place of the first word of a thread; the next are as far apart as there are threads.
  BL_HD std::size_t first_word(Index of_tile, Index thread) const {
    return std::size_t(tile[of_tile].word) * kTileThreads + thread;
  }
};

namespace detail {
/// Shared memory of a block in a search besides what it stages, at most, bytes.
constexpr std::size_t kSearchMemory = 9 << 10;

/// Result of a search.
struct TileCounts {
  Index next;             ///< tile that no block has taken yet
  Index sources, words;   ///< of all tiles
  Index longest;          ///< most entries of a thread
  Index around, nearest;  ///< most particles in the cells around a tile, and most sources of one
  Index crowded;          ///< tiles whose surroundings take more than a third of shared memory
  static constexpr Index kBin = 64, kBins = 64;
  Index tiles[kBins];  ///< with so many times kBin sources, or more in the last
};
}  // namespace detail

/// Every j within range and half skins of i at the time of building, among sorted particles. The unused
/// places of an entry's word number one source more than there are.
class TileList {
 public:
  Index rows() const { return rows_; }
  Index tiles() const { return tiles_; }
  std::size_t bytes() const { return entry_.size() * sizeof(uint2); }  ///< that entries take
  TileListView view() const {
    return {tile_.data(), source_.data(), count_.data(), entry_.data(), bits_, most_, periods_};
  }
  /// How many sources of a tile are to be staged, `each` bytes a source, by blocks of which no more than
  /// `blocks` fit on a multiprocessor anyway: of all tiles, or of nearly all where that lets more blocks run.
  Index capacity(std::size_t each, Index blocks) const;

  /// x: as sorted into the cells, of which the first have rows; xp: the same as pair loops read them. 2^bits
  /// threads share a row.
  template <class P>
  void build(Index rows, const CellGrid& grid, const Frame& frame, Span<const P> x,
             Span<const PairPosition> xp, double range, const HalfSkins& skins, unsigned bits);

 private:
  template <class P>
  void search(const CellGrid& grid, const Frame& frame, Span<const P> x, Span<const PairPosition> xp,
              double range, const HalfSkins& skins);

  Index rows_ = 0, tiles_ = 0;
  Index most_ = 0;                ///< sources of a tile, on any rank
  detail::TileCounts numbers_{};  ///< of the last search
  // how many sources a pass stages decides how it rounds, so it must not depend on the ranks
  detail::TileCounts everywhere_{};
  std::uint64_t all_tiles_ = 0;
  Index words_ = 32;              ///< of a thread's entries, at most
  std::size_t crowd_ = 2500;      ///< particles in the cells around a tile, about
  unsigned bits_ = 0;
  ShortPeriods periods_;
  Buffer<Tile> tile_;
  Buffer<Index> source_;
  Buffer<std::uint16_t> count_;
  Buffer<uint2> entry_, found_;
  Buffer<std::uint64_t> width_, offset_;
  Buffer<detail::TileCounts> counts_;
};

/// What each of so many blocks may take of a multiprocessor's shared memory, bytes.
inline std::size_t shared_memory(Index blocks) {
  static const std::size_t all = [] {
    int device = 0, bytes = 0;
    check_cuda(cudaGetDevice(&device), "GPU");
    check_cuda(cudaDeviceGetAttribute(&bytes, cudaDevAttrMaxSharedMemoryPerMultiprocessor, device), "GPU");
    return std::size_t(bytes);
  }();
  constexpr std::size_t own = 1 << 10;  // of each block, for the system
  return all / blocks - own;
}

/// What a tile may take, bytes: half of a multiprocessor's memory where that is much, so that two run at a
/// time.
inline std::size_t tile_memory() {
  static const std::size_t bytes = [] {
    int device = 0, one = 0;
    check_cuda(cudaGetDevice(&device), "GPU");
    check_cuda(cudaDeviceGetAttribute(&one, cudaDevAttrMaxSharedMemoryPerBlockOptin, device), "GPU");
    return max_of(shared_memory(2), min_of(std::size_t(one), std::size_t(99) << 10)) - detail::kSearchMemory;
  }();
  return bytes;
}

inline Index TileList::capacity(std::size_t each, Index blocks) const {
  if (each == 0) return 0;
  const auto places = [&](std::size_t bytes) { return Index(bytes / each) / 4 * 4; };
  const Index all = min_of(places(tile_memory()), (most_ + 1 + 3) / 4 * 4);
  for (; blocks > 1 && places(shared_memory(blocks)) < all; --blocks) {
    const Index fit = places(shared_memory(blocks));
    std::uint64_t beyond = 0;
    for (Index bin = fit / detail::TileCounts::kBin; bin < detail::TileCounts::kBins; ++bin)
      beyond += everywhere_.tiles[bin];
    if (beyond <= all_tiles_ / 64) return fit;
  }
  return all;
}

/// Blocks of a kernel that a multiprocessor runs at a time.
template <class Kernel>
Index blocks_at_a_time(Kernel kernel, Index threads, std::size_t memory) {
  int blocks = 0;
  check_cuda(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, int(threads), memory), "GPU");
  return Index(max_of(blocks, 1));
}

}  // namespace BL_SOLVER
#endif
