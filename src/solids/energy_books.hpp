#pragma once
// Where the energy of the grains goes, in sums over a run.

#include <array>
#include <memory>
#include <vector>

#include "bedload/parallel/reductions.hpp"
#include "bedload/particles/grains.hpp"
#include "bedload/simulation.hpp"
#include "kernels/contact/film_energy.hpp"

namespace BL_SOLVER {

/// Flows to each grain are added up on the device until an advance ends. What they need between two substeps
/// is found again when an advance begins, but for lubrication; so checkpoints hold that and the sums alone.
class EnergyBooks {
 public:
  /// most: far above the energy that a grain takes or gives in a substep, J; films: of lubrication, which
  /// then is a field of the grains.
  EnergyBooks(double most, GrainStore& grains, bool films) : most_(most), all_(2) {
    if (!films) return;
    films_ = std::make_unique<Field<FilmAction>>(grains, "film_action", "N, N m, W", Lifetime::kept);
    films_->begin_at_zero();
    films_->resize(grains.size());
  }
  bool begun() const { return begun_; }
  /// Begins with so much energy of grains, J.
  void begin(double energy) { forget(), begun_ = true, start_ = energy; }
  /// Until grains move.
  void forget() { begun_ = false, sum_ = EnergyFlow::zero(), in_ = out_ = 0; }
  /// Grains have come in or left with so much energy, J.
  void add_in(double energy) { in_ += energy; }
  void add_out(double energy) { out_ += energy; }

  /// Sizes what an advance needs; drag: whether the fluid gives impulses.
  void begin_advance(std::size_t slots, std::size_t wall_slots, Index grains, Index clumps, bool drag) {
    flows_.reserve_and_resize(grains);
    of_clumps_.resize(clumps);
    flows_.zero(), of_clumps_.zero();
    of_pairs_.reserve_and_resize(slots);
    at_walls_.reserve_and_resize(wall_slots);
    course_.resize(drag ? grains : 0);
    course_of_clumps_.resize(drag ? clumps : 0);
  }
  /// Adds what has flowed to these grains, and to those of other ranks, and to clumps, which every rank has.
  void end_advance(Range grains, int substeps) {
    std::array<double, EnergyFlow::kTerms> most;
    most.fill(most_ * (substeps + 2));
    const auto clumps = Index(of_clumps_.size());
    total_into(all_.data(), grains, FlowTotal{flows_.data()}, most);
    if (clumps > 0)
      total_into(all_.data() + 1, {0, Context::current().rank() == 0 ? clumps : 0},
                 FlowTotal{of_clumps_.data()}, most);
    const std::vector<EnergyFlow> all = all_.to_host();
    sum_.add(all[0]);
    if (clumps > 0) sum_.add(all[1]);
  }

  EnergyFlow* flows() { return flows_.data(); }
  EnergyFlow* of_clumps() { return of_clumps_.data(); }
  ContactAction* of_pairs() { return of_pairs_.data(); }
  ContactAction* at_walls() { return at_walls_.data(); }
  FilmAction* films() { return films_->buffer().data(); }  ///< only with lubrication
  const FieldBase* film_field() const { return films_.get(); }
  ClumpCourse* course_of_clumps() { return course_of_clumps_.data(); }
  GrainCourse* course() { return course_.size() > 0 ? course_.data() : nullptr; }

  /// The terms and the residual; energy: of the grains now, J.
  std::vector<Quantity> terms(double energy) const;
  void save(std::vector<Quantity>& scalars) const;
  /// Of a checkpoint without them: begins anew.
  void load(const std::vector<Quantity>& scalars);
  static constexpr std::size_t kScratch =
      sizeof(EnergyFlow) + sizeof(GrainCourse);  ///< bytes of a grain in fluid

 private:
  double most_;  ///< J
  bool begun_ = false;
  double start_ = 0;         ///< J
  double in_ = 0, out_ = 0;  ///< of grains that have come in, and that have left, J
  EnergyFlow sum_ = EnergyFlow::zero();
  Buffer<EnergyFlow> flows_, of_clumps_;  ///< [grains], [clumps]
  Buffer<EnergyFlow> all_;                ///< sums of both
  Buffer<ContactAction> of_pairs_, at_walls_;
  Buffer<GrainCourse> course_;
  std::unique_ptr<Field<FilmAction>> films_;  ///< null without lubrication
  Buffer<ClumpCourse> course_of_clumps_;
};

}  // namespace BL_SOLVER
