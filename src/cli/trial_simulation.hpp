#pragma once
// A case started for inspection: step limits, timing, memory.

#include <memory>

#include "prepare.hpp"

namespace bedload {

/// Memory of the solver, bytes.
struct MemoryNeed {
  std::size_t all = 0;
  std::size_t fast_flow_bytes = 0;  ///< part of `all` that is needed only in fast flow
};

class TrialSimulation {
 public:
  /// Starts a simulation. Grains that are to settle start from the cached bed if there is one, else where
  /// they were placed.
  explicit TrialSimulation(const Prepared& p);

  Simulation& simulation() { return *simulation_; }
  /// Whether grains are where a run would start them.
  bool starts_from_settled_bed() const { return settling_bytes_ == 0; }
  /// Memory of a run at its end: of this simulation, plus scratch of all outputs of the case, plus longer
  /// neighbour lists in a settled bed.
  MemoryNeed memory();

 private:
  const Config& config_;
  std::unique_ptr<Simulation> simulation_;
  std::ptrdiff_t settling_bytes_ = 0;  ///< that lists grow by as the bed settles
};

}  // namespace bedload
