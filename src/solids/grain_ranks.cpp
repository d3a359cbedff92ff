// Grains among ranks: who has which, and what becomes of their contacts.

#include <algorithm>
#include <numeric>

#include "bedload/parallel/ranks.hpp"
#include "src/solids/arriving_contacts.hpp"
#include "src/solids/solid_solver.hpp"

namespace BL_SOLVER {
namespace {

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
  BL_HD void operator()(Index k) const {
    const Index row = touching.row(k);
    if (row == kNone) return;
    Index record = before[k];
    touching.list.each(row, [&](std::uint64_t slot, Index j) {
      if (!touching.histories.touching[slot]) return;
      own[record] = id[row], other[record] = id[j];
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
  VerletListView list;
  PairHistories histories;
  BL_HD void operator()(Index i) const {
    if (had_row[i] != kNone) return;
    for (Index k = first_not_below(own, id[i]); k < own.size && own[k] == id[i]; ++k)
      list.each(i, [&](std::uint64_t slot, Index j) {
        if (id[j] != other[record[k]]) return;
        histories.store(slot, history[record[k]]);
        histories.touching[slot] = 1;
      });
  }
};

}  // namespace

void ArrivingContacts::send(const Migrants& migrants, Span<const Index> rows, const VerletListView& list,
                            bool listed, const PairHistories& histories, Span<const Id> id) {
  const Index grains = migrants.going().size;
  Buffer<Index> count(grains), before, places;
  const CountTouchingPass touching{migrants.going(), rows, list, histories, count};
  if (listed) for_each({0, grains}, touching);
  const Index n = exclusive_scan(count, before);
  records_.resize(n);
  if (listed)
    for_each({0, grains},
             RecordTouchingPass{touching, before, id, records_.own, records_.other, records_.history});
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
                              const VerletListView& list, const PairHistories& histories) {
  if (own_.size() == 0) return;
  const Range come{records_.owned().end, records_.size()};
  for_each(grains, SettleContactsPass{order,
                                      id,
                                      own_,
                                      order_,
                                      {records_.other.span().data + come.begin, come.size()},
                                      {records_.history.span().data + come.begin, come.size()},
                                      list,
                                      histories});
  own_.resize(0);
}

void SolidSolver::divide(const GrainStore& grains, CellGrid& grid, Span<const Vec3d> x) {
  std::vector<double> load;
  add_loads(grains, grid, frame_, x, 1, load);
  const Division division = divide_blocks(grid, load);
  imbalance_ = division.imbalance;
  grid.divide(division.ownership);
}

void SolidSolver::keep_own(GrainStore& grains, CellGrid& grid, bool listed) {
  if (!Context::current().several() || grains.divided()) return;
  const Span<const Vec3d> x = listed ? grains.x_list : grains.x;
  if (!grid.ownership()) divide(grains, grid, x);
  claim(grains, grid, frame_, x);
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
  arriving_->send(migrants, source_index, list_.view(), listed, histories_.view(), listed_id_);
  move(grains, migrants, kept, &x == &grains.x_list);
}

void SolidSolver::make_ghosts_of(GrainStore& grains, CellGrid& grid, const Field<Vec3d>& x) {
  make_ghosts(grains, grid);
  grid.add_ghosts(frame_, x.span());
}

void SolidSolver::share_motion(GrainStore& grains) {
  const auto moved = {static_cast<FieldBase*>(&grains.x), static_cast<FieldBase*>(&grains.v),
                      static_cast<FieldBase*>(&grains.omega)};
  for (FieldBase* field : moved) field->set_shared(false);
  grains.share(moved);
}

}  // namespace BL_SOLVER
