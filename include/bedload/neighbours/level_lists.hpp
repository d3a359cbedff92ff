#pragma once
// The list of particles of unlike sizes. Each is searched for in its own level and in those of larger ones,
// whose cells are few; what a large one has of smaller ones are the same pairs turned round.

#include "bedload/neighbours/size_levels.hpp"
#include "bedload/neighbours/verlet_list.hpp"

namespace BL_SOLVER {

/// Pairs of the particles of two levels, each counted from the first of its level, of which one has a row.
template <class Near>
struct LevelNear {
  Near near;
  ListOrder rows, sources;
  Index from_i, from_j;
  BL_HD auto place(Index i) const { return near.place(rows.at(from_i + i)); }
  BL_HD double reach(Index i) const { return near.reach(rows.at(from_i + i)); }
  BL_HD bool operator()(Index i, Index j) const {
    const Index a = rows.at(from_i + i), b = sources.at(from_j + j);
    return (rows.has_row(a) || sources.has_row(b)) && near(a, b);
  }
};

/// A list of the particles of one level near those of another, or of another phase.
struct LevelList {
  const VerletList& found;
  ListOrder rows, sources;
  Index from_i, from_j;
};

/// Pairs of a large particle and a smaller one, found from the smaller one.
class TurnedPairs {
 public:
  void clear();
  /// Those of a list whose large particle has a row.
  void add(const LevelList& list);
  /// By the large ones, which are the first so many; those of one stay in the order of the smaller ones. Adds
  /// how many each has to its length.
  void sort(Index larger, Buffer<std::uint32_t>& length);
  /// To the rows of the large ones, which are filled that far.
  void append(const Buffer<std::uint32_t>& filled, VerletList& list) const;

 private:
  Buffer<std::uint32_t> before_, large_;
  Buffer<Index> small_, order_, begin_;
};

class LevelLists {
 public:
  /// Into `list`, what near(i, j) keeps, of sorted particles in several levels; near.largest: radius of the
  /// largest j, m. Rows hold larger particles first, then those of their own level, then smaller ones.
  template <class Near>
  void build(VerletList& list, const SizeLevels& levels, Near near, unsigned bits) {
    found_.resize(std::size_t(levels.count()) * (levels.count() + 1) / 2);
    for (int own = 0; own < levels.count(); ++own)
      for (int other = 0; other <= own; ++other) {
        near.largest = levels.largest(other);
        const LevelList of = this->of(levels, own, other);
        found(own, other)
            .build(levels.particles(own).size(), levels.grid(other).view(),
                   LevelNear<Near>{near, of.rows, of.sources, of.from_i, of.from_j});
      }
    join(list, levels, bits);
  }

 private:
  /// Of a level, what is near in a level of larger particles or in the same one.
  VerletList& found(int own, int other) { return found_[std::size_t(own) * (own + 1) / 2 + other]; }
  LevelList of(const SizeLevels& levels, int own, int other) {
    ListOrder sources = levels.order();
    if (own == other) sources.own = 0;  // these pairs are not turned round
    return {found(own, other), levels.order(), sources, levels.particles(own).begin,
            levels.particles(other).begin};
  }
  void join(VerletList& list, const SizeLevels& levels, unsigned bits);
  void turn_round(const SizeLevels& levels);

  std::vector<VerletList> found_;
  Buffer<std::uint32_t> length_, filled_;
  TurnedPairs turned_;
};

/// Lists across two phases, of which one has particles of unlike sizes that act the farther the larger they
/// are. The other phase looks for those of each level; what large ones have are these pairs turned round.
class CrossLevelLists {
 public:
  /// of_rows, for particles of one size, `all` of them with ghosts: what near(i, j) keeps of sorted particles
  /// in several levels. of_sized: those pairs as back(j, i) keeps them. near.largest: as far as the largest j
  /// reach, m, which is range(radius); cells: of the particles of one size.
  template <class Near, class Reach, class Back>
  void build(VerletList& of_rows, VerletList& of_sized, const SizeLevels& levels, const ListOrder& rows,
             Index all, Near near, const Reach& range, const Back& back, const CellGridView& cells,
             unsigned row_bits, unsigned sized_bits) {
    found_.resize(std::size_t(levels.count()));
    for (int l = 0; l < levels.count(); ++l) {
      near.largest = range(levels.largest(l));
      const LevelList of = this->of(levels, rows, l);
      found_[l].build(l + 1 < levels.count() ? all : rows.own, levels.grid(l).view().for_reach(near.largest),
                      LevelNear<Near>{near, of.rows, of.sources, of.from_i, of.from_j});
    }
    const LevelList of = of_smallest(levels);
    of_smallest_.build(levels.order().own - levels.order().larger, cells,
                       LevelNear<Back>{back, of.rows, of.sources, of.from_i, of.from_j});
    join(of_rows, of_sized, levels, rows, row_bits, sized_bits);
  }

 private:
  LevelList of(const SizeLevels& levels, ListOrder rows, int level) const {
    ListOrder sources = levels.order();
    if (level + 1 == levels.count()) rows.order = {}, sources.own = 0;  // these pairs are not turned round
    return {found_[level], rows, sources, 0, levels.particles(level).begin};
  }
  LevelList of_smallest(const SizeLevels& levels) const {
    const ListOrder sized = levels.order();
    return {of_smallest_, {{}, sized.own}, {}, sized.larger, 0};
  }
  void join(VerletList& of_rows, VerletList& of_sized, const SizeLevels& levels, const ListOrder& rows,
            unsigned row_bits, unsigned sized_bits);

  std::vector<VerletList> found_;  ///< for each row, in each level
  VerletList of_smallest_;         ///< for each particle of the level of the smallest
  Buffer<std::uint32_t> length_, filled_;
  TurnedPairs turned_;
};

}  // namespace BL_SOLVER
