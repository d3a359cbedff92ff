#pragma once
// The list of particles of unlike sizes. Each is searched for in its own level and in those of larger ones,
// whose cells are few; what a large one has of smaller ones are the same pairs turned round.

#include "bedload/neighbours/size_levels.hpp"
#include "bedload/neighbours/verlet_list.hpp"

namespace BL_SOLVER {

/// Pairs of the particles of two levels, each counted from the first of its level.
template <class Near>
struct LevelNear {
  Near near;
  Index from_i, from_j;
  BL_HD auto place(Index i) const { return near.place(from_i + i); }
  BL_HD double reach(Index i) const { return near.reach(from_i + i); }
  BL_HD bool operator()(Index i, Index j) const { return near(from_i + i, from_j + j); }
};

/// Pairs of a large particle and a smaller one, found from the smaller one.
class TurnedPairs {
 public:
  void clear();
  /// The entries of a list, each counted from the first of its level.
  void add(const VerletList& found, Index from_i, Index from_j);
  /// By the large ones, of which there are so many; those of one stay in the order of the smaller ones. Adds
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
        const Range rows = levels.particles(own);
        found(own, other)
            .build(rows.size(), levels.grid(other).view(),
                   LevelNear<Near>{near, rows.begin, levels.particles(other).begin});
      }
    join(list, levels, bits);
  }

 private:
  /// Of a level, what is near in a level of larger particles or in the same one.
  VerletList& found(int own, int other) { return found_[std::size_t(own) * (own + 1) / 2 + other]; }
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
  /// of_rows, for `rows` particles of one size: what near(i, j) keeps of sorted particles in several levels.
  /// of_sized: those pairs as back(j, i) keeps them. near.largest: as far as the largest j reach, m, which is
  /// range(radius); cells: of the particles of one size.
  template <class Near, class Reach, class Back>
  void build(VerletList& of_rows, VerletList& of_sized, const SizeLevels& levels, Index rows, Near near,
             const Reach& range, const Back& back, const CellGridView& cells, unsigned row_bits,
             unsigned sized_bits) {
    found_.resize(std::size_t(levels.count()));
    for (int l = 0; l < levels.count(); ++l) {
      near.largest = range(levels.largest(l));
      found_[l].build(rows, levels.grid(l).view().for_reach(near.largest),
                      LevelNear<Near>{near, 0, levels.particles(l).begin});
    }
    const Range smallest = levels.particles(levels.count() - 1);
    of_smallest_.build(smallest.size(), cells, LevelNear<Back>{back, smallest.begin, 0});
    join(of_rows, of_sized, levels, row_bits, sized_bits);
  }

 private:
  void join(VerletList& of_rows, VerletList& of_sized, const SizeLevels& levels, unsigned row_bits,
            unsigned sized_bits);

  std::vector<VerletList> found_;  ///< for each row, in each level
  VerletList of_smallest_;         ///< for each particle of the level of the smallest
  Buffer<std::uint32_t> length_, filled_;
  TurnedPairs turned_;
};

}  // namespace BL_SOLVER
