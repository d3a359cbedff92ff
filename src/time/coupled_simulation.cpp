#include "src/time/coupled_simulation.hpp"

#include "bedload/parallel/rank_record.hpp"
#include "src/time/lattice_simulation.hpp"

namespace BL_SOLVER {

CoupledSimulation::CoupledSimulation(const Config& config, const Setup& setup, Link* link)
    : config_(config), state_(config_), stepper_(config_, state_) {
  Context::current().join(link);
  stepper_.take(state_.particles_of(config_, setup), false);
  state_.open.start(state_.fluid, state_.grains);
  if (state_.has_grains) stepper_.solids().clumps().bind(state_.grains, setup.grains);
  add_meters();
}

std::vector<Quantity> CoupledSimulation::numerical_viscosity() const {
  const FluidConfig& f = config_.fluid;
  if (!state_.has_fluid || f.mu == 0) return {};
  const double own = f.mu / f.rho0, sound = f.h() * f.c;
  const double artificial = config_.visc.alpha * sound / 20 / own;
  const auto by_slip = [&] { return stepper_.coupling().bed_viscosity(0.4, config_.grain.d_max) / f.mu; };
  return {{"artificial_bulk", "-", artificial},
          {"artificial_bed", "-", state_.two_way ? artificial : 0},
          {"local_slip_bed", "-", state_.two_way ? by_slip() : 0}};
}

std::vector<RankReport> CoupledSimulation::ranks() {
  if (!Context::current().several()) return {};
  const RankRecord& record = rank_record();
  const auto own = [](const Store& store) { return std::int64_t(store.owned().size()); };
  RankReport report{.own = {own(state_.fluid), own(state_.walls), own(state_.grains)},
                    .bytes = std::size_t(bytes_held_by_thread()),
                    .exchanges = record.exchanges,
                    .migrated = record.migrated,
                    .sent = record.sent,
                    .waited = record.waited};
  for (const Store* store : std::initializer_list<const Store*>{&state_.fluid, &state_.walls, &state_.grains})
    report.ghosts += store->all().size() - store->owned().size();
  return {report};
}

SavedState CoupledSimulation::save_grains() {
  SavedState out;
  stepper_.save_grains(out);
  add_blocks(out);
  return out;
}

void CoupledSimulation::load_grains(const SavedState& saved) { stepper_.load_grains(saved); }

SavedState CoupledSimulation::save() {
  SavedState out;
  stepper_.save_grains(out);
  state_.save(out);
  stepper_.save(out);
  meters_.save(out);
  field_means_.save(out);
  add_blocks(out);
  return out;
}

void CoupledSimulation::load(const SavedState& saved) {
  state_.load(saved);
  stepper_.load(saved);
  wall_forces_.step = fluid_loads_.step = held_.step = grain_loads_.step = -1;
  begin_meters(&saved);
  field_means_.load(saved, state_.clock.time);
}

std::unique_ptr<Simulation> make_coupled(const Config& config, const Setup& setup, Link* link) {
  if (config.fluid.present && config.fluid.lattice())
    return std::make_unique<LatticeSimulation>(config, setup);
  return std::make_unique<CoupledSimulation>(config, setup, link);
}

}  // namespace BL_SOLVER
