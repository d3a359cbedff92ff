#pragma once
// Particles of unlike sizes in levels, each with cells as wide as its own pairs need.

#include <vector>

#include "bedload/neighbours/cell_grid.hpp"

namespace BL_SOLVER {

/// How lists count particles: by level and cell.
struct ListOrder {
  Span<const Index> order;  ///< place in the store of each, ghosts too; empty: as they are stored
  Index own = 0;            ///< the first so many of the store have rows
  Index larger = 0;         ///< of these the first so many are not in the level of the smallest

  BL_HD Index at(Index k) const { return order ? order[k] : k; }
  BL_HD bool has_row(Index place) const { return place < own; }
};

/// Places in the order of lists.
struct InOrderPass {
  Span<const Index> order;
  Span<const Vec3d> x;
  Span<Vec3d> in_order;
  BL_HD void operator()(Index k) const { in_order[k] = x[order[k]]; }
};

class SizeLevels {
 public:
  static constexpr int kMost = 8;

  SizeLevels() = default;
  explicit SizeLevels(const Frame& frame) : frame_(frame) {}

  /// Divides particles of these radii (m), and of those that other ranks give, where lists are found fastest;
  /// largest: what no radius exceeds, m; gap: between particles that are near, m. The same radii give the
  /// same levels in any order and on any ranks.
  void choose(const std::vector<Real>& radius, double largest, double gap);
  /// One level for all.
  void unite();
  bool chosen() const { return !largest_.empty(); }

  int count() const { return int(largest_.size()); }
  /// Radius that none of a level exceeds, m; from the level of the largest particles to that of the smallest.
  double largest(int level) const { return largest_[level]; }

  /// Of several levels: order of the particles by level, then by cell. Within a cell they are in the order of
  /// their ids, or as they were without.
  void sort(Span<const Vec3d> x, Span<const Real> radius, Buffer<Index>& order, Span<const Id> id = {});
  /// Of those sorted, in their new order, and ghosts behind them.
  void add_ghosts(Span<const Vec3d> x, Span<const Real> radius, Span<const Id> id);
  /// After sort: the particles of a level, and their cells, which number them from the first of the level.
  Range particles(int level) const { return {begin_[level], begin_[level + 1]}; }
  const CellGrid& grid(int level) const { return grids_[level]; }
  ListOrder order() const { return {with_ghosts_, own_, larger_}; }
  /// Level of each particle, and number of its cell there: the order of sort, on any ranks.
  void places(Span<const Vec3d> x, Span<const Real> radius, Buffer<std::uint32_t>& level,
              Buffer<std::uint32_t>& cell) const;

 private:
  void arrange(Span<const Vec3d> x, Span<const Real> radius, Buffer<Index>& order, Span<const Id> id);

  struct Level {
    double largest, cell;  ///< radius, m; width of its cells, m
    bool operator==(const Level&) const = default;
  };
  Frame frame_;
  std::vector<double> largest_;
  std::vector<Level> levels_;  ///< those of grids_
  std::vector<CellGrid> grids_;
  std::vector<Index> begin_;
  Buffer<Index> by_level_, in_level_, begins_;
  Buffer<Index> with_ghosts_;  ///< their order, where there are any
  Index own_ = 0, larger_ = 0;
};

}  // namespace BL_SOLVER
