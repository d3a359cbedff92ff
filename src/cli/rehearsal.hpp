#pragma once
// A case as its run will begin it, to be looked at.

#include <memory>

#include "prepare.hpp"

namespace bedload {

/// What the solver holds, bytes.
struct MemoryNeed {
  std::size_t all = 0;
  std::size_t by_speed = 0;  ///< of that, what only fluid takes that comes to flow fast
};

class Rehearsal {
 public:
  /// Starts a simulation. Grains that are to settle lie as in the bed that is kept from before, else as they
  /// were placed.
  explicit Rehearsal(const Prepared& p);

  Simulation& simulation() { return *simulation_; }
  /// Whether grains lie as they will when a run begins.
  bool lies_as_a_run() const { return settling_ == 0; }
  /// What a run holds at its end, by what the simulation holds now, what it takes to measure all that the
  /// case writes, and what lists take more in a bed that has settled.
  MemoryNeed memory();

 private:
  const Config& config_;
  std::unique_ptr<Simulation> simulation_;
  std::ptrdiff_t settling_ = 0;  ///< bytes
};

}  // namespace bedload
