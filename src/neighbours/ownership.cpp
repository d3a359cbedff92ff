#include "bedload/neighbours/ownership.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "bedload/neighbours/cell_grid.hpp"

namespace BL_SOLVER {
namespace {

/// The blocks of a domain and the cells in them, on the host.
class Blocks {
 public:
  explicit Blocks(const CellGridView& grid) : grid_(grid), side_(1 << grid.block_bits / 3) {
    const auto& curve = hilbert_curve();
    grid_.curve = curve.data();
    for (int cell = 0; cell < 512; ++cell) cell_[curve[std::size_t(cell)]] = cell;
  }
  std::uint32_t cells() const { return 1u << grid_.block_bits; }

  using Cell = std::array<int, 3>;
  Cell cell(std::uint32_t number) const {
    const std::uint32_t brick = number / 512;
    const int in_brick = cell_[number % 512];
    return {int(brick % grid_.bricks[0]) * 8 + in_brick % 8,
            int(brick / grid_.bricks[0] % grid_.bricks[1]) * 8 + in_brick / 8 % 8,
            int(brick / grid_.bricks[0] / grid_.bricks[1]) * 8 + in_brick / 64};
  }
  /// Block in a direction from -1 to 1 along each axis; kNone where the domain ends.
  Index beside(Index block, const int (&direction)[3]) const {
    const Cell first = corner(block);
    int at[3];
    for (int k = 0; k < 3; ++k) {
      at[k] = direction[k] < 0 ? first[k] - 1 : direction[k] > 0 ? first[k] + side_ : first[k];
      if (direction[k] > 0) at[k] = std::min(at[k], grid_.n[k]);
      if (at[k] < 0 || at[k] >= grid_.n[k]) {
        if (!grid_.periodic[k]) return kNone;
        at[k] = at[k] < 0 ? grid_.n[k] - 1 : 0;
      }
    }
    return grid_.number(at[0], at[1], at[2]) >> grid_.block_bits;
  }
  /// Whether a cell of a block is at the border to its neighbour in a direction.
  bool faces(Index block, std::uint32_t number, const int (&direction)[3]) const {
    const Cell first = corner(block), here = cell(number);
    for (int k = 0; k < 3; ++k) {
      if (here[k] >= grid_.n[k]) return false;  // bricks go beyond the last cells
      const int last = std::min(first[k] + side_, grid_.n[k]) - 1;
      if (direction[k] < 0 && here[k] != first[k]) return false;
      if (direction[k] > 0 && here[k] != last) return false;
    }
    return true;
  }
  std::array<int, 3> place(Index block) const {
    const Cell first = corner(block);
    return {first[0] / side_, first[1] / side_, first[2] / side_};
  }
  /// Number of the block at that place.
  Index at(const std::array<int, 3>& place) const {
    return grid_.number(place[0] * side_, place[1] * side_, place[2] * side_) >> grid_.block_bits;
  }
  int along(int k) const { return (grid_.n[k] + side_ - 1) / side_; }  ///< blocks
  /// From where to where a block, or a cell, reaches along axis k, m. What is outside the domain belongs to
  /// its last cells.
  using Extent = std::array<double, 2>;
  Extent extent(int block, int k) const {
    return from_to(block * side_, std::min((block + 1) * side_, grid_.n[k]), k);
  }
  Extent extent_of_cell(std::uint32_t number, int k) const {
    const int c = cell(number)[k];
    return from_to(c, c + 1, k);
  }
  /// Distance between two extents along axis k, m.
  double gap(const Extent& a, const Extent& b, int k) const {
    double least = std::numeric_limits<double>::infinity();
    const double period = grid_.n[k] / grid_.inverse[k];
    for (int image = grid_.periodic[k] ? -1 : 0; image <= (grid_.periodic[k] ? 1 : 0); ++image) {
      const double shift = image == 0 ? 0 : image * period;
      least = std::min(least, std::max({0.0, b[0] + shift - a[1], a[0] - b[1] - shift}));
    }
    return least;
  }
  Vec3d middle(Index block) const {
    Vec3d out;
    const auto place = this->place(block);
    for (int k = 0; k < 3; ++k) {
      const int first = place[k] * side_, last = std::min(first + side_, grid_.n[k]);
      out[k] = grid_.origin[k] + 0.5 * (first + last) / grid_.inverse[k];
    }
    return out;
  }
  /// Whether a cell is in the domain: bricks go beyond its last cells.
  bool holds(std::uint32_t number) const {
    const Cell c = cell(number);
    return c[0] < grid_.n[0] && c[1] < grid_.n[1] && c[2] < grid_.n[2];
  }
  /// Whether any cell of it is in the domain.
  bool inside(Index block) const {
    const Cell first = corner(block);
    return first[0] < grid_.n[0] && first[1] < grid_.n[1] && first[2] < grid_.n[2];
  }

 private:
  Extent from_to(int first, int end, int k) const {
    constexpr double anywhere = std::numeric_limits<double>::infinity();
    const bool below = !grid_.periodic[k] && first == 0, above = !grid_.periodic[k] && end == grid_.n[k];
    return {below ? -anywhere : grid_.origin[k] + first / grid_.inverse[k],
            above ? anywhere : grid_.origin[k] + end / grid_.inverse[k]};
  }
  Cell corner(Index block) const {
    Cell low = cell(block << grid_.block_bits);  // the curve may begin at any corner
    for (int& c : low) c = c / side_ * side_;
    return low;
  }
  CellGridView grid_;
  int side_;
  std::array<int, 512> cell_{};
};

/// f(direction, block) for the blocks around one.
template <class F>
void each_beside(const Blocks& blocks, Index block, const F& f) {
  for (int q = 0; q < 27; ++q) {
    const int direction[3] = {q % 3 - 1, q / 3 % 3 - 1, q / 9 - 1};
    if (q == 13) continue;
    if (const Index other = blocks.beside(block, direction); other != kNone) f(direction, other);
  }
}

/// Blocks of another phase within reach of one.
class InReach {
 public:
  InReach(const Blocks& blocks, const OtherBlocks& other)
      : blocks_(blocks), others_(other.grid), reach2_(square((1 + 1e-9) * other.reach)) {
    for (int k = 0; k < 3; ++k)
      for (int at = 0; at < blocks.along(k); ++at) {
        auto& near = near_[std::size_t(k)].emplace_back();
        for (int other_at = 0; other_at < others_.along(k); ++other_at) {
          const double gap2 = square(blocks.gap(blocks.extent(at, k), others_.extent(other_at, k), k));
          if (gap2 < reach2_) near.push_back({other_at, gap2});
        }
      }
  }

  /// f(number of the other block, place) for those of a block.
  template <class F>
  void each(Index block, const F& f) const {
    const auto place = blocks_.place(block);
    const auto near = [&](int k) -> const std::vector<Near>& {
      return near_[std::size_t(k)][std::size_t(place[std::size_t(k)])];
    };
    for (const Near& x : near(0))
      for (const Near& y : near(1))
        for (const Near& z : near(2)) {
          const std::array<int, 3> at{x.at, y.at, z.at};
          if (x.gap2 + y.gap2 + z.gap2 < reach2_) f(others_.at(at), at);
        }
  }
  /// Whether a cell is in reach of the other block at that place.
  bool near(std::uint32_t cell, const std::array<int, 3>& place) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k)
      sum +=
          square(blocks_.gap(blocks_.extent_of_cell(cell, k), others_.extent(place[std::size_t(k)], k), k));
    return sum < reach2_;
  }

 private:
  struct Near {
    int at;
    double gap2;
  };
  const Blocks& blocks_;
  Blocks others_;
  double reach2_;
  std::array<std::vector<std::vector<Near>>, 3> near_;  ///< [axis][place of a block]
};

}  // namespace

std::vector<std::uint16_t> owners_of(const CellGridView& blocks, const CellGridView& owned,
                                     const std::vector<std::uint16_t>& owner) {
  const Blocks of(blocks);
  CellGridView in = owned;
  in.curve = hilbert_curve().data();
  std::vector<std::uint16_t> out(block_places(blocks).size());
  for (Index b = 0; b < out.size(); ++b)
    if (of.inside(b)) out[b] = owner[in.block_of(of.middle(b))];
  return out;
}

Ownership::Ownership(const CellGridView& grid, const std::vector<std::uint16_t>& owners,
                     const std::vector<OtherBlocks>& others) {
  const Blocks blocks(grid);
  std::vector<InReach> in_reach;
  in_reach.reserve(others.size());
  for (const OtherBlocks& other : others) in_reach.emplace_back(blocks, other);
  const Index n = Index(owners.size());
  const std::size_t ranks = std::size_t(Context::current().ranks());
  const auto me = std::uint16_t(Context::current().rank());
  std::vector<std::vector<std::uint32_t>> sent(ranks);
  std::vector<std::vector<Index>> ghosts(ranks);
  std::vector<Index> is_beside(n, 0), place(n, kNone);
  for (Index b = 0; b < n; ++b) {
    if (!blocks.inside(b)) continue;
    const std::uint16_t own = owners[b];
    std::vector<std::vector<bool>> wanted(ranks);  // cells of the block, by who wants them
    bool ghost = false;
    each_beside(blocks, b, [&](const int(&direction)[3], Index other) {
      const std::uint16_t to = owners[other];
      if (to == own || (own != me && to != me)) return;
      ghost = ghost || own != me;
      if (own != me) return;
      wanted[to].resize(blocks.cells());
      for (std::uint32_t c = 0; c < blocks.cells(); ++c)
        if (blocks.faces(b, (b << grid.block_bits) + c, direction)) wanted[to][c] = true;
    });
    for (std::size_t k = 0; k < others.size(); ++k)
      in_reach[k].each(b, [&](Index near, const std::array<int, 3>& place) {
        const std::uint16_t to = others[k].owner[near];
        if (to == own || (own != me && to != me)) return;
        ghost = ghost || own != me;
        if (own != me) return;
        wanted[to].resize(blocks.cells());
        for (std::uint32_t c = 0; c < blocks.cells(); ++c) {
          const std::uint32_t cell = (b << grid.block_bits) + c;
          if (!wanted[to][c] && blocks.holds(cell) && in_reach[k].near(cell, place)) wanted[to][c] = true;
        }
      });
    for (std::size_t r = 0; r < ranks; ++r)
      for (std::uint32_t c = 0; c < wanted[r].size(); ++c)
        if (wanted[r][c]) sent[r].push_back((b << grid.block_bits) + c);
    if (!ghost) continue;
    ghosts[own].push_back(b);
    each_beside(blocks, b, [&](const int(&)[3], Index other) { is_beside[other] = 1; });
  }
  of_rank.push_back(0);
  std::vector<std::uint32_t> cells;
  for (std::size_t r = 0; r < ranks; ++r) {
    cells.insert(cells.end(), sent[r].begin(), sent[r].end());
    of_rank.push_back(Index(cells.size()));
    for (const Index b : ghosts[r]) place[b] = ghost_blocks++;
  }
  sent_cells.assign(cells);
  owner.assign({owners.begin(), owners.end()});
  ghost_place.assign(place);
  beside.assign(is_beside);
}

std::vector<std::array<int, 3>> block_places(const CellGridView& grid) {
  const Blocks blocks(grid);
  std::vector<std::array<int, 3>> places(std::size_t(grid.bricks[0]) * grid.bricks[1] * grid.bricks[2]
                                         << (9 - grid.block_bits));
  for (std::size_t b = 0; b < places.size(); ++b) places[b] = blocks.place(Index(b));
  return places;
}

}  // namespace BL_SOLVER
