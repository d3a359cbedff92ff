#include "src/time/coupled_simulation.hpp"

#include "src/time/lattice_simulation.hpp"

namespace BL_SOLVER {

CoupledSimulation::CoupledSimulation(const Config& config, const Setup& setup, Link* link)
    : config_(config), state_(config_), stepper_(config_, state_) {
  Context::current().join(link);
  state_.fill(config_, setup);
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

SavedState CoupledSimulation::save_grains() {
  SavedState out;
  stepper_.save_grains(out);
  return out;
}

void CoupledSimulation::load_grains(const SavedState& saved) { stepper_.load_grains(saved); }

SavedState CoupledSimulation::save() {
  SavedState out;
  stepper_.save_grains(out);
  state_.save(out);
  stepper_.save(out);
  meters_.save(out);
  if (Context::current().several())
    for (HostStore& store : out.stores) add_blocks(store);
  return out;
}

void CoupledSimulation::load(const SavedState& saved) {
  state_.load(config_, saved);
  stepper_.load(saved);
  wall_forces_.step = fluid_loads_.step = held_.step = grain_loads_.step = -1;
  begin_meters(&saved);
}

std::unique_ptr<Simulation> make_coupled(const Config& config, const Setup& setup, Link* link) {
  if (config.fluid.present && config.fluid.lattice())
    return std::make_unique<LatticeSimulation>(config, setup);
  return std::make_unique<CoupledSimulation>(config, setup, link);
}

}  // namespace BL_SOLVER
