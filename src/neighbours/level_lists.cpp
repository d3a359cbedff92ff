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

void TurnedPairs::clear() { large_.resize(0), small_.resize(0); }

void TurnedPairs::add(const VerletList& found, Index from_i, Index from_j) {
  const Index pairs = Index(large_.size());
  const Range rows = {0, found.rows()};
  Buffer<std::uint32_t>& count = Context::current().scratch<std::uint32_t>();
  count.reserve_and_resize(found.rows());
  for_each(rows, LengthPass{found.view(), count});
  const Index more = exclusive_scan(count, before_);
  large_.grow(pairs + more), small_.grow(pairs + more);
  for_each(rows, TurnPass{found.view(), from_i, from_j, before_, pairs, large_, small_});
}

void TurnedPairs::sort(Index larger, Buffer<std::uint32_t>& length) {
  sort_keys(large_, order_, std::bit_width(larger));
  begin_.resize(larger + 1);
  for_each({0, larger + 1}, BeginPass{large_, begin_});
  for_each({0, larger}, AddTurnedPass{begin_, length});
}

void TurnedPairs::append(const Buffer<std::uint32_t>& filled, VerletList& list) const {
  for_each({0, Index(large_.size())},
           AppendTurnedPass{large_, small_, order_, begin_, filled, list.view(), list.entries()});
}

void LevelLists::turn_round(const SizeLevels& levels) {
  turned_.clear();
  for (int own = 1; own < levels.count(); ++own)
    for (int other = 0; other < own; ++other)
      turned_.add(found(own, other), levels.particles(own).begin, levels.particles(other).begin);
  turned_.sort(levels.particles(levels.count() - 1).begin, length_);
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
  turned_.append(filled_, list);
}

void CrossLevelLists::join(VerletList& of_rows, VerletList& of_sized, const SizeLevels& levels,
                           unsigned row_bits, unsigned sized_bits) {
  const int count = levels.count();
  const Index rows = found_[0].rows();
  length_.resize(rows);
  length_.zero();
  for (int l = 0; l < count; ++l) for_each({0, rows}, AddLengthPass{found_[l].view(), 0, length_});
  of_rows.make_rows(length_, row_bits);
  filled_.resize(rows);
  filled_.zero();
  for (int l = 0; l < count; ++l)
    for_each({0, rows}, AppendPass{found_[l].view(), of_rows.view(), 0, levels.particles(l).begin, filled_,
                                   of_rows.entries()});

  const auto [smallest, end] = levels.particles(count - 1);
  length_.resize(end);
  length_.zero();
  for_each({0, of_smallest_.rows()}, AddLengthPass{of_smallest_.view(), smallest, length_});
  turned_.clear();
  for (int l = 0; l + 1 < count; ++l) turned_.add(found_[l], 0, levels.particles(l).begin);
  turned_.sort(smallest, length_);
  of_sized.make_rows(length_, sized_bits);
  filled_.resize(end);
  filled_.zero();
  turned_.append(filled_, of_sized);
  for_each({0, of_smallest_.rows()},
           AppendPass{of_smallest_.view(), of_sized.view(), smallest, 0, filled_, of_sized.entries()});
}

}  // namespace BL_SOLVER
