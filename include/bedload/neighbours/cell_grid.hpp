#pragma once
// Sorted cells of one phase. Cells are numbered along a Hilbert curve inside bricks of
// 8 x 8 x 8 and bricks row by row, so that neighbours in space are neighbours in memory. A brick
// is one block, or it is cut into cubes of 4, 2 or 1 cells each way, which are stretches of the
// curve. The table of cell starts covers only blocks with particles in or next to them. With
// several ranks each block has one owner, and a rank has copies of the particles in those cells
// of others that are next to its own.

#include <array>
#include <memory>
#include <utility>

#include "bedload/core/frame.hpp"
#include "bedload/neighbours/ownership.hpp"
#include "bedload/parallel/sort.hpp"

namespace BL_SOLVER {

struct CellGridView {
  Vec3d origin, inverse;  ///< 1/m
  int n[3] = {1, 1, 1};   ///< cells that can hold particles
  int bricks[3] = {1, 1, 1};
  bool periodic[3] = {false, false, false};
  const std::uint16_t* curve = nullptr;           ///< [512] place on the Hilbert curve of a cell in its brick
  unsigned block_bits = 9;                        ///< log2 of the cells of a block
  const Index* directory = nullptr;               ///< [blocks of the domain] number of a block in the tables
  const Index* start = nullptr;                   ///< [cells of the tables + 1] first particle of each cell
  const std::uint8_t* occupied_nearby = nullptr;  ///< [cells] whether it or an adjacent cell holds any
  unsigned level = 0;                             ///< log2 of the sorted cells along each edge of these

  /// Cell coordinate along axis k; outside positions go to the nearest cell, periodic ones wrap.
  BL_HD int coordinate(double x, int k) const {
    int c = int(floor((x - origin[k]) * inverse[k]));
    if (periodic[k]) {
      c %= n[k];
      return c < 0 ? c + n[k] : c;
    }
    return clamp(c, 0, n[k] - 1);
  }
  /// Number of a cell among all of the domain, brick by brick.
  BL_HD std::uint32_t number(int ix, int iy, int iz) const {
    const std::uint32_t brick = (std::uint32_t(iz >> 3) * bricks[1] + (iy >> 3)) * bricks[0] + (ix >> 3);
    return brick * 512u + curve[(iz & 7) * 64 + (iy & 7) * 8 + (ix & 7)];
  }
  /// Its place in the tables.
  BL_HD std::uint32_t key_of(std::uint32_t number) const {
    return directory[number >> block_bits] << block_bits | (number & ((1u << block_bits) - 1));
  }
  BL_HD std::uint32_t key(int ix, int iy, int iz) const {
    return key_of(number(ix << level, iy << level, iz << level)) & ~(cells() - 1);
  }
  BL_HD std::uint32_t block_of(const Vec3d& x) const {
    return number(coordinate(x.x, 0), coordinate(x.y, 1), coordinate(x.z, 2)) >> block_bits;
  }
  /// The particles of the cell of a key lie from first(key) to last(key), that not included.
  BL_HD Index first(std::uint32_t key) const { return start[key]; }
  BL_HD Index last(std::uint32_t key) const { return start[key + cells()]; }
  /// Sorted cells in one of these, which is a stretch of the curve within a block.
  BL_HD std::uint32_t cells() const { return 1u << 3 * level; }
  /// The same in larger cells, for searches that reach over many.
  CellGridView for_reach(double reach) const {
    CellGridView view = *this;
    const auto fits = [&] {
      for (int k = 0; k < 3; ++k)
        if (2 > 0.75 * reach * view.inverse[k] || (periodic[k] && view.n[k] % 2 != 0)) return false;
      return 3 * view.level < block_bits;
    };
    while (fits()) {
      ++view.level;
      for (int k = 0; k < 3; ++k) view.n[k] = (view.n[k] + 1) / 2, view.inverse[k] /= 2;
      view.occupied_nearby = nullptr;  // valid only for sorted cells
    }
    return view;
  }
  BL_HD std::uint32_t key(const Vec3d& x) const {
    return key(coordinate(x.x, 0), coordinate(x.y, 1), coordinate(x.z, 2));
  }

  /// The cells around a sphere. Cells on a periodic axis are visited once, also where the sphere
  /// is as wide as the period.
  struct Block {
    int lo[3], n[3];  ///< first cell, inside the grid, and how many: those on a periodic axis may wrap
    double at[3];     ///< the sphere's centre from the first cell's corner, in cells
    double width[3];  ///< of a cell, m; 0 on an axis that is covered whole
    double range2;    ///< m2
    bool below[3], above[3];  ///< whether the first or last cell also holds what lies outside the grid

    BL_HD int size() const { return n[0] * n[1] * n[2]; }
    /// Squared distance along axis k from the sphere's centre to cell i of the block, m2.
    BL_HD double gap2(int k, int i) const {
      constexpr double slack = 1e-9;  // of a cell: rounding never hides a particle
      double gap = slack;
      if (i > 0 || !below[k]) gap = max_of(gap, i - at[k]);
      if (i < n[k] - 1 || !above[k]) gap = max_of(gap, at[k] - (i + 1));
      return square((gap - slack) * width[k]);
    }
    /// Place in the block of its cell q.
    BL_HD void cell(int q, int (&i)[3]) const {
      const int row = q / n[0];
      i[0] = q - row * n[0], i[1] = row % n[1], i[2] = row / n[1];
    }
    BL_HD bool touches(int q) const {
      int i[3];
      cell(q, i);
      return gap2(0, i[0]) + gap2(1, i[1]) + gap2(2, i[2]) < range2;
    }
  };
  BL_HD Block block(const Vec3d& x, double range) const {
    Block b;
    b.range2 = range * range;
    for (int k = 0; k < 3; ++k) {
      int lo = int(floor((x[k] - range - origin[k]) * inverse[k]));
      int hi = int(floor((x[k] + range - origin[k]) * inverse[k]));
      const bool whole = periodic[k] && hi - lo >= n[k];
      if (whole) {
        lo = 0, hi = n[k] - 1;
      } else if (!periodic[k]) {
        lo = clamp(lo, 0, n[k] - 1);
        hi = clamp(hi, 0, n[k] - 1);
      }
      b.n[k] = hi - lo + 1;
      b.at[k] = (x[k] - origin[k]) * inverse[k] - lo;
      b.lo[k] = !periodic[k] ? lo : lo % n[k] < 0 ? lo % n[k] + n[k] : lo % n[k];
      b.width[k] = whole ? 0 : 1 / inverse[k];
      b.below[k] = !periodic[k] && lo == 0;
      b.above[k] = !periodic[k] && hi == n[k] - 1;
    }
    return b;
  }
  /// Key of cell q of a block.
  BL_HD std::uint32_t key(const Block& b, int q) const {
    int i[3];
    b.cell(q, i);
    return key(wrapped(b.lo[0] + i[0], 0), wrapped(b.lo[1] + i[1], 1), wrapped(b.lo[2] + i[2], 2));
  }
  /// Whether any particle may be within `range` of x.
  BL_HD bool any_near(const Vec3d& x, double range) const {
    const bool beyond = range * max_of(inverse.x, max_of(inverse.y, inverse.z)) > 1;
    return beyond || !occupied_nearby || occupied_nearby[key(x)] != 0;
  }
  /// f(key) for the cell of x and its neighbours; on a short periodic axis more than once.
  template <class F>
  BL_HD void each_beside(const Vec3d& x, F&& f) const {
    int lo[3], hi[3];
    for (int k = 0; k < 3; ++k) {
      const int c = coordinate(x[k], k);
      lo[k] = periodic[k] ? c - 1 : max_of(c - 1, 0);
      hi[k] = periodic[k] ? c + 1 : min_of(c + 1, n[k] - 1);
    }
    for (int iz = lo[2]; iz <= hi[2]; ++iz)
      for (int iy = lo[1]; iy <= hi[1]; ++iy)
        for (int ix = lo[0]; ix <= hi[0]; ++ix) f(key(wrapped(ix, 0), wrapped(iy, 1), wrapped(iz, 2)));
  }
  /// f(begin, end) for the particles of each of the cells that a sphere of radius `range` about x touches.
  template <class F>
  BL_HD void each_run(const Vec3d& x, double range, F&& f) const {
    const Block b = block(x, range);
    for (int k = 0; k < b.n[2]; ++k) {
      const double gap_z = b.gap2(2, k);
      const int iz = wrapped(b.lo[2] + k, 2);
      for (int j = 0; j < b.n[1]; ++j) {
        const double gap_yz = gap_z + b.gap2(1, j);
        const int iy = wrapped(b.lo[1] + j, 1);
        for (int i = 0; i < b.n[0]; ++i) {
          if (gap_yz + b.gap2(0, i) >= b.range2) continue;
          const std::uint32_t c = key(wrapped(b.lo[0] + i, 0), iy, iz);
          if (first(c) < last(c)) f(first(c), last(c));
        }
      }
    }
  }
  /// f(j) for each of these particles.
  template <class F>
  BL_HD void each_near(const Vec3d& x, double range, F&& f) const {
    const auto run = [&](Index begin, Index end) {
      for (Index j = begin; j < end; ++j) f(j);
    };
    each_run(x, range, run);
  }

  /// Coordinate of a cell no more than a period beyond the ends of a periodic axis.
  BL_HD int wrapped(int i, int k) const {
    if (!periodic[k]) return i;
    return i < 0 ? i + n[k] : i >= n[k] ? i - n[k] : i;
  }
};

/// Place on the Hilbert curve of each cell of a brick.
const std::array<std::uint16_t, 512>& hilbert_curve();

/// Sorts one phase into cells of at least `cell` (m) over [min, max].
class CellGrid {
 public:
  CellGrid() = default;
  /// block: cells of a block each way: 8, 4, 2 or 1.
  CellGrid(const Frame& frame, const Vec3d& min, const Vec3d& max, double cell, int block = 8);

  /// Divides the blocks among ranks.
  void divide(std::shared_ptr<const Ownership> ownership) { ownership_ = std::move(ownership); }
  const std::shared_ptr<const Ownership>& ownership() const { return ownership_; }  ///< null: all are its own

  /// Cell keys of all x -> order; `order` holds where each sorted particle was. Within a cell they are in the
  /// order of their ids, or as they were without.
  template <class P>
  void sort(const Frame& frame, Span<const P> x, Buffer<Index>& order, Span<const Id> id = {});
  /// x: those sorted, in their new order, and ghosts behind them: the particles of the cells that other ranks
  /// send, rank by rank, in the order of the cells.
  template <class P>
  void add_ghosts(const Frame& frame, Span<const P> x);

  CellGridView view() const;
  /// Those with particles of this rank are the first in the tables.
  Index blocks() const { return blocks_; }
  Index blocks_of_domain() const {
    return Index(shape_.bricks[0]) * shape_.bricks[1] * shape_.bricks[2] << (9 - shape_.block_bits);
  }

 private:
  Index cells() const { return (blocks_ + ghost_blocks()) << shape_.block_bits; }
  Index ghost_blocks() const { return ownership_ ? ownership_->ghost_blocks : 0; }
  template <class P>
  void number_blocks(const Frame& frame, Span<const P> x);
  template <class P>
  void fill_tables(const Frame& frame, Span<const P> x, Span<const Index> order);

  CellGridView shape_;
  Index blocks_ = 0;
  std::shared_ptr<const Ownership> ownership_;
  Buffer<std::uint16_t> curve_;
  Buffer<std::uint32_t> keys_;  ///< of all, sorted
  // those of a domain are made when first looked at
  mutable Buffer<Index> directory_, start_;
  mutable Buffer<std::uint8_t> occupied_nearby_;
};

}  // namespace BL_SOLVER
