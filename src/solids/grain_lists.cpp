// The list of near grains when it is renewed; and which rank has which grains, with their contacts.

#include <algorithm>
#include <cstring>
#include <numeric>

#include "bedload/parallel/ranks.hpp"
#include "src/solids/arriving_contacts.hpp"
#include "src/solids/solid_solver.hpp"

namespace BL_SOLVER {
namespace {

struct WrapGrains {
  GrainFrame frame;
  Span<Vec3d> x;
  Span<Real3> v;
  BL_HD void operator()(Index i) const {
    Vec3d at = x[i];
    if (frame.shear.acts()) {
      Real3 u = v[i];
      frame.shear.wrap(at, u);
      v[i] = u;
    }
    x[i] = frame.wrap(at);
  }
};

/// Positions by which grains of a sheared box are sorted.
struct ListedPlacesPass {
  GrainFrame frame;
  Span<const Vec3d> x;
  Span<Vec3d> out;
  BL_HD void operator()(Index i) const { out[i] = frame.listed(x[i]); }
};

/// Composes the order of a sort with what was before it: former indices as of the last lists.
struct SourceIndexPass {
  Span<const Index> kept;  ///< of what moved between ranks; empty where nothing did
  Index before;            ///< of grains before that: those from there on have come
  Span<const Index> source_index;
  Span<Index> order;
  BL_HD void operator()(Index i) const {
    Index place = order[i];
    if (kept) place = kept[place];
    order[i] = kept && place >= before ? kNone : source_index ? source_index[place] : place;
  }
};

/// Pairs in contact in the rows of some grains.
struct CountTouchingPass {
  Span<const Index> grain, rows;
  VerletListView list;
  PairHistories histories;
  Span<Index> count;
  BL_HD Index row(Index k) const { return rows ? rows[grain[k]] : grain[k]; }
  BL_HD void operator()(Index k) const {
    if (row(k) == kNone) return;
    list.each(row(k), [&](std::uint64_t slot, Index) { count[k] += histories.touching[slot]; });
  }
};

struct RecordTouchingPass {
  CountTouchingPass touching;
  Span<const Index> before;  ///< records of the grains before
  Span<const Id> id;         ///< of the entries of the list
  Span<Id> own, other;
  Span<ContactHistory> history;
  const OpenContact* losses;  ///< by slots, may be null
  Span<OpenContact> loss;
  BL_HD void operator()(Index k) const {
    const Index row = touching.row(k);
    if (row == kNone) return;
    Index record = before[k];
    touching.list.each(row, [&](std::uint64_t slot, Index j) {
      if (!touching.histories.touching[slot]) return;
      own[record] = id[row], other[record] = id[j];
      if (losses) loss[record] = losses[slot];
      history[record++] = touching.histories[slot];
    });
  }
};

/// Puts records into the rows of grains that had none before.
struct SettleContactsPass {
  Span<const Index> had_row;
  Span<const Id> id;
  Span<const std::uint32_t> own;  ///< ascending
  Span<const Index> record;
  Span<const Id> other;
  Span<const ContactHistory> history;
  Span<const OpenContact> loss;
  VerletListView list;
  PairHistories histories;
  OpenContact* losses;  ///< by slots, may be null
  BL_HD void operator()(Index i) const {
    if (had_row[i] != kNone) return;
    for (Index k = first_not_below(own, id[i]); k < own.size && own[k] == id[i]; ++k)
      list.each(i, [&](std::uint64_t slot, Index j) {
        if (id[j] != other[record[k]]) return;
        histories.store(slot, history[record[k]]);
        histories.touching[slot] = 1;
        if (losses) losses[slot] = loss[record[k]];
      });
  }
};

}  // namespace

void ArrivingContacts::send(const Migrants& migrants, Span<const Index> rows, const VerletListView& list,
                            bool listed, const PairHistories& histories, Span<const Id> id,
                            const OpenContact* losses) {
  const Index grains = migrants.going().size;
  Buffer<Index> count(grains), before, places;
  const CountTouchingPass touching{migrants.going(), rows, list, histories, count};
  if (listed) for_each({0, grains}, touching);
  const Index n = exclusive_scan(count, before);
  records_.resize(n);
  if (listed)
    for_each({0, grains}, RecordTouchingPass{touching, before, id, records_.own, records_.other,
                                             records_.history, losses, records_.loss});
  records_.count();
  const std::vector<Index> first = before.to_host();
  std::vector<Index> of_rank;
  for (const Index grain : migrants.of_rank) of_rank.push_back(first[grain]);
  places.resize(n);
  for_each({0, n}, FillIndex{places});
  records_.make_ghosts(of_rank, places);
  const Index come = records_.size() - n;
  own_.reserve_and_resize(come);
  copy_on_device(own_.data(), records_.own.entry(n), come * sizeof(Id));
  sort_keys(own_, order_, 32);
}

void ArrivingContacts::settle(Range grains, Span<const Index> order, Span<const Id> id,
                              const VerletListView& list, const PairHistories& histories,
                              OpenContact* losses) {
  if (own_.size() == 0) return;
  const Range come{records_.owned().end, records_.size()};
  for_each(grains,
           SettleContactsPass{order,
                              id,
                              own_,
                              order_,
                              {records_.other.span().data + come.begin, come.size()},
                              {records_.history.span().data + come.begin, come.size()},
                              {losses ? records_.loss.span().data + come.begin : nullptr, come.size()},
                              list,
                              histories,
                              losses});
  own_.resize(0);
}

void SolidSolver::refresh(GrainStore& grains, CellGrid& grid, const GrainRenewal& renewal) {
  const double period = frame_.length.x / frame_.length.z;
  if (frame_.shear.acts())
    listed_strain_ = frame_.shear.strain -= period * std::rint(frame_.shear.strain / period);
  for_each(grains.owned(), WrapGrains{frame_, grains.x, grains.v});
  if (renewal.any || !levels_.chosen()) choose_levels(grains);
  if (Context::current().several() && !follows_ && unbalanced(grains)) divide(grains, grid, grains.x);
  relist(grains, grid, grains.x, renewal);
}

void SolidSolver::relist(GrainStore& grains, CellGrid& grid, const Field<Vec3d>& x,
                         const GrainRenewal& renewal) {
  const bool several = Context::current().several(), moved = &x != &grains.x_list;
  const Index before = grains.owned().size();
  const bool listed = list_.rows() == (renewal.any ? renewal.before : before);
  const Span<const Index> source_index = renewal.any ? renewal.source_index : Span<const Index>();
  Buffer<Index> kept;
  if (several) migrate(grains, grid, x, source_index, listed, kept);
  sort(x.span(), grains, grid);
  moved ? grains.reorder(order_) : grains.keep(order_);
  grains.count();
  if (kept.data() || renewal.any)
    for_each(grains.owned(), SourceIndexPass{kept, before, source_index, order_});
  if (several) make_ghosts_of(grains, grid, x);
  if (moved) grains.x_list.copy(grains.x);
  std::swap(list_, old_list_);
  listed_id_.swap(former_id_);
  histories_.swap(old_histories_);
  if (spectra_) spectra_->put_aside();
  build_list(grains, grid);
  if (!listed) return;
  OpenContact* const losses = spectra_ ? spectra_->of_pairs().data() : nullptr;
  const CarryHistoryPass carry{.from = old_list_.view(),
                               .to = list_.view(),
                               .long_rows = long_rows_.view(),
                               .order = order_,
                               .former_id = former_id_,
                               .id = listed_id_,
                               .old_histories = old_histories_.view(),
                               .histories = histories_.view(),
                               .old_losses = spectra_ ? spectra_->old_of_pairs() : nullptr,
                               .losses = losses};
  for_each(grains.owned(), carry);
  for_each({0, long_rows_.pieces() * LongRowsView::kPiece}, CarryLongHistoryPass{carry});
  if (several) arriving_->settle(grains.owned(), order_, listed_id_, list_.view(), histories_.view(), losses);
}

void SolidSolver::choose_levels(const GrainStore& grains) {
  if (parameters_.d_max < 2 * parameters_.d_min)
    levels_.unite();
  else
    levels_.choose(grains.radius.values(), parameters_.d_max / 2, skin());
}

void SolidSolver::sort(Span<const Vec3d> x, const GrainStore& grains, CellGrid& grid) {
  if (in_levels()) return levels_.sort(x, grains.radius.span(), order_, grains.id);
  if (!frame_.shear.acts()) return grid.sort<Vec3d>(frame_, x, order_, grains.id);
  Buffer<Vec3d> places(x.size);
  for_each({0, x.size}, ListedPlacesPass{as_listed(), x, places});
  grid.sort<Vec3d>(frame_, std::as_const(places).span(), order_, grains.id);
}

GrainFrame SolidSolver::as_listed() const {
  GrainFrame frame = frame_;
  frame.shear.strain = listed_strain_;
  return frame;
}

void SolidSolver::build_list(const GrainStore& grains, const CellGrid& grid) {
  clumps_.place(grains);
  GrainNear near{.frame = as_listed(),
                 .x = grains.x_list.span(),
                 .radius = grains.radius.span(),
                 .clump = clumps_.of_grains(),
                 .largest = 0.5 * parameters_.d_max,
                 .skin = skin(),
                 .range = range_beyond(parameters_.pair_laws, 1),
                 .stretch = as_listed().stretch()};
  // few lanes: rows are short, and contacts use so many registers that more threads would not run at once
  const unsigned bits = std::min(lane_bits(Index(grains.everywhere()), 3u << 14), 3u);
  if (in_levels())
    level_lists_.build(list_, levels_, near, bits);
  else
    list_.build(grains.owned().size(), grid.view(), near, bits);
  long_rows_.cut(list_, in_levels() ? levels_.order().larger : 0);
  by_pieces_.reserve_and_resize(long_rows_.pieces());
  near.range = 0;
  for_each(grains.owned(), ContactsFirstPass{near, list_.view(), long_rows_.view(), list_.entries()});
  histories_.reset(list_.slots());
  listed_id_.reserve_and_resize(grains.size());
  copy_on_device(listed_id_.data(), grains.id.span().data, grains.size() * sizeof(Id));
  listed_by_ = grid.ownership();
  wall_list_.forget();
  if (spectra_) spectra_->renew(list_.slots());
  if (forces_) forces_->forget();
}

void SolidSolver::divide(const GrainStore& grains, CellGrid& grid, Span<const Vec3d> x) {
  std::vector<double> load;
  add_loads(grains, grid, frame_, x, 1, load);
  const Division division = divide_blocks(grid, load);
  imbalance_ = division.imbalance;
  grid.divide(division.ownership);
}

void SolidSolver::regroup(GrainStore& grains, CellGrid& grid) {
  if (grid.ownership() == listed_by_) return;
  grains.drop_ghosts();
  relist(grains, grid, grains.x_list, {});
}

bool SolidSolver::unbalanced(const GrainStore& grains) const {
  const std::vector<Index> of_rank = all_gather(grains.owned().size());
  const double most = *std::max_element(of_rank.begin(), of_rank.end()),
               all = std::accumulate(of_rank.begin(), of_rank.end(), 0.0);
  return most * Context::current().ranks() > 1.1 * imbalance_ * all;
}

void SolidSolver::migrate(GrainStore& grains, CellGrid& grid, const Field<Vec3d>& x,
                          Span<const Index> source_index, bool listed, Buffer<Index>& kept) {
  const Migrants migrants = find_migrants(grains, grid, frame_, x.span());
  if (!migrants.any) return;
  arriving_->send(migrants, source_index, list_.view(), listed, histories_.view(), listed_id_,
                  spectra_ ? spectra_->of_pairs().data() : nullptr);
  const Index before = grains.owned().size();
  wall_list_.send(migrants);
  move(grains, migrants, kept, &x == &grains.x_list);
  wall_list_.settle(before, kept);
}

void SolidSolver::make_ghosts_of(GrainStore& grains, CellGrid& grid, const Field<Vec3d>& x) {
  if (!in_levels()) {
    make_ghosts(grains, grid);
    return grid.add_ghosts(frame_, x.span());
  }
  grid.sort<Vec3d>(frame_, x.span(), by_cells_);
  make_ghosts(grains, grid, by_cells_);
  by_cells_.grow(grains.size());
  for_each({grains.owned().end, grains.size()}, FillIndex{by_cells_});
  Buffer<Vec3d>& places = Context::current().scratch<Vec3d>();
  places.reserve_and_resize(grains.size());
  for_each(grains.all(), InOrderPass{by_cells_, x, places});
  grid.add_ghosts(frame_, Span<const Vec3d>(places.span()));
  levels_.add_ghosts(x.span(), grains.radius, grains.id);
}

Span<const Index> SolidSolver::order_by_cells(const GrainStore& grains, CellGrid& grid) {
  if (!Context::current().several()) grid.sort<Vec3d>(frame_, grains.x_list.span(), by_cells_);
  return by_cells_;
}

HostArray SolidSolver::blocks(const GrainStore& grains, const CellGrid& grid) const {
  if (!in_levels()) return blocks_of(grains, grid, frame_, grains.x_list.span());
  const Index n = grains.owned().size();
  Buffer<std::uint32_t> level, cell;
  levels_.places({grains.x_list.span().data, n}, {grains.radius.span().data, n}, level, cell);
  const std::vector<std::uint32_t> levels = level.to_host(), cells = cell.to_host();
  const std::vector<Id> id = grains.id.values();
  HostArray out{"block", "-", Scalar::u32, 3, HostBytes(n * 3 * sizeof(std::uint32_t))};
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t place[] = {levels[i], cells[i], id[i]};
    std::memcpy(out.bytes.data() + i * sizeof place, place, sizeof place);
  }
  return out;
}

void SolidSolver::share_motion(GrainStore& grains) {
  const auto moved = {static_cast<FieldBase*>(&grains.x), static_cast<FieldBase*>(&grains.v),
                      static_cast<FieldBase*>(&grains.omega)};
  for (FieldBase* field : moved) field->set_shared(false);
  grains.share(moved);
}

}  // namespace BL_SOLVER
