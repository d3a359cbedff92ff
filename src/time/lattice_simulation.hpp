#pragma once
// A simulation of fluid on the nodes of a lattice.

#include <map>
#include <string>

#include "bedload/case/config.hpp"
#include "bedload/parallel/stopwatch.hpp"
#include "bedload/simulation.hpp"
#include "src/lattice/lattice_solver.hpp"
#include "src/time/clock.hpp"

namespace BL_SOLVER {

class LatticeSimulation final : public Simulation {
 public:
  LatticeSimulation(const Config& config, const Setup& setup);

  StepInfo step() override;
  void settle(double, const std::function<void(double)>&) override {}  // nothing settles
  void start() override;

  double time() const override { return clock_.time; }
  std::int64_t steps() const override { return clock_.step; }
  Counts counts() const override { return {.fluid = std::int64_t(solver_.grid().size())}; }
  std::vector<StepLimit> limits() override { return limits_; }
  std::vector<StepLimit> substep_limits() const override { return {}; }
  std::vector<Quantity> numerical_viscosity() const override { return {}; }
  std::size_t bytes() const override { return bytes_held(); }
  ParticleBytes field_bytes() const override { return {.fluid = solver_.bytes_of_node()}; }
  ParticleBytes scratch_bytes() const override { return {.fluid = sizeof(Real4)}; }  // of outputs
  std::size_t growth() override { return 0; }
  std::vector<Quantity> time_spent() const override;

  HostStore snapshot(const std::string& store) override;
  HostStore rheology(const std::string& store) override { return {store, 0, {}}; }
  std::vector<FieldView> fields(const std::string&) override { return {}; }
  std::vector<Quantity> diagnostics() override;
  std::vector<Quantity> measure(const ProbeConfig& probe) override;
  void begin_interval(const ProbeConfig& probe) override;
  std::vector<Loss> losses() override { return {}; }
  std::vector<Quantity> body_state(int body) override;

  SavedState save() override;
  void load(const SavedState& saved) override;
  SavedState save_grains() override { return {}; }
  void load_grains(const SavedState&) override {}

 private:
  /// What a force probe has had when its interval began.
  struct Interval {
    double time = 0;
    WallSums sums;
  };
  void check_extremes();
  int wall_named(const std::string& name) const;
  std::vector<Quantity> point(const ProbeConfig& probe) const;
  std::vector<Quantity> box(const ProbeConfig& probe) const;
  std::vector<Quantity> body_force(const ProbeConfig& probe) const;

  const Config config_;
  Clock clock_;
  const std::vector<StepLimit> limits_;
  LatticeSolver solver_;
  Stopwatch watch_;
  double speed_ = 0;  ///< m/s, largest at the last look
  std::map<std::string, Interval> intervals_;
};

}  // namespace BL_SOLVER
