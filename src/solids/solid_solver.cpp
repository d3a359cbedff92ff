#include "src/solids/solid_solver.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bedload/parallel/reductions.hpp"
#include "kernels/integrate/grain_substep.hpp"
#include "kernels/stress/coarse_fields.hpp"
#include "src/solids/arriving_contacts.hpp"

namespace BL_SOLVER {
namespace {

/// The force on the largest grain that laws give it when it is pressed flat, N.
double flattening_force(const std::vector<ContactLaw>& laws, double R) {
  double force = 0;
  for (const ContactLaw& law : laws)
    force = std::max(force, double(law.normal_state(Real(R), 1, Real(R)).elastic));
  return force;
}

/// Far above what a grain does to a body: this force, on the longest arm.
std::array<double, 6> bounds_of_loads(const SolidParameters& p, const Frame& frame) {
  return LoadBounds{flattening_force(p.wall_laws, p.d_max / 2), 1, norm(frame.length)}.load();
}

/// Far above the energy that a grain takes or gives in a substep, J.
double most_energy(const SolidParameters& p) {
  const double R = p.d_max / 2, fastest = 30;  // m/s
  double most = R * std::max(flattening_force(p.pair_laws, R), flattening_force(p.wall_laws, R));
  for (const GrainMaterial& m : p.materials)
    most = std::max(most, 4 / 3. * M_PI * cube(R) * m.rho * square(fastest));
  return most;
}

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
      clumps_(parameters, frame, grains),
      levels_(frame),
      wall_list_(frame, walls, grains, skin(), range_beyond(parameters.wall_laws, parameters.d_max / 2)),
      load_bounds_(bounds_of_loads(parameters, frame)),
      arriving_(std::make_unique<ArrivingContacts>(parameters.spectra.per_decade > 0)) {
  frame_.shear = {parameters.shear_rate, 0, frame.origin.z, frame.length.z};
  wall_laws_.assign(parameters.wall_laws);
  if (parameters.materials.size() > 1) pair_laws_.assign(parameters.pair_laws);
  with_contact_law(parameters.pair_laws, [&]<class Law>(std::type_identity<Law>) { use_pair_law<Law>(); });
  choose_wall_law();
  choose_flow_law();
  if (parameters.energy)
    books_ = std::make_unique<EnergyBooks>(most_energy(parameters), grains, lubricates());
  if (parameters.spectra.per_decade > 0)
    spectra_ = std::make_unique<SpectraBooks>(parameters, grains, walls.contacts() > 0);
  if (!parameters.wear.empty()) wear_ = std::make_unique<WearBooks>(parameters);
  if (parameters.single_forces) forces_ = std::make_unique<SingleForces>();
}

SolidSolver::~SolidSolver() = default;

std::vector<const FieldBase*> SolidSolver::fields_of_contacts() const {
  std::vector<const FieldBase*> out = wall_list_.counts();
  if (books_ && books_->film_field()) out.push_back(books_->film_field());
  if (spectra_ && spectra_->wall_losses())
    out.insert(out.end(), {spectra_->wall_peaks(), spectra_->wall_losses()});
  return out;
}

void SolidSolver::save(std::vector<Quantity>& scalars) const {
  if (books_) books_->save(scalars);
  if (!frame_.shear.acts()) return;
  scalars.push_back({"grain_strain", "-", frame_.shear.strain});
  scalars.push_back({"grain_strain_listed", "-", listed_strain_});
}

void SolidSolver::load(const std::vector<Quantity>& scalars) {
  if (books_) books_->load(scalars);
  for (const Quantity& q : scalars) {
    if (q.name == "grain_strain") frame_.shear.strain = q.value;
    if (q.name == "grain_strain_listed") listed_strain_ = q.value;
  }
}

// -- limits ------------------------------------------------------------------

void SolidSolver::begin_watch(const GrainStore& g) {
  GrainView grains = view(g);
  grains.mass_per_r3 = matter_.of(g);
  watched_.take(g.owned(), WatchReduction{grains, g.x_list, g.drag_coefficient});
}

GrainWatch SolidSolver::watch() const {
  const auto v = all_reduce(watched_.read(),
                            [](auto& into, const auto& of_rank) { WatchReduction{}.combine(into, of_rank); });
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
          .mass_per_r3 = matter_.in_contact(g),
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
    if (books_) count_film_flows(g, poses, dt);
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
  if (spectra_) spectra_->forget();
  if (wear_) wear_->forget();
  FreeBodies* const free = moving();
  wall_list_.cover(g, poses, 0);
  record_forces(g, poses.data, 0);
  const ContactPass contacts =
      contacts_at(g, poses.data, 0, free ? free->record(g.size(), load_bounds_) : ContactLoads{});
  evaluate(EvaluatePass{contacts, g.force, g.torque});
}

void SolidSolver::advance(GrainStore& g, Span<const BodyPose> poses, int bodies, double dt, int substeps,
                          bool held, const std::vector<Vec3d>& gravity, double wall_travel,
                          Span<const Real3> drive) {
  FreeBodies* const free = moving();
  const double tau = dt / substeps, strain = frame_.shear.strain;
  const ContactLoads loads = free ? free->record(g.size(), load_bounds_) : ContactLoads{};
  const auto contacts_in = [&](int s) {
    const BodyPose* const row = poses.data + std::size_t(s) * bodies;
    frame_.shear.strain = strain + s * tau * frame_.shear.rate;
    record_loads(s, g, row, tau);
    if (s == substeps) record_forces(g, row, tau);
    return contacts_at(g, row, tau, loads);
  };
  substep_loads_.begin(substeps);
  wall_list_.cover(g, poses, wall_travel);
  if (free) free->first_kick();
  if (held || parameters_.fixed) {
    for_each(g.owned(), HeldPass{.duration = dt,
                                 .drag = drag_of(std::as_const(g)),
                                 .impulses = {g.impulse, g.spin_impulse},
                                 .drag_force = g.drag_force});
    if (wet_) clumps_.begin_drag(g, 0, true, dt), clumps_.end_drag(g, dt);
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
    if (clumps_.share_drag()) kick.clump_d = std::as_const(g.clump_d).span();
    clumps_.begin_drag(g, kick.h, kick.exponential);
  }
  if (fluid_torque_) {
    kick.fluid_force = std::as_const(g.fluid_force);
    kick.fluid_torque = *fluid_torque_;
  }
  if (books_) begin_books(g, poses.data, kick);
  const Velocities<Real3> rest{v_rest_, omega_rest_};
  for_each(g.owned(), FirstKickPass{.kick = kick,
                                    .force = g.force,
                                    .torque = g.torque,
                                    .x = g.x,
                                    .now = {g.v, g.omega},
                                    .rest = rest,
                                    .impulses = {g.impulse, g.spin_impulse}});
  const auto follow = [&](double drift, int kicks) {
    clumps_.follow(g, rest, drift, kicks * kick.h * kick.gravity, wet_ ? kicks : 0);
  };
  follow(tau, 1);
  share_motion(g);
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
      follow(tau, 2), share_motion(g);
    else
      follow(0, 1), g.v.set_shared(false), g.omega.set_shared(false);
    if (free) free->substep(s), record_loads(s, *free);
  }
  if (books_) end_books(g, kick, substeps);
  if (wet_) clumps_.end_drag(g, dt);
}

template <class Law>
void SolidSolver::end_substep(GrainStore& g, const ContactPass& contacts, const GrainKick& kick, double dt,
                              bool last) {
  if (last)
    evaluate(SubstepPass<Law, LastKick>{
        .contacts = contacts,
        .kick = kick,
        .rest = {v_rest_, omega_rest_},
        .finish = {.duration = dt,
                   .next = {next_v_, next_omega_},
                   .rest = clumps_.any() ? Velocities<Real3>{v_rest_, omega_rest_} : Velocities<Real3>{},
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
  const T all{contact_pass(g, 0), wall_contacts(g, nullptr, 0), clumps_.of_grains()};
  TotalSums::Value v = total(g.owned(), TotalSums{all});
  const T::Value most = all_reduce(
      reduce(g.owned(), all), [&](T::Value& into, const T::Value& of_rank) { all.combine(into, of_rank); });
  if (clumps_.any()) {
    const auto bound =
        sum_over<ClumpTotals::kSums>(Context::current().rank() == 0 ? clumps_.store().owned() : Range{},
                                     ClumpTotals{clumps_.view(), frame_});
    for (int k = 0; k < ClumpTotals::kSums; ++k) v.sum[k] += bound.v[k];
  }
  GrainTotals t;
  t.mass = v.sum[T::mass];
  t.kinetic = v.sum[T::kinetic];
  t.rotational = v.sum[T::rotational];
  t.elastic = v.sum[T::elastic];
  t.momentum = {v.sum[T::px], v.sum[T::py], v.sum[T::pz]};
  t.angular = {v.sum[T::lx], v.sum[T::ly], v.sum[T::lz]};
  if (t.mass > 0) t.centre = Vec3d{v.sum[T::cx], v.sum[T::cy], v.sum[T::cz]} * (1 / t.mass);
  t.max_speed = std::sqrt(most.speed2);
  t.max_overlap = most.overlap;
  t.contacts = v.sum[T::pairs];
  t.wall_contacts = v.sum[T::on_walls];
  if (g.everywhere() > 0) t.coordination = 2 * t.contacts / double(g.everywhere());
  return t;
}

double SolidSolver::dropped_contacts(const GrainStore& g, Span<const BodyPose> poses) const {
  if (walls_.contacts() == 0 || !parameters_.contacts) return 0;
  return sum_over<1>(g.owned(), DroppedContacts{wall_contacts(g, poses.data, 0)}).v[0];
}

void SolidSolver::contact_moments(const GrainStore& g, Buffer<PairMoment<>>& out) const {
  out.resize(g.owned().size());
  if (!parameters_.contacts) return out.zero();
  for_each(g.owned(), ContactStressPass{contact_pass(g, 0), out});
}

void SolidSolver::film_moments(const GrainStore& g, Buffer<PairMoment<>>& out) const {
  out.resize(g.owned().size());
  for_each(g.owned(), LubricationStressPass{films(g, nullptr), out});
}

GrainActions SolidSolver::actions(const GrainStore& g, Span<const BodyPose> poses) const {
  return {contact_pass(g, 0), films(g, nullptr), wall_contacts(g, poses.data, 0)};
}

void SolidSolver::record_loads(int s, const GrainStore& g, const BodyPose* poses, double dt) {
  if (!substep_loads_.wanted() || !parameters_.contacts || wall_list_.everywhere() == 0) return;
  const WallContacts contacts = wall_contacts(g, poses, dt);
  substep_loads_.record(s, [&](std::uint32_t body, LoadSum* load) {
    if (moving() && moving()->place_of(int(body)) >= 0) return;
    total_into(load, {0, wall_list_.size()}, ListedLoadReduction{{contacts, body}, wall_list_.rows()},
               load_bounds_);
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
    loads.push_back(total(g.owned(), BodyLoadReduction{wall_contacts(g, poses.data, 0), b}));
  return loads;
}

}  // namespace BL_SOLVER
