#include "src/lattice/resolved_grains.hpp"

#include "bedload/parallel/reductions.hpp"

namespace BL_SOLVER {

using namespace lattice;

ResolvedGrains::ResolvedGrains(const DomainConfig& domain, const LatticeUnits& units, const Vec3d& lift,
                               GrainStore& grains)
    : domain_(domain), units_(units), lift_(lift), grains_(grains) {
  for (FieldBase* field :
       std::initializer_list<FieldBase*>{&fluid_torque_, &last_force_, &last_torque_, &received_, &displaced_,
                                         &owed_, &link_begin_, &link_count_, &covered_}) {
    field->begin_at_zero();  // grains may have settled without fluid
    field->grow(grains.size());
  }
}

Balls ResolvedGrains::balls(const NodeGrid& grid, const Vec3d& first, bool held) const {
  return {.grid = grid,
          .periodic = {domain_.periodic[0], domain_.periodic[1], domain_.periodic[2] && !domain_.sheared()},
          .first = first,
          .dx = units_.dx,
          .dt = units_.dt,
          .held = held,
          .x = grains_.x,
          .v = grains_.v,
          .omega = grains_.omega,
          .radius = grains_.radius,
          .id = grains_.id,
          .images = images_};
}

template <class Pass>
void ResolvedGrains::run(Pass pass) const {
  for_each_box(grains_.size(), pass);
  if (!images_.there) return;
  pass.balls.across = true;
  for_each_box(grains_.size(), pass);
}

template <class Pass>
void ResolvedGrains::run_over_links(Pass pass, const NodeStore& nodes, bool held) {
  if (!held || !found_ || places_ < grains_.size()) find_links(pass.balls, nodes);
  pass.links = links();
  for_each_group(grains_.size(), pass);
  found_ = held && !images_.there;
  if (!images_.there) return;
  pass.balls.across = true;
  find_links(pass.balls, nodes);
  for_each_group(grains_.size(), pass);
}

void ResolvedGrains::cover(const NodeGrid& grid, const Vec3d& first, NodeStore& nodes) {
  grains_.wetness.assign(std::vector<Real>(grains_.size(), Real(1)));
  for_each(grains_.owned(), LiftPass{lift_, grains_.radius, grains_.fluid_force});
  run(CoverPass{balls(grid, first, true), nodes.solid});
  forget_links();
}

void ResolvedGrains::follow(const NodeMoments& before, const Vec3d& first, NodeStore& nodes) {
  const Balls all = balls(before.f.grid, first, false);
  if (last_moved_.size() < grains_.size() || ++moves_ == 0) {
    last_moved_.resize(grains_.size()), last_moved_.zero();
    moves_ = 1;
  }
  const Movers movers{last_moved_, moves_};
  run(ReleasePass{all, movers, nodes.solid});
  run(CoverPass{all, nodes.solid, movers});
  run(RefillPass{all, movers, before, nodes.solid});
  TakePass take{all, movers, before, units_.momentum(), nodes.solid, given()};
  for_each_group(grains_.size(), take);
  if (!images_.there) return;
  take.balls.across = true;
  for_each_group(grains_.size(), take);
}

void ResolvedGrains::make_places() {
  std::vector<Index> begin;
  double places = 0;
  for (const Real radius : grains_.radius.values()) {
    begin.push_back(Index(places));
    places += std::floor(GrainLink::most(radius / units_.dx));
  }
  if (places >= double(kNone))
    throw DeviceError("grains may have " + std::to_string(std::uint64_t(places)) +
                      " links to nodes, of at most 2^32 - 2; take a larger fluid.dx or fewer grains");
  link_begin_.assign(begin);
  links_.reserve_and_resize(std::size_t(places));
  places_ = grains_.size();
}

void ResolvedGrains::find_links(const Balls& balls, const NodeStore& nodes) {
  if (places_ < grains_.size()) make_places();
  list_boxes(grains_.size(), GrainLinkSearch{balls, nodes.solid, links()});
}

void ResolvedGrains::exchange(const Populations& f, const Vec3d& first, const NodeStore& nodes,
                              const Vec3d& push, std::int64_t step, bool held) {
  GrainLinkPass pass{.balls = balls(f.grid, first, held),
                     .f = f,
                     .links = {},
                     .push = push,
                     .lift = lift_,
                     .newton = units_.force(),
                     .newton_metre = units_.force() * units_.dx,
                     .second = units_.dt,
                     .first = step == 1,
                     .fluid_force = grains_.fluid_force,
                     .fluid_torque = fluid_torque_,
                     .force = last_force_,
                     .torque = last_torque_,
                     .given = given(),
                     .displaced = displaced_};
  run_over_links(pass, nodes, held);
}

void ResolvedGrains::stresslets(const Populations& f, const Vec3d& first, const NodeStore& nodes, bool held,
                                Buffer<PairMoment<>>& out) {
  out.resize(grains_.size());
  found_ = false;
  run_over_links(
      StressletPass{
          .balls = balls(f.grid, first, held), .f = f, .links = {}, .joule = units_.energy(), .out = out},
      nodes, held);
}

ResolvedGrains::Sums ResolvedGrains::sums() const {
  const auto t = sum_over<12>(grains_.owned(), GrainBooks{received_, displaced_, owed_, grains_.fluid_force});
  const auto vec = [&](int k) { return Vec3d{t.v[k], t.v[k + 1], t.v[k + 2]}; };
  return {vec(0), vec(3), vec(6), vec(9)};
}

}  // namespace BL_SOLVER
