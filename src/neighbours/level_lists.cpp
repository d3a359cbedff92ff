#include "bedload/neighbours/level_lists.hpp"

#include <bit>

namespace BL_SOLVER {
namespace {

struct AddLengthPass {
  VerletListView found;
  ListOrder rows;
  Index from;
  Span<std::uint32_t> length;
  BL_HD void operator()(Index i) const {
    if (const Index row = rows.at(from + i); rows.has_row(row)) length[row] += found.count[i];
  }
};

/// How many entries of each row have rows of their own.
struct CountPass {
  VerletListView found;
  ListOrder sources;
  Index from;
  Span<std::uint32_t> count;
  BL_HD void operator()(Index i) const {
    count[i] = sources.order ? 0 : found.count[i];
    if (sources.order)
      found.each(i, [&](std::uint64_t, Index j) { count[i] += sources.has_row(sources.at(from + j)); });
  }
};

/// A place for each of these pairs.
struct TurnPass {
  VerletListView found;
  ListOrder rows, sources;
  Index from_i, from_j;
  Span<const std::uint32_t> before;  ///< pairs of the rows before
  Index at;                          ///< and of the lists before
  Span<std::uint32_t> large;
  Span<Index> small;
  BL_HD void operator()(Index i) const {
    Index place = at + before[i];
    found.each(i, [&](std::uint64_t, Index j) {
      const Index source = sources.at(from_j + j);
      if (!sources.has_row(source)) return;
      large[place] = source;
      small[place++] = rows.at(from_i + i);
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
  ListOrder rows, sources;
  Index from_i, from_j;
  Span<std::uint32_t> filled;
  Index* entry;
  BL_HD void operator()(Index i) const {
    const Index row = rows.at(from_i + i);
    if (!rows.has_row(row)) return;
    std::uint32_t k = filled[row];
    found.each(i, [&](std::uint64_t, Index j) { entry[list.slot(row, k++)] = sources.at(from_j + j); });
    filled[row] = k;
  }
};

void add_lengths(const LevelList& of, Buffer<std::uint32_t>& length) {
  for_each({0, of.found.rows()}, AddLengthPass{of.found.view(), of.rows, of.from_i, length});
}

void append(const LevelList& of, Buffer<std::uint32_t>& filled, VerletList& list) {
  for_each({0, of.found.rows()}, AppendPass{of.found.view(), list.view(), of.rows, of.sources, of.from_i,
                                            of.from_j, filled, list.entries()});
}

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

void TurnedPairs::add(const LevelList& list) {
  const auto& [found, by, sources, from_i, from_j] = list;
  const Index pairs = Index(large_.size());
  const Range rows = {0, found.rows()};
  Buffer<std::uint32_t>& count = Context::current().scratch<std::uint32_t>();
  count.reserve_and_resize(found.rows());
  for_each(rows, CountPass{found.view(), sources, from_j, count});
  const Index more = exclusive_scan(count, before_);
  large_.grow(pairs + more), small_.grow(pairs + more);
  for_each(rows, TurnPass{found.view(), by, sources, from_i, from_j, before_, pairs, large_, small_});
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
    for (int other = 0; other < own; ++other) turned_.add(of(levels, own, other));
  turned_.sort(levels.order().larger, length_);
}

void LevelLists::join(VerletList& list, const SizeLevels& levels, unsigned bits) {
  const Index rows = levels.order().own;
  length_.resize(rows);
  length_.zero();
  for (int own = 0; own < levels.count(); ++own)
    for (int other = 0; other <= own; ++other) add_lengths(of(levels, own, other), length_);
  turn_round(levels);
  list.make_rows(length_, bits);
  filled_.resize(rows);
  filled_.zero();
  for (int own = 0; own < levels.count(); ++own)
    for (int other = 0; other <= own; ++other) append(of(levels, own, other), filled_, list);
  turned_.append(filled_, list);
}

void CrossLevelLists::join(VerletList& of_rows, VerletList& of_sized, const SizeLevels& levels,
                           const ListOrder& rows, unsigned row_bits, unsigned sized_bits) {
  const int count = levels.count();
  length_.resize(rows.own);
  length_.zero();
  for (int l = 0; l < count; ++l) add_lengths(of(levels, rows, l), length_);
  of_rows.make_rows(length_, row_bits);
  filled_.resize(rows.own);
  filled_.zero();
  for (int l = 0; l < count; ++l) append(of(levels, rows, l), filled_, of_rows);

  const ListOrder sized = levels.order();
  length_.resize(sized.own);
  length_.zero();
  add_lengths(of_smallest(levels), length_);
  turned_.clear();
  for (int l = 0; l + 1 < count; ++l) turned_.add(of(levels, rows, l));
  turned_.sort(sized.larger, length_);
  of_sized.make_rows(length_, sized_bits);
  filled_.resize(sized.own);
  filled_.zero();
  turned_.append(filled_, of_sized);
  append(of_smallest(levels), filled_, of_sized);
}

}  // namespace BL_SOLVER
