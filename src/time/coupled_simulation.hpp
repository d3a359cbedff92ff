#pragma once
// One simulation: the state, the solvers that advance it, and the order of work in a step.

#include <utility>

#include "bedload/parallel/stopwatch.hpp"
#include "bedload/simulation.hpp"
#include "src/boundaries/open_boundaries.hpp"
#include "src/coupling/coupling.hpp"
#include "src/fluid/drive_field.hpp"
#include "src/fluid/fluid_solver.hpp"
#include "src/solids/solid_solver.hpp"
#include "src/time/clock.hpp"
#include "src/walls/wall_motion.hpp"

namespace bedload::inline BL_VARIANT {

/// The store of that name; FileError without it.
const HostStore& store_of(const SavedState& state, const std::string& name);

class CoupledSimulation final : public Simulation {
 public:
  CoupledSimulation(const Config& config, const Setup& setup);

  StepInfo step() override;
  void settle(double longest, const std::function<void(double)>& progress) override;
  void start() override;

  double time() const override { return clock_.time; }
  std::int64_t steps() const override { return clock_.step; }
  Counts counts() const override { return {fluid_.size(), walls_.size(), grains_.size()}; }
  std::vector<StepLimit> limits() override;
  std::vector<StepLimit> body_limits() const override;
  std::vector<Quantity> numerical_viscosity() const override;
  std::size_t bytes() const override { return bytes_held(); }
  std::vector<Quantity> time_spent() const override;

  HostStore snapshot(const std::string& store) override;
  HostStore rheology(const std::string& store) override;
  std::vector<FieldView> fields(const std::string& store) override;
  std::vector<Quantity> diagnostics() override;
  std::vector<Quantity> measure(const ProbeConfig& probe) override;
  std::vector<Quantity> body_state(int body) override;

  SavedState save() override;
  void load(const SavedState& state) override;
  SavedState save_grains() override;
  void load_grains(const SavedState& state) override;

 private:
  bool has_fluid() const { return config_.fluid.present; }
  bool has_grains() const { return config_.grain.present; }
  bool coupled() const { return coupling_ != nullptr; }
  bool two_way() const { return coupled() && config_.couple.mode == CouplingMode::two_way; }
  bool held() const { return config_.grain.fixed || clock_.time < config_.grain.release_time; }

  /// Of the second half-kick of a step dt that ends with the fluid's forces, s.
  double last_kick(double dt) const { return config_.time.integrator == TimeIntegrator::euler ? 0 : dt / 2; }

  void upload(const Setup& setup);
  void initialise_fluid();  ///< mass for the porosity, hydrostatic pressure
  void advance_fluid(double dt);
  Span<const Real3> drive_grains();  ///< force on each of them now, N; empty where nothing drives them
  void update_porosity(double dt);   ///< between fluid and grains that have both moved
  void evaluate_fluid(double dt, double predict);  ///< density and state known: walls, forces
  void push_grains(double dt, double kick);        ///< forces known: what of them falls to the grains
  double wall_travel(double dt) const;             ///< m, that no wall goes beyond in the step to come
  double longest_substep();                        ///< s, that grains and free bodies allow
  void load_bodies(double kick, double dt);        ///< force of the fluid on free bodies at the end of a step
  void refresh_if_needed(double dt);
  void refresh(bool fluid, bool grains, double dt = 0);  ///< dt: of the step to come, s
  void load_grain_store(const SavedState& state);            ///< and the rigid groups of the grains
  void restore_lists(const SavedState& state);
  void relist_coupling();
  void remove_cleared_bodies();
  void sweep();  ///< extremes after a step; throws SimulationFault
  Span<const BodyPose> poses_now() { return motion_.poses(clock_.time, 0, 1); }

  /// What was worked out after one step, kept until the next.
  template <class T>
  struct Kept {
    T value;
    std::int64_t step = -1;
    bool due(std::int64_t now) { return std::exchange(step, now) != now; }
  };
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
  const FluidLoads& fluid_loads();
  LoadSum grain_load(int body);                   ///< of the grains on a body about its centre
  int wall_named(const std::string& name) const;  ///< place among the wall bodies
  std::vector<Quantity> front(const ProbeConfig& probe);
  std::vector<Quantity> point(const ProbeConfig& probe);
  std::vector<Quantity> column(const ProbeConfig& probe);
  std::vector<Quantity> box(const ProbeConfig& probe);
  std::vector<Quantity> body_force(const ProbeConfig& probe);
  std::vector<Quantity> wall_pressure(const ProbeConfig& probe);

  enum Part { kLists, kFluid, kGrains, kCoupling, kChecks };  ///< of a step, that are timed

  Config config_;
  Frame frame_;
  Clock clock_;
  Stopwatch watch_;
  FluidStore fluid_;
  WallStore walls_;
  GrainStore grains_;
  WallGeometry geometry_, grain_geometry_;  ///< that fluid and that grains meet
  WallGeometry shells_;                     ///< with fluid on both sides: single layers
  FreeBodies bodies_;
  WallMotion motion_;
  OpenBoundaries open_;
  EffectiveGravity gravity_;
  GrainMatter matter_;
  DriveFactor drive_factor_;
  Buffer<Real3> grain_drive_;  ///< N
  CellGrid grain_grid_;
  std::unique_ptr<FluidSolver> fluid_solver_;
  std::unique_ptr<SolidSolver> solid_solver_;
  std::unique_ptr<Coupling> coupling_;

  FluidExtremes fluid_extremes_;
  GrainWatch grain_watch_;
  double drag_limit_ = std::numeric_limits<double>::infinity();  ///< s, of the last exchange
  double walls_moved_ = 0;  ///< bound on wall travel since the lists were built, m
  bool rebuilt_ = false;
  std::int64_t rebuilds_ = 0;
  Buffer<Vec3d> wall_force_;    ///< by which free bodies move
  FluidMoments fluid_moments_;  ///< scratch of rheology
  Buffer<PairMoment<>> contact_moments_;
  Kept<WallForces> wall_forces_;
  Kept<FluidLoads> fluid_loads_;
  Kept<std::vector<LoadSum>> grain_loads_;
};

}  // namespace bedload::inline BL_VARIANT
