#pragma once
// A case up to the end of its first step: what `bedload check` and Case.check of Python say of it.

#include <optional>
#include <string>
#include <vector>

#include "prepare.hpp"
#include "remarks.hpp"
#include "trial_simulation.hpp"

namespace bedload {

struct FirstStep {
  /// Starts the case; if it needs more memory than the device has free, adds a warning instead.
  FirstStep(Prepared& prepared, bool restarted);
  /// Does the step, then evaluates the memory. Adds warnings; throws KeyError for a fixed step above its
  /// limit.
  void take();
  /// Notes of the case and remarks, "about: text".
  std::vector<std::string> notes() const;

  Prepared& prepared;
  std::optional<TrialSimulation> trial;    ///< none without enough memory, as all that follows
  std::vector<StepLimit> steps, substeps;  ///< limits
  std::vector<Quantity> numerical_viscosity;
  bool free_surface = false;
  std::vector<Remark> remarks;
  MemoryNeed memory;  ///< after the step
};

}  // namespace bedload
