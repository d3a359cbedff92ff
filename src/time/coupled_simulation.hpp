#pragma once
// One simulation: its state, what steps it, and its readings.

#include <map>
#include <memory>
#include <utility>

#include "bedload/parallel/host_copies.hpp"
#include "src/measure/field_means.hpp"
#include "src/measure/force_meters.hpp"
#include "src/time/stepper.hpp"

namespace BL_SOLVER {

class CoupledSimulation final : public Simulation {
 public:
  /// link: to other ranks, each on a thread of its own; null: there are none.
  CoupledSimulation(const Config& config, const Setup& setup, Link* link = nullptr);

  StepInfo step() override {
    const StepInfo info = stepper_.step();
    if (meters_.any()) advance_meters(info.dt);
    if (field_means_.any()) sample_fields();
    return info;
  }
  void settle(double longest, const std::function<void(double)>& progress) override {
    stepper_.settle(longest, progress);
  }
  void start() override {
    stepper_.start();
    begin_meters(nullptr);
    field_means_.load({}, state_.clock.time);
  }

  double time() const override { return state_.clock.time; }
  std::int64_t steps() const override { return state_.clock.step; }
  Counts counts() const override {
    return {state_.fluid.everywhere(), state_.walls.everywhere(), state_.grains.everywhere()};
  }
  std::vector<StepLimit> limits() override { return stepper_.limits(); }
  std::vector<StepLimit> substep_limits() const override { return stepper_.substep_limits(); }
  std::vector<Quantity> numerical_viscosity() const override;
  std::size_t bytes() const override { return bytes_held(); }
  ParticleBytes field_bytes() const override;
  ParticleBytes scratch_bytes() const override { return stepper_.scratch_bytes(); }
  std::size_t growth() override { return state_.has_fluid ? stepper_.fluid().growth() : 0; }
  std::vector<Quantity> time_spent() const override { return stepper_.time_spent(); }
  std::vector<RankReport> ranks() override;

  HostStore snapshot(const std::string& store) override;
  Later<HostStore> snapshot_later(const std::string& store) override;
  HostStore rheology(const std::string& store) override;
  std::vector<FieldView> fields(const std::string& store) override;
  std::vector<Quantity> diagnostics() override;
  std::vector<std::vector<Quantity>> spectra() override;
  std::vector<std::vector<Quantity>> spectra_peaks() override;
  std::vector<Quantity> measure(const ProbeConfig& probe) override;
  void begin_interval(const ProbeConfig& probe) override;
  std::vector<Loss> losses() override;
  std::vector<Quantity> body_state(int body) override;

  SavedState save() override;
  void load(const SavedState& saved) override;
  SavedState save_grains() override;
  void load_grains(const SavedState& saved) override;

  State& state() { return state_; }
  Stepper& stepper() { return stepper_; }

 private:
  /// What was worked out after one step, kept until the next.
  template <class T>
  struct Kept {
    T value;
    std::int64_t step = -1;
    bool due(std::int64_t now) { return std::exchange(step, now) != now; }
  };
  const Store* store_named(const std::string& name) const;  ///< null if the case has none
  /// Fields of a store that are outputs for some use.
  std::vector<const FieldBase*> written(const Store& store, Use by) const;
  /// These and what is computed, in their order.
  HostStore outputs(const std::string& store, Use by, HostCopies* copies);
  std::vector<bool> removed_walls() const;  ///< of each wall body; empty: none is gone
  /// Where there are several ranks, adds an array "block" with the block of cells of each particle, by which
  /// their parts are put together.
  void add_blocks(HostStore& out);
  void add_blocks(SavedState& out) {
    for (HostStore& store : out.stores) add_blocks(store);
  }
  struct WallForces {
    Buffer<Vec3d> pressure, friction;
  };
  /// On each body about its centre; pressure with the push of single layers and repulsion.
  struct FluidLoads {
    std::vector<LoadSum> pressure, friction;
    LoadSum all(int body) const {
      LoadSum sum = pressure[body];
      LoadSum::combine(sum, friction[body]);
      return sum;
    }
  };
  const WallForces& wall_forces();  ///< of the fluid on wall particles, repulsion from surfaces apart
  const FluidLoads& fluid_loads();  ///< of pairs and repulsion
  /// What pressure.linear_exact adds to the pressure loads on closed bodies that are held or moved: by wall
  /// body, about their centres, on the device. Empty without.
  Span<const LoadSum> held_corrections();
  LoadSum correction(int body);  ///< the same of one, or of a free body
  /// Adds where the energy of the fluid goes, by terms, and how many particles are held by limits.
  /// corrections: power on bodies of what correction() adds to the loads on them, W.
  void report_powers(const Drive& drive, double corrections, std::vector<Quantity>& out);
  LoadSum grain_load(int body);  ///< of the grains on a body about its centre
  LoadSum body_load(int body);   ///< of other bodies, likewise; where there are free ones
  BodyActions actions_on(int body, const Vec3d& about);  ///< now; torque about a point (m)
  void add_meters();
  void begin_meters(const SavedState* saved);  ///< null: a fresh start
  void advance_meters(double dt);
  int wall_named(const std::string& name) const;  ///< place among the wall bodies
  /// Of a probe at one point.
  std::vector<Quantity> measure_one(const ProbeConfig& probe);
  std::vector<Quantity> front(const ProbeConfig& probe);
  std::vector<Quantity> point(const ProbeConfig& probe);
  std::vector<Quantity> column(const ProbeConfig& probe);
  std::vector<Quantity> box(const ProbeConfig& probe);
  std::vector<Quantity> flux(const ProbeConfig& probe);
  std::vector<Quantity> body_force(const ProbeConfig& probe);
  std::vector<Quantity> wall_pressure(const ProbeConfig& probe);
  std::vector<Quantity> mixing(const ProbeConfig& probe);
  std::vector<Quantity> field(const ProbeConfig& probe);
  std::vector<double> field_sums(const ProbeConfig& probe);  ///< [points][CoarseTerms::kSums]
  void sample_fields();

  const Config config_;
  State state_;
  Stepper stepper_;

  std::map<std::string, HostCopies> copies_;  ///< of stores to the host
  FluidMoments fluid_moments_;                ///< scratch of outputs
  Buffer<PairMoment<>> contact_moments_;
  Kept<WallForces> wall_forces_;
  Kept<FluidLoads> fluid_loads_;
  Kept<std::unique_ptr<PressureCorrection>> held_;  ///< null until needed
  Kept<std::vector<LoadSum>> grain_loads_;
  ForceMeters meters_;
  FieldMeans field_means_;
  Buffer<LoadSum> meter_pressure_, meter_friction_, meter_repulsion_;  ///< scratch
};

}  // namespace BL_SOLVER
