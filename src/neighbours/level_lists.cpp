#include "bedload/neighbours/level_lists.hpp"

#include <bit>

namespace BL_SOLVER {
namespace {

struct AddLengthPass {
  VerletListView found;
  Index from;
  Span<std::uint32_t> length;
  BL_HD void operator()(Index i) const { length[from + i] += found.count[i]; }
};

struct LengthPass {
  VerletListView found;
  Span<std::uint32_t> length;
  BL_HD void operator()(Index i) const { length[i] = found.count[i]; }
};

/// A place for each pair of a row.
struct TurnPass {
  VerletListView found;
  Index from_i, from_j;
  Span<const std::uint32_t> before;  ///< pairs of the rows before
  Index at;                          ///< and of the lists before
  Span<std::uint32_t> large;
  Span<Index> small;
  BL_HD void operator()(Index i) const {
    Index place = at + before[i];
    found.each(i, [&](std::uint64_t, Index j) {
      large[place] = from_j + j;
      small[place++] = from_i + i;
    });
  }
};

struct BeginPass {
  Span<const std::uint32_t> large;
  Span<Index> begin;
  BL_HD void operator()(Index j) const { begin[j] = first_not_below(large, j); }
};

struct AddTurnedPass {
  Span<const Index> begin;
  Span<std::uint32_t> length;
  BL_HD void operator()(Index j) const { length[j] += begin[j + 1] - begin[j]; }
};

/// Appends the rows of one list to those of another.
struct AppendPass {
  VerletListView found, list;
  Index from_i, from_j;
  Span<std::uint32_t> filled;
  Index* entry;
  BL_HD void operator()(Index i) const {
    std::uint32_t k = filled[from_i + i];
    found.each(i, [&](std::uint64_t, Index j) { entry[list.slot(from_i + i, k++)] = from_j + j; });
    filled[from_i + i] = k;
  }
};

struct AppendTurnedPass {
  Span<const std::uint32_t> large;
  Span<const Index> small, order, begin;
  Span<const std::uint32_t> filled;
  VerletListView list;
  Index* entry;
  BL_HD void operator()(Index p) const {
    const Index j = large[p];
    entry[list.slot(j, filled[j] + (p - begin[j]))] = small[order[p]];
  }
};

}  // namespace

void LevelLists::turn_round(const SizeLevels& levels) {
  Index pairs = 0;
  for (int own = 1; own < levels.count(); ++own)
    for (int other = 0; other < own; ++other) {
      const VerletList& list = found(own, other);
      const Range rows = {0, list.rows()};
      filled_.resize(list.rows());
      for_each(rows, LengthPass{list.view(), filled_});
      const Index more = exclusive_scan(filled_, before_);
      large_.grow(pairs + more), small_.grow(pairs + more);
      for_each(rows, TurnPass{list.view(), levels.particles(own).begin, levels.particles(other).begin,
                              before_, pairs, large_, small_});
      pairs += more;
    }
  // those of one large particle stay in the order of the smaller ones
  const Index larger = levels.particles(levels.count() - 1).begin;
  large_.grow(pairs);
  sort_keys(large_, order_, std::bit_width(larger));
  begin_.resize(larger + 1);
  for_each({0, larger + 1}, BeginPass{large_, begin_});
  for_each({0, larger}, AddTurnedPass{begin_, length_});
}

void LevelLists::join(VerletList& list, const SizeLevels& levels, unsigned bits) {
  const Index particles = levels.particles(levels.count() - 1).end;
  length_.resize(particles);
  length_.zero();
  for (int own = 0; own < levels.count(); ++own)
    for (int other = 0; other <= own; ++other)
      for_each({0, found(own, other).rows()},
               AddLengthPass{found(own, other).view(), levels.particles(own).begin, length_});
  turn_round(levels);
  list.make_rows(length_, bits);
  filled_.resize(particles);
  filled_.zero();
  for (int own = 0; own < levels.count(); ++own)
    for (int other = 0; other <= own; ++other)
      for_each({0, found(own, other).rows()},
               AppendPass{found(own, other).view(), list.view(), levels.particles(own).begin,
                          levels.particles(other).begin, filled_, list.entries()});
  for_each({0, Index(large_.size())},
           AppendTurnedPass{large_, small_, order_, begin_, filled_, list.view(), list.entries()});
}

}  // namespace BL_SOLVER
