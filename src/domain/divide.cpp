#include "src/domain/divide.hpp"

#include <algorithm>

#include "bedload/geometry/bisect.hpp"
#include "bedload/parallel/compact.hpp"
#include "bedload/parallel/rank_record.hpp"
#include "bedload/parallel/ranks.hpp"

namespace BL_SOLVER {
namespace {

template <class P>
struct BlockPass {
  CellGridView grid;
  Frame frame;
  Span<const P> x;
  Span<std::uint32_t> block;
  BL_HD void operator()(Index i) const { block[i] = grid.block_of(coordinates(frame, x[i])); }
};

/// 0 for what stays, 1 + rank for what goes there.
template <class P>
struct DestinationPass {
  BlockPass<P> blocks;
  Span<const Index> owner;
  Index rank;
  Span<std::uint32_t> destination;
  BL_HD void operator()(Index i) const {
    const Index to = owner[blocks.grid.block_of(coordinates(blocks.frame, blocks.x[i]))];
    destination[i] = to == rank ? 0 : 1 + to;
  }
};

template <class P>
struct IsOwn {
  CellGridView grid;
  Frame frame;
  Span<const P> x;
  Span<const Index> owner;
  Index rank;
  BL_HD bool operator()(Index i) const { return owner[grid.block_of(coordinates(frame, x[i]))] == rank; }
};

/// Where each number begins among sorted ones.
struct FirstOfPass {
  Span<const std::uint32_t> sorted;
  Span<Index> first;
  BL_HD void operator()(Index number) const { first[number] = first_not_below(sorted, number); }
};

/// Particles of which some stay, and those that came.
struct StayOrComePass {
  Span<const Index> order;
  Index stay, first_come;
  Span<Index> kept;
  BL_HD void operator()(Index i) const { kept[i] = i < stay ? order[i] : first_come + (i - stay); }
};

struct CountCellPass {
  CellGridView grid;
  Span<const std::uint32_t> cell;
  Span<Index> count;
  BL_HD void operator()(Index c) const {
    const std::uint32_t key = grid.key_of(cell[c]);
    count[c] = grid.start[key + 1] - grid.start[key];
  }
};
struct ListCellPass {
  CellGridView grid;
  Span<const std::uint32_t> cell;
  Span<const Index> before, order;
  Span<Index> particle;
  BL_HD void operator()(Index c) const {
    const Index first = grid.start[grid.key_of(cell[c])];
    for (Index k = before[c]; k < before[c + 1]; ++k) {
      const Index place = first + (k - before[c]);
      particle[k] = order ? order[place] : place;
    }
  }
};
struct PickPass {
  Span<const Index> from, at;
  Span<Index> out;
  BL_HD void operator()(Index k) const { out[k] = from[at[k]]; }
};

}  // namespace

template <class P>
void add_loads(const Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x, double each,
               std::vector<double>& load) {
  load.resize(grid.blocks_of_domain());
  std::vector<double> own(load.size());
  Buffer<std::uint32_t>& block = Context::current().scratch<std::uint32_t>(0);
  block.reserve_and_resize(store.owned().size());
  for_each(store.owned(), BlockPass<P>{grid.view(), frame, x, block});
  for (const std::uint32_t b : block.to_host()) ++own[b];
  if (store.divided()) all_reduce(own, [](double& into, double more) { into += more; });
  for (std::size_t b = 0; b < load.size(); ++b) load[b] += each * own[b];
}

namespace {

/// Largest load of a rank over the mean.
double imbalance_of(const std::vector<std::uint16_t>& owner, const std::vector<double>& load) {
  std::vector<double> of_rank(static_cast<std::size_t>(Context::current().ranks()), 0.0);
  double all = 0;
  for (std::size_t b = 0; b < owner.size(); ++b) of_rank[owner[b]] += load[b], all += load[b];
  const double most = *std::max_element(of_rank.begin(), of_rank.end());
  return all > 0 ? most * double(of_rank.size()) / all : 1;
}

}  // namespace

Division divide_blocks(const CellGrid& grid, const std::vector<double>& load, double around,
                       const OtherCells& other) {
  const CellGridView shape = grid.view();
  const auto owner = bisect(block_places(shape), load, Context::current().ranks());
  std::vector<OtherBlocks> others;
  if (around > 0) others.push_back({shape, owner, around});
  CellGridView of_other;
  std::vector<std::uint16_t> other_owner;
  if (other.grid) {
    of_other = other.grid->view();
    other_owner = owners_of(of_other, shape, owner);
    const std::vector<OtherBlocks> around_other{{shape, owner, other.reach}};
    other.grid->divide(std::make_shared<const Ownership>(of_other, other_owner, around_other));
    others.push_back({of_other, other_owner, other.reach});
  }
  const auto ownership = std::make_shared<const Ownership>(shape, owner, others);
  return {ownership, others.empty() ? ownership : std::make_shared<const Ownership>(shape, owner),
          imbalance_of(owner, load)};
}

template <class P>
std::vector<Index> find_own(const Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x) {
  Buffer<Index> own;
  find_all(store.owned().size(),
           IsOwn<P>{grid.view(), frame, x, grid.ownership()->owner, Index(Context::current().rank())}, own);
  return own.to_host();
}

template <class P>
Migrants find_migrants(const Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x) {
  const Context& context = Context::current();
  const Index n = store.owned().size(), ranks = Index(context.ranks());
  Migrants out;
  Buffer<std::uint32_t> destination(n);
  Buffer<Index> first(ranks + 2);
  for_each({0, n},
           DestinationPass<P>{
               {grid.view(), frame, x, {}}, grid.ownership()->owner, Index(context.rank()), destination});
  sort_keys(destination, out.order, 16);
  for_each({0, ranks + 2}, FirstOfPass{destination, first});
  const std::vector<Index> begin = first.to_host();
  out.stay = begin[1];
  rank_record().migrated += n - out.stay;
  for (Index r = 0; r <= ranks; ++r) out.of_rank.push_back(begin[r + 1] - out.stay);
  out.any = all_reduce(n - out.stay, [](Index& into, Index more) { into = max_of(into, more); }) > 0;
  return out;
}

void move(Store& store, const Migrants& migrants, Buffer<Index>& kept, bool whole) {
  const Index n = store.owned().size(), stay = migrants.stay;
  store.make_ghosts(migrants.of_rank, migrants.going());
  kept.resize(stay + (store.size() - n));
  for_each({0, Index(kept.size())}, StayOrComePass{migrants.order, stay, n, kept});
  whole ? store.keep(kept) : store.reorder(kept);
}

void make_ghosts(Store& store, const CellGrid& grid, Span<const Index> order) {
  const Ownership& own = *grid.ownership();
  const Index cells = Index(own.sent_cells.size());
  Buffer<Index> count(cells), before, places, at_rank, begin(own.of_rank.size());
  for_each({0, cells}, CountCellPass{grid.view(), own.sent_cells, count});
  places.resize(exclusive_scan(count, before));
  for_each({0, cells}, ListCellPass{grid.view(), own.sent_cells, before, order, places});
  at_rank.assign(own.of_rank);
  for_each({0, Index(begin.size())}, PickPass{before, at_rank, begin});
  store.make_ghosts(begin.to_host(), places);
}

template <class P>
HostArray blocks_of(const Store& store, const CellGrid& grid, const Frame& frame, Span<const P> x) {
  const Index n = store.owned().size();
  Buffer<std::uint32_t> block(n);
  for_each({0, n}, BlockPass<P>{grid.view(), frame, x, block});
  HostArray out{"block", "-", Scalar::u32, 1, {}};
  out.bytes.resize(n * sizeof(std::uint32_t));
  copy_to_host(out.bytes.data(), block.data(), out.bytes.size());
  return out;
}

#define BL_POSITION(P)                                                                              \
  template void add_loads(const Store&, const CellGrid&, const Frame&, Span<const P>, double,       \
                          std::vector<double>&);                                                    \
  template std::vector<Index> find_own(const Store&, const CellGrid&, const Frame&, Span<const P>); \
  template Migrants find_migrants(const Store&, const CellGrid&, const Frame&, Span<const P>);      \
  template HostArray blocks_of(const Store&, const CellGrid&, const Frame&, Span<const P>);
BL_POSITION(Vec3d)
BL_POSITION(PackedPosition)
#undef BL_POSITION

}  // namespace BL_SOLVER
