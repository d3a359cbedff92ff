#pragma once
// Takes a state from one step to the next: the solvers, and the order of work.

#include <functional>
#include <limits>
#include <memory>

#include "bedload/case/config.hpp"
#include "bedload/parallel/stopwatch.hpp"
#include "bedload/simulation.hpp"
#include "src/coupling/coupling.hpp"
#include "src/fluid/drive_field.hpp"
#include "src/fluid/fluid_solver.hpp"
#include "src/solids/solid_solver.hpp"
#include "src/time/stage.hpp"
#include "src/time/state.hpp"

namespace BL_SOLVER {

class Stepper {
 public:
  /// Adds to the stores of `state` what solvers need: before it is filled or loaded. Both must outlive this.
  Stepper(const Config& config, State& state);

  /// All that hold fields of this state.
  std::vector<const Store*> stores() const;
  /// Before pairs are looked at between steps: brings all values of ghosts up to date. By all ranks.
  void share_all();
  StepInfo step(const Observer& observer = {});

  /// As Simulation has them.
  void settle(double longest, const std::function<void(double)>& progress);
  void start();
  std::vector<StepLimit> limits();
  std::vector<StepLimit> substep_limits() const;
  std::vector<Quantity> time_spent() const;

  FluidSolver& fluid() { return *fluid_solver_; }
  SolidSolver& solids() { return *solid_solver_; }
  const SolidSolver& solids() const { return *solid_solver_; }
  Coupling& coupling() { return *coupling_; }
  const Coupling& coupling() const { return *coupling_; }
  const FluidExtremes& fluid_extremes() const { return fluid_extremes_; }  ///< after the last step
  const GrainWatch& grain_watch() const { return grain_watch_; }           ///< after the last step
  const StepTime& moment() const { return moment_; }  ///< of the fluid's forces at the end of the last step
  double corrected() const { return corrected_; }     ///< s, with what of it velocities were corrected since
  std::int64_t rebuilds() const { return rebuilds_; }
  ParticleBytes scratch_bytes() const;  ///< as Simulation has it
  /// Of all bodies in the last step, at its start and after each substep; without grains and free bodies
  /// empty.
  Span<const BodyPose> substep_poses() const { return substep_poses_; }
  Span<const Real3> drive_grains();  ///< force on each of them now, N; empty where nothing drives them

  /// Particles that the host has: all, or with several ranks those of this one, by where they are or, of a
  /// checkpoint, by where their lists were built (`listed`).
  void take(const HostState& from, bool listed);
  /// Grains, their contacts and clumps.
  void save_grains(SavedState& out) const;
  /// Block of each grain, as an array "block": by it parts of ranks are put together.
  HostArray blocks_of_grains() const;
  void load_grains(const SavedState& saved);
  /// What solvers and lists must know to restart, besides the state.
  void save(SavedState& out) const;
  /// Once the state is loaded: the grains, and all that save() and save_grains() wrote.
  void load(const SavedState& saved);

 private:
  bool has_fluid() const { return state_.has_fluid; }
  bool has_grains() const { return state_.has_grains; }
  bool coupled() const { return state_.coupled; }
  bool two_way() const { return state_.two_way; }
  bool loads_bodies() const { return has_fluid() && bodies_.any(); }
  bool held() const { return config_.grain.fixed || clock_.time < config_.grain.release_time; }

  template <class MakeAccess>
  void begin(Step& now, std::string_view name, Part part, const MakeAccess& fields);
  std::vector<Store*> divided_stores();  ///< whose particles are divided among ranks
  void share(const Fields& fields);      ///< brings their values to ghosts, where these are outdated
  void outdate(const Fields& fields);    ///< ghosts no longer have the values of their owners
  std::vector<const Store*> clump_stores() const;
  Fields moving_of_clumps() const;
  Fields fluid_in_pairs() const;
  Fields walls_in_pairs() const;
  Fields fields_of_order() const;
  Fields drift() const;
  const FieldBase* flux() const;

  Step next_step();
  StepInfo info_of(const Step& now);
  /// The stages from wall_state() on: forces on fluid, bodies and grains at the end of a step or at the start
  /// of a run.
  void evaluate(Step& now);

  // The stages, in their order.
  void renew_lists(Step& now);
  void interpolate(Step& now);
  void move_solids(Step& now);
  void react(Step& now);
  void collide(Step& now);
  void kick_drift(Step& now);
  void advance(Step& now);
  void move_walls(Step& now);
  void porosity(Step& now);
  void density(Step& now);
  void fluid_state(Step& now);
  void wall_state(Step& now);
  void forces(Step& now);
  void repel(Step& now);
  void load_bodies(Step& now);
  void correct(Step& now);
  void push(Step& now);
  void finish(Step& now);

  void initialise_fluid(Step& now);              ///< mass for the porosity, hydrostatic pressure
  StepTime moment(double t, std::int64_t step);  ///< at t, s, where a step of that number ends
  double wall_travel(double dt) const;           ///< m, that no wall goes beyond in the step to come
  std::vector<StepLimit> body_limits() const;    ///< on a substep
  StepLimit longest_substep() const;             ///< that grains and free bodies allow
  void refresh_if_needed(double dt);
  void refresh(bool fluid, bool grains, double dt = 0);  ///< dt: of the step to come, s
  void load_clumps(const SavedState& saved);             ///< of the grains
  void restore_lists(const SavedState& saved);
  void relist_coupling();
  void remove_cleared_bodies();
  void sweep();  ///< extremes after a step; throws SimulationFault
  Span<const BodyPose> poses_now() { return state_.poses_now(); }

  const Config& config_;
  State& state_;
  const Frame& frame_;
  Clock& clock_;
  FluidStore& fluid_;
  WallStore& walls_;
  GrainStore& grains_;
  FreeBodies& bodies_;
  WallMotion& motion_;
  OpenBoundaries& open_;
  const EffectiveGravity& gravity_;

  DriveFactor fluid_factor_, grain_factor_;  ///< what each refers to must last
  Scratch of_walls_, of_grains_;
  ScratchArray<Real3> grain_drive_{of_grains_, config_.drive.on_grains()};  ///< N
  CellGrid grain_grid_;
  std::unique_ptr<FluidSolver> fluid_solver_;
  std::unique_ptr<SolidSolver> solid_solver_;
  std::unique_ptr<Coupling> coupling_;
  Stopwatch watch_;

  StepTime moment_;       ///< of the last forces
  double corrected_ = 0;  ///< s, kick of the last correction
  Span<const BodyPose> substep_poses_;
  FluidExtremes fluid_extremes_;
  GrainWatch grain_watch_;
  double walls_moved_ = 0;  ///< bound on wall travel since the lists were built, m
  bool rebuilt_ = false;
  std::int64_t rebuilds_ = 0;
  ScratchArray<Vec3d> wall_force_{of_walls_, loads_bodies()};  ///< by which free bodies move
};

}  // namespace BL_SOLVER
