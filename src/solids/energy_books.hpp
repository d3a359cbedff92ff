#pragma once
// Where the energy of the grains goes, in sums over a run.

#include <array>
#include <vector>

#include "bedload/parallel/reductions.hpp"
#include "bedload/simulation.hpp"
#include "kernels/contact/contact_energy.hpp"

namespace BL_SOLVER {

/// Flows of the substeps stay on the device until an advance ends. What they need between two substeps is
/// found again when an advance begins, so checkpoints hold the sums alone.
class EnergyBooks {
 public:
  /// most: far above the energy that a grain takes or gives in a substep, J.
  explicit EnergyBooks(double most) { most_.fill(most); }
  bool begun() const { return begun_; }
  /// Begins with so much energy of grains, J.
  void begin(double energy) { begun_ = true, start_ = energy, sum_ = EnergyFlow::zero(); }
  /// Until grains move.
  void forget() { begun_ = false, sum_ = EnergyFlow::zero(); }

  /// Sizes what an advance needs; drag: whether the fluid gives impulses.
  void begin_advance(int substeps, std::size_t slots, std::size_t wall_slots, Index grains, bool drag) {
    flows_.resize(std::size_t(kPasses) * (substeps + 2));
    used_ = 0;
    of_pairs_.reserve_and_resize(slots);
    at_walls_.reserve_and_resize(wall_slots);
    course_.resize(drag ? grains : 0);
  }
  /// Counts what a reduction over a range finds, and over those of other ranks.
  template <class Reduction>
  void count(Range range, const Reduction& flow) {
    total_into(flows_.data() + used_++, range, flow, most_);
  }
  void end_advance() {
    const std::vector<EnergyFlow> flows = flows_.to_host();
    for (std::size_t k = 0; k < used_; ++k) sum_.add(flows[k]);
  }

  ContactAction* of_pairs() { return of_pairs_.data(); }
  ContactAction* at_walls() { return at_walls_.data(); }
  GrainCourse* course() { return course_.size() > 0 ? course_.data() : nullptr; }

  /// The terms and the residual; energy: of the grains now, J.
  std::vector<Quantity> terms(double energy) const;
  void save(std::vector<Quantity>& scalars) const;
  /// Of a checkpoint without them: begins anew.
  void load(const std::vector<Quantity>& scalars);
  static constexpr std::size_t kScratch = sizeof(GrainCourse);  ///< bytes of a grain in fluid

 private:
  std::array<double, EnergyFlow::kTerms> most_;
  static constexpr int kPasses = 4;  ///< of a substep: pairs, walls, kicks, clumps
  bool begun_ = false;
  double start_ = 0;  ///< J
  EnergyFlow sum_ = EnergyFlow::zero();
  std::size_t used_ = 0;
  Buffer<EnergyFlow> flows_;
  Buffer<ContactAction> of_pairs_, at_walls_;
  Buffer<GrainCourse> course_;
};

}  // namespace BL_SOLVER
