#include "src/solids/energy_books.hpp"

#include "kernels/integrate/grain_kick.hpp"
#include "src/solids/solid_solver.hpp"

namespace BL_SOLVER {
namespace {

constexpr const char* kTerms[EnergyFlow::kTerms] = {"dissipated_normal",  "dissipated_sliding",
                                                    "dissipated_rolling", "work_walls",
                                                    "work_gravity",       "work_fluid"};
std::string name_of(int term) { return std::string("grain_") + kTerms[term]; }

}  // namespace

std::vector<Quantity> EnergyBooks::terms(double energy) const {
  std::vector<Quantity> out;
  double residual = begun_ ? energy - start_ : 0;
  for (int k = 0; k < EnergyFlow::kTerms; ++k) {
    out.push_back({name_of(k), "J", sum_.of[k]});
    residual += k < EnergyFlow::walls ? sum_.of[k] : -sum_.of[k];
  }
  out.push_back({"grain_energy_residual", "J", residual});
  return out;
}

void EnergyBooks::save(std::vector<Quantity>& scalars) const {
  scalars.push_back({"grain_energy_counted", "-", begun_ ? 1.0 : 0.0});
  scalars.push_back({"grain_energy_start", "J", start_});
  for (int k = 0; k < EnergyFlow::kTerms; ++k) scalars.push_back({name_of(k), "J", sum_.of[k]});
}

void EnergyBooks::load(const std::vector<Quantity>& scalars) {
  for (const Quantity& q : scalars) {
    if (q.name == "grain_energy_counted") begun_ = q.value != 0;
    if (q.name == "grain_energy_start") start_ = q.value;
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
  if (clumps_.any() && dt > 0)
    for_each(clumps_.store().owned(), ClumpFlowPass{clumps_.view(), gravity, dt, books_->of_clumps()});
}

template <class Law>
void SolidSolver::count_pair_flows(const GrainStore& g, double dt, const OpenLosses& losses) {
  for_each(threads(), PairFlowPass<Law>{contact_pass(g, dt), books_->of_pairs(), books_->flows(), losses});
}

void SolidSolver::choose_flow_law() {
  with_contact_law(parameters_.pair_laws, [&]<class Law>(std::type_identity<Law>) { use_flow_law<Law>(); });
}

void SolidSolver::end_books(const GrainStore& g, const GrainKick& kick, int substeps) {
  if (kick.wet()) for_each(g.owned(), kick_flow(g, 0, kick, {}, false));
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
