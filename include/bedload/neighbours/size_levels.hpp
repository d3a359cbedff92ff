#pragma once
// Particles of unlike sizes in levels, each with cells as wide as its own pairs need.

#include <vector>

#include "bedload/neighbours/cell_grid.hpp"

namespace BL_SOLVER {

class SizeLevels {
 public:
  static constexpr int kMost = 8;

  SizeLevels() = default;
  explicit SizeLevels(const Frame& frame) : frame_(frame) {}

  /// Divides particles of these radii (m) where lists are found fastest; largest: what no radius exceeds, m;
  /// gap: between particles that are near, m. The same radii give the same levels in any order.
  void choose(const std::vector<Real>& radius, double largest, double gap);
  /// One level for all.
  void unite();
  bool chosen() const { return !largest_.empty(); }

  int count() const { return int(largest_.size()); }
  /// Radius that none of a level exceeds, m; from the level of the largest particles to that of the smallest.
  double largest(int level) const { return largest_[level]; }

  /// Of several levels: order of the particles by level, then by cell.
  void sort(Span<const Vec3d> x, Span<const Real> radius, Buffer<Index>& order);
  /// After sort: the particles of a level, and their cells, which number them from the first of the level.
  Range particles(int level) const { return {begin_[level], begin_[level + 1]}; }
  const CellGrid& grid(int level) const { return grids_[level]; }

 private:
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
};

}  // namespace BL_SOLVER
