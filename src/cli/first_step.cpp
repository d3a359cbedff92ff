#include "first_step.hpp"

#include <utility>

#include "bedload/geometry/setup.hpp"
#include "bedload/output/intervals.hpp"
#include "room.hpp"

namespace bedload {

FirstStep::FirstStep(Prepared& p, bool restarted) : prepared(p) {
  if (p.memory.of(p.counts) > p.device.memory) {
    p.warnings.push_back("the case needs more memory than there is, so its step limits were not evaluated: " +
                         lack_of_memory_text(p));
    return;
  }
  Simulation& simulation = trial.emplace(p).simulation();
  steps = simulation.limits();
  substeps = simulation.substep_limits();
  numerical_viscosity = simulation.numerical_viscosity();
  free_surface = p.config.fluid.present && !p.config.fluid.lattice() &&
                 (restarted || has_free_surface(p.config, p.setup));
  remarks = remarks_on(p.config, numerical_viscosity, free_surface);
}

void FirstStep::take() {
  if (!trial) return;
  Simulation& simulation = trial->simulation();
  check_fixed_steps(prepared, simulation);
  const StepInfo step = simulation.step();  // allocates what steps need
  memory = trial->memory();
  if (std::string idle = idle_ranks_text(simulation.ranks(), prepared.config); !idle.empty())
    prepared.warnings.push_back(std::move(idle));
  for (std::string& warning : OutputIntervals(prepared.config.out).newly_below(step.dt))
    prepared.warnings.push_back(std::move(warning));
}

std::vector<std::string> FirstStep::notes() const {
  std::vector<std::string> all = prepared.notes;
  for (const Remark& remark : remarks) all.push_back(remark.about + ": " + remark.text);
  return all;
}

}  // namespace bedload
