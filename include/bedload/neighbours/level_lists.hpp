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
  Buffer<std::uint32_t> length_, filled_, before_;
  // pairs of a large particle and a smaller one
  Buffer<std::uint32_t> large_;
  Buffer<Index> small_, order_, begin_;
};

}  // namespace BL_SOLVER
