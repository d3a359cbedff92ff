#include "src/solids/energy_books.hpp"

#include "bedload/parallel/reductions.hpp"
#include "kernels/boundaries/openings_energy.hpp"
#include "kernels/integrate/grain_kick.hpp"
#include "src/solids/solid_solver.hpp"

namespace BL_SOLVER {
namespace {

constexpr const char* kTerms[EnergyFlow::kTerms] = {
    "dissipated_normal", "dissipated_sliding", "dissipated_rolling", "dissipated_lubrication",
    "work_walls",        "work_gravity",       "work_fluid"};
constexpr const char *kIn = "grain_energy_in", *kOut = "grain_energy_out";
/// Of what all ranks have.
Range of_first_rank(Range all) { return Context::current().rank() == 0 ? all : Range{}; }
std::string name_of(int term) { return std::string("grain_") + kTerms[term]; }

}  // namespace

std::vector<Quantity> EnergyBooks::terms(double energy) const {
  std::vector<Quantity> out;
  double residual = begun_ ? energy - start_ : 0;
  for (int k = 0; k < EnergyFlow::kTerms; ++k) {
    if (k != EnergyFlow::films || films_) out.push_back({name_of(k), "J", sum_.of[k]});
    residual += k < EnergyFlow::walls ? sum_.of[k] : -sum_.of[k];
  }
  out.push_back({kIn, "J", in_});
  out.push_back({kOut, "J", out_});
  residual += out_ - in_;
  out.push_back({"grain_energy_residual", "J", residual});
  return out;
}

void EnergyBooks::save(std::vector<Quantity>& scalars) const {
  scalars.push_back({"grain_energy_counted", "-", begun_ ? 1.0 : 0.0});
  scalars.push_back({"grain_energy_start", "J", start_});
  scalars.push_back({kIn, "J", in_});
  scalars.push_back({kOut, "J", out_});
  for (int k = 0; k < EnergyFlow::kTerms; ++k) scalars.push_back({name_of(k), "J", sum_.of[k]});
}

void EnergyBooks::load(const std::vector<Quantity>& scalars) {
  for (const Quantity& q : scalars) {
    if (q.name == "grain_energy_counted") begun_ = q.value != 0;
    if (q.name == "grain_energy_start") start_ = q.value;
    if (q.name == kIn) in_ = q.value;
    if (q.name == kOut) out_ = q.value;
    for (int k = 0; k < EnergyFlow::kTerms; ++k)
      if (q.name == name_of(k)) sum_.of[k] = q.value;
  }
}

double SolidSolver::energy(const GrainStore& g) const {
  const GrainTotals t = totals(g);
  return t.kinetic + t.rotational + t.elastic;
}

std::vector<Quantity> SolidSolver::energy_terms(const GrainStore& g) const {
  return books_ ? books_->terms(energy(g)) : std::vector<Quantity>{};
}

void SolidSolver::begin_books(const GrainStore& g, const BodyPose* poses, const GrainKick& kick) {
  if (!books_->begun()) books_->begin(energy(g));
  books_->begin_advance(list_.slots(), std::size_t(walls_.contacts()) * g.size(), g.size(),
                        clumps_.store().owned().size(), kick.wet());
  count_flows(g, poses, 0, kick, {});
}

void SolidSolver::count_flows(const GrainStore& g, const BodyPose* poses, double dt, const GrainKick& kick,
                              const Vec3d& gravity) {
  if (parameters_.contacts) {
    const OpenLosses losses = spectra_ ? spectra_->view() : OpenLosses{};
    (this->*count_pair_flows_)(g, dt, losses);
    for_each({0, wall_list_.size()}, WallFlowPass{.contacts = wall_contacts(g, poses, dt),
                                                  .rows = wall_list_.rows(),
                                                  .actions = books_->at_walls(),
                                                  .flows = books_->flows(),
                                                  .losses = losses,
                                                  .wear = wear_ && dt > 0 ? wear_->view() : WallWear{}});
  }
  for_each(g.owned(), kick_flow(g, dt, kick, gravity, dt == 0));
  count_clump_flows(dt, kick, gravity, dt == 0);
}

void SolidSolver::count_clump_flows(double dt, const GrainKick& kick, const Vec3d& gravity, bool begins) {
  if (!clumps_.any()) return;
  const CentreDrag* const drag = kick.wet() ? clumps_.drag() : nullptr;
  if (dt == 0 && !drag) return;
  for_each(clumps_.store().owned(), ClumpFlowPass{.clumps = clumps_.view(),
                                                  .gravity = gravity,
                                                  .dt = dt,
                                                  .flows = books_->of_clumps(),
                                                  .drag = drag,
                                                  .course = books_->course_of_clumps(),
                                                  .begins = begins});
}

void SolidSolver::count_film_flows(const GrainStore& g, const BodyPose* poses, double dt) {
  for_each(g.owned(),
           FilmFlowPass{.walls = wall_contacts(g, poses, dt),
                        .rows = wall_list_.rows(),
                        .wall_row = wall_list_.size() > 0 ? wall_list_.row_of() : Span<const Index>(),
                        .by_grains = by_films_.data(),
                        .actions = books_->films(),
                        .flows = books_->flows()});
}

template <class Law>
void SolidSolver::count_pair_flows(const GrainStore& g, double dt, const OpenLosses& losses) {
  for_each(threads(), PairFlowPass<Law>{contact_pass(g, dt), books_->of_pairs(), books_->flows(), losses});
}

void SolidSolver::choose_flow_law() {
  with_contact_law(parameters_.pair_laws, [&]<class Law>(std::type_identity<Law>) { use_flow_law<Law>(); });
}

void SolidSolver::let_go(const GrainStore& g, Span<const std::uint32_t> sink,
                         Span<const std::uint32_t> of_clumps) {
  if (!books_ || !books_->begun()) return;
  const WallContacts walls = wall_contacts(g, nullptr, 0);
  books_->add_out(
      sum_over<1>(g.owned(), LeavingEnergy{{contact_pass(g, 0), walls, clumps_.of_grains()}, sink}).v[0]);
  if (clumps_.any())
    books_->add_out(sum_over<1>(of_first_rank(clumps_.store().owned()),
                                ClumpMotionEnergy{{clumps_.view(), frame_}, 0, of_clumps})
                        .v[0]);
  if (spectra_) for_each(g.owned(), EndContactsPass{contact_pass(g, 0), walls, sink, spectra_->view()});
}

void SolidSolver::let_in(const GrainStore& g, Range come, Index clumps) {
  if (!books_ || !books_->begun()) return;
  const GrainView grains = view(g);
  books_->add_in(sum_over<1>(come, MotionEnergy{grains, clumps_.of_grains()}).v[0]);
  if (clumps_.any())
    books_->add_in(sum_over<1>(of_first_rank({0, clumps_.store().size() - clumps}),
                               ClumpMotionEnergy{{clumps_.view(), frame_}, clumps})
                       .v[0]);
}

void SolidSolver::end_books(const GrainStore& g, const GrainKick& kick, int substeps) {
  if (kick.wet()) for_each(g.owned(), kick_flow(g, 0, kick, {}, false));
  count_clump_flows(0, kick, {}, false);
  books_->end_advance(g.owned(), substeps);
}

KickFlowPass SolidSolver::kick_flow(const GrainStore& g, double dt, const GrainKick& kick,
                                    const Vec3d& gravity, bool begins) const {
  return {view(g),
          gravity,
          dt,
          kick.fluid_force,
          kick.drive,
          g.impulse.span(),
          g.spin_impulse.span(),
          books_->course(),
          books_->flows(),
          begins,
          clumps_.of_grains()};
}

}  // namespace BL_SOLVER
