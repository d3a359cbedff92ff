#include "src/solids/solid_solver.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bedload/parallel/reductions.hpp"
#include "kernels/integrate/grain_substep.hpp"
#include "kernels/integrate/grain_sums.hpp"
#include "kernels/stress/contact_stress.hpp"

namespace BL_SOLVER {
namespace {

struct WrapGrains {
  Frame frame;
  Span<Vec3d> x;
  BL_HD void operator()(Index i) const { x[i] = frame.wrap(x[i]); }
};

/// Composes the order of a sort with the removal before it: former indices as of the last lists.
struct SourceIndexPass {
  Span<const Index> source_index;
  Span<Index> order;
  BL_HD void operator()(Index i) const { order[i] = source_index[order[i]]; }
};

struct DroppedContacts {
  WallContacts contacts;
  BL_HD void operator()(Index i, double* out) const { out[0] = contacts.dropped(i); }
};

}  // namespace

SolidSolver::SolidSolver(const SolidParameters& parameters, const Frame& frame, const WallGeometry& walls,
                         GrainStore& grains, FreeBodies* bodies, bool wet)
    : parameters_(parameters),
      frame_(frame),
      matter_(parameters.materials),
      wet_(wet),
      walls_(walls),
      bodies_(bodies),
      groups_(parameters, frame, grains),
      levels_(frame),
      wall_list_(frame, walls, skin(), film_range(parameters.d_max / 2)) {
  wall_laws_.assign(parameters.wall_laws);
  if (parameters.materials.size() > 1) pair_laws_.assign(parameters.pair_laws);
  with_contact_law(parameters.pair_laws, [&]<class Law>(std::type_identity<Law>) { use_pair_law<Law>(); });
  choose_wall_law();
  if (parameters.energy) books_ = std::make_unique<EnergyBooks>();
  if (walls.contacts() == 0) return;
  wall_contacts_ = std::make_unique<Field<Index>>(grains, "wall_contacts", "-", Lifetime::kept);
  wall_contacts_->resize(grains.size());
  for (int k = 0; k < walls.contacts(); ++k) {
    const std::string name = "wall_memory_" + std::to_string(k);
    wall_memory_.push_back(
        std::make_unique<Field<WallMemory>>(grains, name.c_str(), WallMemory::units(), Lifetime::kept));
    wall_memory_.back()->resize(grains.size());
  }
}

std::vector<const FieldBase*> SolidSolver::fields_of_contacts() const {
  std::vector<const FieldBase*> out;
  if (wall_contacts_) out.push_back(wall_contacts_.get());
  for (const auto& memory : wall_memory_) out.push_back(memory.get());
  return out;
}

void SolidSolver::refresh(GrainStore& grains, CellGrid& grid, const GrainRenewal& renewal) {
  for_each(grains.owned(), WrapGrains{frame_, grains.x});
  if (renewal.any || !levels_.chosen()) choose_levels(grains);
  sort(grains.x.span(), grains, grid);
  grains.reorder(order_);
  grains.x_list.copy(grains.x);
  if (renewal.any) for_each(grains.owned(), SourceIndexPass{renewal.source_index, order_});
  std::swap(list_, old_list_);
  histories_.swap(old_histories_);
  build_list(grains, grid);
  if (old_list_.rows() != (renewal.any ? renewal.before : grains.size())) return;
  const CarryHistoryPass carry{.from = old_list_.view(),
                               .to = list_.view(),
                               .long_rows = long_rows_.view(),
                               .order = order_,
                               .old_histories = old_histories_.view(),
                               .histories = histories_.view()};
  for_each(grains.owned(), carry);
  for_each({0, long_rows_.pieces() * LongRowsView::kPiece}, CarryLongHistoryPass{carry});
}

void SolidSolver::choose_levels(const GrainStore& grains) {
  if (parameters_.d_max < 2 * parameters_.d_min)
    levels_.unite();
  else
    levels_.choose(grains.radius.values(), parameters_.d_max / 2, skin());
}

void SolidSolver::sort(Span<const Vec3d> x, const GrainStore& grains, CellGrid& grid) {
  if (in_levels())
    levels_.sort(x, grains.radius.span(), order_);
  else
    grid.sort<Vec3d>(frame_, x, order_, grains.id);
}

void SolidSolver::build_list(const GrainStore& grains, const CellGrid& grid) {
  GrainNear near{.frame = frame_,
                 .x = grains.x_list.span(),
                 .radius = grains.radius.span(),
                 .group = groups_.of_grains(),
                 .largest = 0.5 * parameters_.d_max,
                 .skin = skin(),
                 .film = film_range(1)};
  // few lanes: rows are short, and contacts use so many registers that more threads would not run at once
  const unsigned bits = std::min(lane_bits(grains.size(), 3u << 14), 3u);
  if (in_levels())
    level_lists_.build(list_, levels_, near, bits);
  else
    list_.build(grains.size(), grid.view(), near, bits);
  long_rows_.cut(list_, in_levels() ? levels_.particles(levels_.count() - 1).begin : 0);
  by_pieces_.reserve_and_resize(long_rows_.pieces());
  near.film = 0;
  for_each(grains.owned(), ContactsFirstPass{near, list_.view(), long_rows_.view(), list_.entries()});
  histories_.reset(list_.slots());
  wall_list_.forget();
}

// -- limits ------------------------------------------------------------------

GrainWatch SolidSolver::watch(const GrainStore& g) const {
  const auto v = reduce(g.owned(), WatchReduction{view(g), g.x_list, g.drag_coefficient});
  return {std::sqrt(v.speed2), std::sqrt(v.displacement2), v.drag_rate, Id(v.bad)};
}

std::vector<StepLimit> SolidSolver::limits(const GrainWatch& w) const {
  std::vector<StepLimit> limits = parameters_.limits.at(2 * w.speed);
  if (!parameters_.exponential && w.drag_rate > 0)
    limits.push_back({Limit::grain_drag, parameters_.drag_fraction / w.drag_rate});
  return limits;
}

// -- motion ------------------------------------------------------------------

GrainView SolidSolver::view(const GrainStore& g) const {
  return {.frame = frame_,
          .mass_per_r3 = matter_.of(g),
          .x = g.x,
          .v = g.v,
          .omega = g.omega,
          .radius = g.radius,
          .id = g.id};
}

ContactPass SolidSolver::contact_pass(const GrainStore& g, double dt) const {
  return {.grains = view(g),
          .law = law(),
          .dt = Real(dt),
          .list = list_.view(),
          .histories = histories_.view(),
          .laws = pair_laws_.size() > 0 ? pair_laws_.data() : nullptr,
          .materials = matter_.materials(),
          .acts = parameters_.contacts};
}

LubricationPass SolidSolver::films(const GrainStore& g, ContactSum* sums) const {
  return {view(g), parameters_.films, g.wetness, list_.view(), sums};
}

ContactPass SolidSolver::contacts_at(const GrainStore& g, const BodyPose* poses, double dt,
                                     const ContactLoads& loads) {
  ContactPass pass = contact_pass(g, dt);
  if (lubricates()) {
    of_grains_.resize(g.size());
    for_each(threads(), films(g, by_films_.data()));
    pass.by_films = by_films_.data();
  }
  if (!parameters_.contacts) return pass;
  if (wall_list_.size() > 0) {
    by_walls_.reserve_and_resize(wall_list_.size());
    (this->*evaluate_walls_)(wall_contacts(g, poses, dt), loads);
    if (lubricates())
      for_each({0, wall_list_.size()},
               WallFilmPass{wall_contacts(g, poses, dt), wall_list_.rows(), by_walls_.data()});
    pass.wall_row = wall_list_.row_of();
    pass.by_walls = by_walls_.data();
  }
  if (long_rows_.pieces() > 0) {
    pass.long_rows = long_rows_.view();
    pass.by_pieces = by_pieces_.data();
    (this->*evaluate_pieces_)(pass);
  }
  return pass;
}

template <class Law>
void SolidSolver::evaluate_pieces(const ContactPass& contacts) {
  using Pass = LongContactPass<Law>;
  const Range threads{0, long_rows_.pieces() << Pass::kLaneBits};
  if (contacts.by_walls)
    for_each_early(threads, Pass{contacts});
  else
    for_each(threads, Pass{contacts});
}

void SolidSolver::evaluate(GrainStore& g, Span<const BodyPose> poses) {
  if (books_) books_->forget();
  FreeBodies* const free = moving();
  wall_list_.cover(g, poses, wall_counts(), 0);
  const ContactPass contacts = contacts_at(g, poses.data, 0, free ? free->record(g.size()) : ContactLoads{});
  evaluate(EvaluatePass{contacts, g.force, g.torque});
}

void SolidSolver::advance(GrainStore& g, Span<const BodyPose> poses, int bodies, double dt, int substeps,
                          bool held, const std::vector<Vec3d>& gravity, double wall_travel,
                          Span<const Real3> drive) {
  FreeBodies* const free = moving();
  const double tau = dt / substeps;
  const ContactLoads loads = free ? free->record(g.size()) : ContactLoads{};
  const auto contacts_in = [&](int s) {
    const BodyPose* const row = poses.data + std::size_t(s) * bodies;
    record_loads(s, g, row, tau);
    return contacts_at(g, row, tau, loads);
  };
  substep_loads_.begin(substeps);
  wall_list_.cover(g, poses, wall_counts(), wall_travel);
  if (free) free->first_kick();
  if (held || parameters_.fixed) {
    for_each(g.owned(), HeldPass{.duration = dt,
                                 .drag = drag_of(std::as_const(g)),
                                 .impulses = {g.impulse, g.spin_impulse},
                                 .drag_force = g.drag_force});
    for (int s = 1; free && s <= substeps; ++s) {
      evaluate(EvaluatePass{contacts_in(s), g.force, g.torque});
      free->substep(s);
      record_loads(s, *free);
    }
    if (free) return;
    const BodyPose* const last = poses.data + std::size_t(substeps) * bodies;
    evaluate(g, {last, Index(bodies)});
    for (int s = 1; s <= substeps; ++s) record_loads(s, g, last, 0);
    return;
  }
  of_grains_.resize(g.size());
  GrainKick kick{.gravity = gravity.empty() ? parameters_.gravity : gravity[0],
                 .mass_per_r3 = matter_.of(g),
                 .h = 0.5 * tau,
                 .exponential = parameters_.exponential,
                 .radius = g.radius,
                 .drive = drive,
                 .edges = Edges(parameters_.reflect, frame_)};
  if (wet_) {
    kick.fluid_force = g.fluid_force;
    kick.drag = drag_of(std::as_const(g));
    kick.relaxation = relaxation_;
  }
  if (books_) begin_books(g, poses.data, kick, substeps);
  const Velocities<Real3> rest{v_rest_, omega_rest_};
  for_each(g.owned(), FirstKickPass{.kick = kick,
                                    .force = g.force,
                                    .torque = g.torque,
                                    .x = g.x,
                                    .now = {g.v, g.omega},
                                    .rest = rest,
                                    .impulses = {g.impulse, g.spin_impulse}});
  groups_.follow(g, rest, tau);
  for (int s = 1; s <= substeps; ++s) {
    if (books_)
      count_flows(g, poses.data + std::size_t(s) * bodies, tau, kick,
                  gravity.empty() ? kick.gravity : 0.5 * (kick.gravity + gravity[s]));
    const ContactPass contacts = contacts_in(s);
    if (!gravity.empty()) kick.gravity = gravity[s];
    (this->*end_substep_)(g, contacts, kick, dt, s == substeps);
    if (s < substeps) g.x.buffer().swap(next_x_);
    g.v.buffer().swap(next_v_);
    g.omega.buffer().swap(next_omega_);
    if (s < substeps)
      groups_.follow(g, rest, tau);
    else
      groups_.follow(g, {}, 0);
    if (free) free->substep(s), record_loads(s, *free);
  }
  if (books_) end_books(g, kick);
}

template <class Law>
void SolidSolver::end_substep(GrainStore& g, const ContactPass& contacts, const GrainKick& kick, double dt,
                              bool last) {
  if (last)
    evaluate(SubstepPass<Law, LastKick>{.contacts = contacts,
                                        .kick = kick,
                                        .rest = {v_rest_, omega_rest_},
                                        .finish = {.duration = dt,
                                                   .next = {next_v_, next_omega_},
                                                   .impulses = {g.impulse, g.spin_impulse},
                                                   .force = g.force,
                                                   .torque = g.torque,
                                                   .drag_force = g.drag_force}});
  else
    evaluate(SubstepPass<Law, NextDrift>{.contacts = contacts,
                                         .kick = kick,
                                         .rest = {v_rest_, omega_rest_},
                                         .finish = {.next_x = next_x_,
                                                    .next = {next_v_, next_omega_},
                                                    .rest = {v_rest_, omega_rest_},
                                                    .impulses = {g.impulse, g.spin_impulse}}});
}

// -- sums --------------------------------------------------------------------

GrainTotals SolidSolver::totals(const GrainStore& g) const {
  using T = TotalsReduction;
  const T::Value v = reduce(g.owned(), T{contact_pass(g, 0), wall_contacts(g, nullptr, 0)});
  GrainTotals t;
  t.mass = v.sum[T::mass];
  t.kinetic = v.sum[T::kinetic];
  t.rotational = v.sum[T::rotational];
  t.elastic = v.sum[T::elastic];
  t.momentum = {v.sum[T::px], v.sum[T::py], v.sum[T::pz]};
  t.angular = {v.sum[T::lx], v.sum[T::ly], v.sum[T::lz]};
  if (t.mass > 0) t.centre = Vec3d{v.sum[T::cx], v.sum[T::cy], v.sum[T::cz]} * (1 / t.mass);
  t.max_speed = std::sqrt(v.speed2);
  t.max_overlap = v.overlap;
  t.contacts = v.sum[T::pairs];
  t.wall_contacts = v.sum[T::on_walls];
  if (g.size() > 0) t.coordination = 2 * t.contacts / g.size();
  return t;
}

double SolidSolver::dropped_contacts(const GrainStore& g, Span<const BodyPose> poses) const {
  if (!wall_contacts_ || !parameters_.contacts) return 0;
  return sum_over<1>(g.owned(), DroppedContacts{wall_contacts(g, poses.data, 0)}).v[0];
}

void SolidSolver::contact_moments(const GrainStore& g, Buffer<PairMoment<>>& out) const {
  out.resize(g.size());
  if (!parameters_.contacts) return out.zero();
  for_each(g.owned(), ContactStressPass{contact_pass(g, 0), out});
}

void SolidSolver::film_moments(const GrainStore& g, Buffer<PairMoment<>>& out) const {
  out.resize(g.size());
  for_each(g.owned(), LubricationStressPass{films(g, nullptr), out});
}

void SolidSolver::record_loads(int s, const GrainStore& g, const BodyPose* poses, double dt) {
  if (!substep_loads_.wanted() || !parameters_.contacts || wall_list_.size() == 0) return;
  const WallContacts contacts = wall_contacts(g, poses, dt);
  substep_loads_.record(s, [&](std::uint32_t body, LoadSum* load) {
    if (moving() && moving()->place_of(int(body)) >= 0) return;
    reduce_into(load, {0, wall_list_.size()}, ListedLoadReduction{{contacts, body}, wall_list_.rows()});
  });
}

void SolidSolver::record_loads(int s, const FreeBodies& bodies) {
  substep_loads_.record(s, [&](std::uint32_t body, LoadSum* load) {
    if (const int k = bodies.place_of(int(body)); k >= 0)
      copy_on_device(load, bodies.by_grains() + k, sizeof *load);
  });
}

std::vector<LoadSum> SolidSolver::body_loads(const GrainStore& g, Span<const BodyPose> poses) const {
  std::vector<LoadSum> loads;
  for (std::uint32_t b = 0; b < parameters_.bodies(); ++b)
    loads.push_back(reduce(g.owned(), BodyLoadReduction{wall_contacts(g, poses.data, 0), b}));
  return loads;
}

}  // namespace BL_SOLVER
