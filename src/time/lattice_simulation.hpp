#pragma once
// A simulation of fluid on the nodes of a lattice, and of grains around which it flows.

#include <map>
#include <memory>
#include <string>

#include "bedload/case/config.hpp"
#include "bedload/parallel/stopwatch.hpp"
#include "bedload/simulation.hpp"
#include "src/lattice/lattice_solver.hpp"
#include "src/time/clock.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {

class LatticeSimulation final : public Simulation {
 public:
  LatticeSimulation(const Config& config, const Setup& setup);

  StepInfo step() override;
  void settle(double longest, const std::function<void(double)>& progress) override {
    if (grains_) grains_->settle(longest, progress);
  }
  void start() override;

  double time() const override { return clock_.time; }
  std::int64_t steps() const override { return clock_.step; }
  Counts counts() const override {
    return {.fluid = std::int64_t(solver_.grid().size()), .grains = grains_ ? grains_->counts().grains : 0};
  }
  std::vector<StepLimit> limits() override { return limits_; }
  std::vector<StepLimit> substep_limits() const override {
    return grains_ ? grains_->substep_limits() : std::vector<StepLimit>{};
  }
  std::vector<Quantity> numerical_viscosity() const override { return {}; }
  std::size_t bytes() const override { return bytes_held(); }
  ParticleBytes field_bytes() const override {
    ParticleBytes all{.fluid = solver_.bytes_of_node()};
    if (grains_) all += grains_->field_bytes();
    return all;
  }
  ParticleBytes scratch_bytes() const override {
    ParticleBytes all{.fluid = sizeof(Real4)};  // of outputs
    if (grains_) all += grains_->scratch_bytes();
    if (resolved_) all.grains += resolved_->link_bytes(config_.grain.largest());
    return all;
  }
  std::size_t growth() override { return 0; }
  std::vector<Quantity> time_spent() const override;

  HostStore snapshot(const std::string& store) override;
  HostStore rheology(const std::string& store) override;
  std::vector<FieldView> fields(const std::string& store) override {
    return grains_ ? grains_->fields(store) : std::vector<FieldView>{};
  }
  std::vector<Quantity> diagnostics() override;
  std::vector<Quantity> measure(const ProbeConfig& probe) override;
  void begin_interval(const ProbeConfig& probe) override;
  std::vector<Loss> losses() override { return {}; }
  std::vector<Quantity> body_state(int body) override;

  SavedState save() override;
  void load(const SavedState& saved) override;
  SavedState save_grains() override { return grains_ ? grains_->save_grains() : SavedState{}; }
  void load_grains(const SavedState& saved) override {
    if (grains_) grains_->load_grains(saved);
  }

 private:
  /// What a force probe has had when its interval began.
  struct Interval {
    double time = 0;
    WallSums sums;
  };
  void check_extremes();
  void check_grains() const;
  bool held() const { return config_.grain.fixed || clock_.time < config_.grain.release_time; }
  int wall_named(const std::string& name) const;
  std::vector<Quantity> point(const ProbeConfig& probe) const;
  std::vector<Quantity> box(const ProbeConfig& probe) const;
  std::vector<Quantity> body_force(const ProbeConfig& probe) const;

  const Config config_;
  Clock clock_;
  const std::vector<StepLimit> limits_;
  std::unique_ptr<CoupledSimulation> grains_;  ///< without the fluid; null: none
  std::unique_ptr<ResolvedGrains> resolved_;   ///< the same for the fluid
  LatticeSolver solver_;
  Stopwatch watch_;
  double speed_ = 0;  ///< m/s, largest at the last look
  std::map<std::string, Interval> intervals_;
};

}  // namespace BL_SOLVER
