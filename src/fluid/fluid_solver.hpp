#pragma once
// Locally averaged WCSPH between walls: rates, advance, stable time step.

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <memory>

#include "bedload/neighbours/pairing.hpp"
#include "bedload/parallel/compact.hpp"
#include "bedload/parallel/reading.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/grains.hpp"
#include "bedload/particles/scratch.hpp"
#include "bedload/particles/walls.hpp"
#include "bedload/step_limits.hpp"
#include "kernels/fluid/drive.hpp"
#include "kernels/fluid/equation_of_state.hpp"
#include "kernels/fluid/fluid_powers.hpp"
#include "kernels/fluid/omega_pass.hpp"
#include "kernels/fluid/pair_terms.hpp"
#include "kernels/fluid/sheared_pass.hpp"
#include "kernels/fluid/wall_density.hpp"
#include "kernels/fluid/wall_pass.hpp"
#include "kernels/fluid/wall_repulsion.hpp"
#include "kernels/integrate/fluid_kicks.hpp"
#include "kernels/stress/fluid_stress.hpp"
#include "src/fluid/parameters.hpp"
#include "src/walls/pressure_correction.hpp"
#include "src/walls/wall_geometry.hpp"

namespace BL_SOLVER {

/// Largest values that bound the next step, from one sweep over the fluid.
struct FluidExtremes {
  double v2 = 0, acc2 = 0;                                 ///< (m/s)2, (m/s2)2
  double lasts = std::numeric_limits<double>::infinity();  ///< for how long the lists hold, at least, s
  double eps_min = 1;
  double thickest = 1;  ///< viscosity over fluid.mu that grains bring about, the largest
  double h_min = std::numeric_limits<double>::infinity();  ///< smallest smoothing length, m
  double growth = 1;  ///< largest factor by which one has grown since the lists were built
  Id bad = kNone;     ///< lowest of particles with NaN or a density out of range
};

/// How fast that goes for which lists are made.
struct ListSpeeds {
  double dt = 0;                ///< of a step, s
  double fluid = 0, walls = 0;  ///< fastest, m/s
  bool walls_move = false;      ///< now or later
};

/// Of the forces between pairs of fluid, a particle each: what its stress is made of, J.
struct FluidMoments {
  Buffer<PairMoment<>> pressure, friction, noise;  ///< noise: empty without any

  StressParts parts(Index count, bool noisy) {
    pressure.resize(count), friction.resize(count), noise.resize(noisy ? count : 0);
    return {pressure, friction, noise};
  }
};

/// Spin of fluid particles: fields of a model that has it.
struct Spin {
  double inertia;  ///< moment of a particle over its mass, m2
  Field<Real3> omega, acc;

  Spin(FluidStore& fluid, double inertia)
      : inertia(inertia),
        omega(fluid, "angular_velocity", "rad/s", Lifetime::kept, Output{.order = 12}),
        acc(fluid, "angular_acceleration", "rad/s2", Lifetime::kept) {}
};

/// Smoothing lengths of particles, where each has its own.
struct SmoothingLengths {
  Field<Real> h, h_list, omega;  ///< h_list: where the lists were built
  double listed;                 ///< m, that lists and cells are made for
  bool begun = false;            ///< particles have a state

  SmoothingLengths(FluidStore& fluid, double h0)
      : h(fluid, "smoothing_length", "m", Lifetime::kept, Output{.order = 6}),
        h_list(fluid, "smoothing_length_list", "m", Lifetime::renewed),
        omega(fluid, "omega", "-", Lifetime::kept),
        listed(h0) {}
};

/// When the fluid's forces act: at the end of a step, or at the start of a run; and what depends on time
/// alone.
struct StepTime {
  std::uint64_t step = 0;  ///< number of the step, which keys the noise
  Real3 gravity;           ///< minus the frame's acceleration, m/s2
  DriveField drive{};      ///< where the case drives fluid
};

class FluidSolver {
 public:
  /// Chooses model and kernel function once. `walls` and `fluid`, of which it may keep more, must outlive it;
  /// construct it before `fluid` is filled or loaded.
  static std::unique_ptr<FluidSolver> make(const FluidParameters& parameters, const Frame& frame,
                                           const WallGeometry& walls, FluidStore& fluid);
  virtual ~FluidSolver() = default;

  /// Kernel support, m; where smoothing lengths vary, the most it may be until lists are renewed.
  double range() const {
    return lengths_ ? kappa_ * lengths_->listed * double(kLengthGrowth) : kappa_ * parameters_.fluid.h();
  }
  double skin() const { return 2 * half_skin_; }  ///< by which lists reach beyond that, at most, m
  HalfSkins half_skins(const FluidStore& fluid) const { return {fluid.half_skin, half_skin_}; }
  /// Half the smallest kernel support, m, to which time steps go.
  double half_range(const FluidExtremes& now) const { return kappa_ * now.h_min / 2; }
  /// Null where all particles have the same smoothing length.
  const SmoothingLengths* lengths() const { return lengths_.get(); }
  const MeanShear& shear() const { return shear_; }
  /// Whether the lists must be built anew before another step of dt (s), by the end of which the fastest wall
  /// will have gone so far (m) since they were built.
  bool due(const FluidExtremes& now, double dt, double walls_moved) const {
    const bool outgrown = now.growth > 0.25 + 0.75 * double(kLengthGrowth);  // perhaps within the step
    return dt > now.lasts || dt > longest_step() || walls_moved > wall_skin_ || outgrown;
  }
  const EquationOfState& eos() const { return eos_; }
  /// A thousand times the pressure by which density doubles, on the area of a particle.
  LoadBounds load_bounds() const {
    const FluidProperties& f = parameters_.fluid;
    return {1024 * f.rho0 * f.c * f.c, parameters_.domain.cell_volume(f.dx) / f.dx, norm(frame_.length)};
  }
  Drive drive(const FluidStore& fluid, const StepTime& now) const;
  /// Velocity of particles in addition to that of the fluid (shifting, XSPH); empty without.
  Span<const Real3> drift_of(const FluidStore& fluid) const { return span_if(drifts(), fluid.drift); }
  Span<Real3> drift_of(FluidStore& fluid) const { return span_if(drifts(), fluid.drift); }
  bool shifts() const { return parameters_.order.shifts; }
  /// Whether pressure forces are made exact for linear pressures (LinearFit).
  bool fits() const { return parameters_.order.linear_exact; }
  /// Bulk viscosity of the acoustic damper, Pa s.
  double damping() const {
    return parameters_.pressure.damper * parameters_.fluid.rho0 * parameters_.fluid.c * parameters_.fluid.h();
  }
  /// Whether anything but continuity changes the density.
  bool smooths() const {
    return parameters_.density.delta > 0 || parameters_.density.void_relaxation > 0 ||
           parameters_.spreading > 0;
  }
  bool drifts() const { return shifts() || parameters_.xsph > 0; }
  /// Whether forces() finds how the density changes, too, by which advance() takes it on: then without
  /// density().
  bool one_pass() const { return !rates_.empty(); }
  /// What collide() leaves beside velocities; null without.
  const FieldBase* collisions() const { return collisions_.get(); }
  /// CollisionPass over the lists and packed positions (visc.collision).
  void collide(FluidStore& fluid);
  /// Of shifting, at most, over a step dt (s), m/s.
  double fastest_shift(double dt) const { return dt > 0 ? 0.1 * parameters_.fluid.dx / dt : 0; }
  /// Longest step that viscosity allows.
  virtual StepLimit friction_limit(const FluidExtremes& now) const;
  /// Null where particles do not spin.
  virtual Spin* spin() { return nullptr; }
  /// What it adds to the store that forces() sets.
  virtual std::vector<const FieldBase*> fields_of_forces() const {
    std::vector<const FieldBase*> out;
    for (const auto& rate : rates_) out.push_back(rate.get());
    if (lengths_) out.push_back(&lengths_->omega);
    return out;
  }
  /// Whether repel() has anything to do.
  bool repels() const { return repelling_.surfaces.size > 0 || orifices_.size() > 0; }
  /// Whether fluid pays for the work of the pressure of walls.
  bool pays_for_walls() const { return parameters_.energy_consistent; }
  /// Whether some walls have their own density, which density() takes on.
  bool freezes() const { return parameters_.frozen; }

  /// Sorts the fluid and rebuilds all lists; sorts the walls too if they have moved. If lists would last less
  /// than eight steps, fast particles get up to four times the skin, so that they do not force rebuilds for
  /// all.
  void refresh(FluidStore& fluid, WallStore& walls, bool walls_moved, const ListSpeeds& speeds);
  /// With several ranks, `cells` of grains are divided as those of the fluid: fluid and grains that are less
  /// than `range` and a half skin of the fluid (m) from each other are known to the same rank.
  void divide_with(const GrainStore& grains, CellGrid& cells, double range) {
    grains_ = &grains, grain_cells_ = &cells, grain_range_ = range;
  }
  /// With several ranks: divides the blocks of cells among them by the particles in them, by where these are
  /// or, after a restart, by where the lists were built (`listed`).
  void divide(FluidStore& fluid, const WallStore& walls, bool listed);
  /// Particles of a store that are in blocks of this rank.
  std::vector<Index> own_places(FluidStore& fluid, bool listed);
  std::vector<Index> own_places(const WallStore& walls, bool listed) const;
  /// Renews the lists for the positions as they are; `sort`: cells too (after a restart).
  void relist(FluidStore& fluid, WallStore& walls, bool sort);
  /// Additional memory of the lists, bytes, once fast flow widens the skins; 0 if they are wide already. An
  /// estimate: the mean speed is half the largest, and so is the mean half skin.
  std::size_t growth() const;
  /// Copies of positions as pair loops read them; of walls also where they were `back` (s) ago.
  void pack(FluidStore& fluid);
  void pack(WallStore& walls, double back = 0);

  /// v += kick (acc + reaction), x += drift (v + drift velocity); packs x and where it was `back` (s) ago;
  /// `coupled`: there is a reaction.
  void kick_drift(FluidStore& fluid, double kick, double drift, double back, bool coupled);
  /// Compression, and the density of frozen walls, from continuity over dt since `start`, whose gravity is
  /// that of the hydrostatic slope, at mid-step positions; or summed up, at those of its end.
  /// compression_next has the former compression.
  void density(FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose, const StepTime& start,
               double dt) {
    find_density(fluid, walls, pose, start, dt);
    fluid.compression.buffer().swap(fluid.compression_next.buffer());
    if (shifts()) fluid.exposure.buffer().swap(fluid.exposure_next.buffer());
  }
  /// Pressure from the density, velocity predicted by `kick`.
  void state(FluidStore& fluid, double kick, bool coupled);
  /// one_pass(): kick_drift() over dt, density a step dt (s) on, and state().
  void advance(FluidStore& fluid, double kick, double dt, double predict);
  /// Wall particles' state from the fluid; of dry ones only where `moving` walls may change it. Poses on the
  /// device, one a body; gravity as of StepTime; drag_dt: the step in which drag_kick arose (s), 0 where
  /// there is none.
  virtual void walls(const FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose,
                     const Real3& gravity, double drag_dt, bool moving) = 0;
  /// stress_acceleration, acc_next, XSPH's part of the drift. One pose a body; the step (s) that ends now
  /// caps the push of single layers.
  virtual void forces(FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose,
                      const StepTime& now, double dt) = 0;
  /// Adds what surfaces of walls and orifices do to acc_next. One pose a body; velocities are predicted by
  /// `kick` in a step of dt, s.
  void repel(FluidStore& fluid, Span<const BodyPose> pose, double kick, double dt);
  WallRepulsion repulsion(const FluidStore& fluid, Span<const BodyPose> pose, double dt) const;
  OrificeRepulsion orifice_repulsion(Span<const BodyPose> pose, double dt) const;
  /// v += kick (acc_next - acc); acc = acc_next; and a survey.
  void correct(FluidStore& fluid, double kick);
  /// Finds what bounds the next step, for extremes(); v += kick (acc - acc_next).
  void survey(FluidStore& fluid, double kick = 0);
  /// As of the last survey. Waits for it.
  FluidExtremes extremes() const;
  /// Force of the fluid on every wall particle (N), push of surfaces apart, the opposite of what forces()
  /// gave the fluid `now`. After a step of dt (s), before the lists are renewed; corrected: the kick by which
  /// correct() has changed velocities since then, s.
  virtual void wall_forces(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose,
                           const StepTime& now, double corrected, double dt, Buffer<Vec3d>& force) = 0;
  /// The same by parts: pressure with the push of single layers; friction.
  virtual void wall_forces(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose,
                           const StepTime& now, double corrected, double dt, Buffer<Vec3d>& pressure,
                           Buffer<Vec3d>& friction) = 0;
  /// Finds what is added to the pressure loads on bodies, where fits(). One pose a body.
  void correct_pressure(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose,
                        PressureCorrection& correction) {
    body_pressures(fluid, walls, correction.fit(walls, pose, load_bounds()));
    correction.find(walls, pose, load_bounds());
  }
  /// FluidPowers of each particle, as they are now; after a step of dt (s), before the lists are renewed.
  /// Empty if a model does not report them.
  virtual Span<const FluidPowers> powers(FluidStore&, WallStore&, Span<const BodyPose>, const StepTime&,
                                         double) {
    return {};
  }
  /// Moments of the forces between pairs, by the laws of forces() for the velocities that the fluid has now.
  /// After a step of dt (s), before the lists are renewed.
  virtual void moments(FluidStore& fluid, const WallStore& walls, const StepTime& now, double dt,
                       FluidMoments& out) = 0;
  /// Pairs of fluid particles within the kernel's reach that see each other through one of the surfaces.
  double pairs_through(const FluidStore& fluid, const SurfaceSet& surfaces, Span<const BodyPose> pose) const;

  const CellGrid& grid() const { return grid_; }
  /// Block of each particle, as an array "block": by it parts of ranks are put together.
  HostArray blocks(FluidStore& fluid);
  HostArray blocks(const WallStore& walls);
  ParticleBytes scratch_bytes() const {
    return {.fluid = of_fluid_.entry_bytes(), .walls = of_walls_.entry_bytes()};
  }

  /// Its state outside the store.
  void save(std::vector<Quantity>& scalars) const;
  template <class Scalar>
  void load(const Scalar& scalar) {
    last_dt_ = scalar("density_last_dt"), dt_before_ = scalar("density_dt_before");  // 0 without rates
    if (lengths_) lengths_->listed = scalar("smoothing_length_listed"), lengths_->begun = true;
    half_skin_ = scalar("half_skin_fluid"), wall_skin_ = scalar("half_skin_walls");
    if (shear_.acts()) shear_.strain = scalar("shear_strain"), listed_strain_ = scalar("shear_strain_listed");
    make_cells();
  }

 protected:
  /// While it lives, pair loops find particles where they were in the middle of the step.
  class AtMidStep {
   public:
    AtMidStep(FluidStore& fluid, WallStore& walls) : fluid_(fluid), walls_(walls) { swap(); }
    ~AtMidStep() { swap(); }
    AtMidStep(const AtMidStep&) = delete;

   private:
    void swap() {
      if (fluid_.xp_mid.used()) fluid_.xp.buffer().swap(fluid_.xp_mid.buffer());
      if (walls_.xp_mid.used()) walls_.xp.buffer().swap(walls_.xp_mid.buffer());
    }
    FluidStore& fluid_;
    WallStore& walls_;
  };

  FluidSolver(const FluidParameters& parameters, const Frame& frame, const WallGeometry& walls,
              FluidStore& fluid, double kappa);
  /// BodyPressurePass, where fits().
  virtual void body_pressures(const FluidStore&, const WallStore&, const BodyPressures&) {}
  /// density(), into compression_next.
  virtual void find_density(FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose,
                            const StepTime& start, double dt) = 0;
  void make_cells();
  /// Gives everything its half skin; whether that takes other cells.
  bool renew_skins(const ListSpeeds& speeds);
  double least_skin() const;    ///< half the skin that a case asks for, m
  double wide_skin() const;     ///< and of the fastest where lists would not last, m
  double longest_step() const;  ///< no step is longer, s
  /// Lengths from volumes, to be listed; whether that takes other cells.
  bool renew_lengths(FluidStore& fluid);
  LengthPass length_pass(FluidStore& fluid, bool renew);
  KickDriftPass kick_drift_pass(FluidStore& fluid, double kick, double drift, double back, bool coupled);
  StatePass state_pass(FluidStore& fluid, const DensityHistory& history, double kick, bool coupled);
  /// Takes in the rates that forces() has written to the last of rates_, at the end of a step dt (s).
  void accept_rates(double dt);
  /// Velocity and density as pair loops read them: of the mixture where grains share the space, peculiar
  /// where fluid is sheared.
  Span<const VelocityDensity<>> flux(const FluidStore& fluid) const {
    return parameters_.mixed || shear_.acts() ? fluid.flux : fluid.v_rho;
  }
  // what passes take together
  FluidView view(const FluidStore& fluid) const { return {flux(fluid), fluid.eos_state}; }
  static WallView view(const WallStore& walls) { return {walls.v_rho, walls.state, walls.no_slip}; }
  FluidMotion motion(FluidStore& fluid) const { return {frame_, shear_, fluid.x, fluid.v_rho}; }
  BeforeCorrection before_correction(const FluidStore& fluid, double kick) const {
    return {Real(parameters_.mixed ? 0 : kick), fluid.acc, fluid.acc_next};
  }
  PairCopies copies(FluidStore& fluid) const {
    return {fluid.xp, fluid.xp_mid, span_if(shear_.acts(), fluid.flux)};
  }
  /// Within a stage: gives ghosts what a pass has written and the next reads near.
  static void share(Store& store, std::initializer_list<const FieldBase*> fields) {
    if (Context::current().several())
      store.share(
          [&](const FieldBase& f) { return std::find(fields.begin(), fields.end(), &f) != fields.end(); });
  }
  void sort_cells(FluidStore& fluid);
  /// How far from its place a wall particle sees fluid about its image, m; 0: none has one. By all ranks.
  double reach_of_images(const WallStore& walls) const;
  void migrate(WallStore& walls);  ///< with their images
  /// Copies of what other ranks have next to this one's.
  void make_ghosts_of(FluidStore& fluid);
  void make_ghosts_of(WallStore& walls);
  /// Whether ranks have become so unequal that they are to be divided anew.
  bool unbalanced(const FluidStore& fluid, const WallStore& walls) const;
  /// f(positions by which fluid is sorted), as they are or, `listed`, as they were when the lists were built;
  /// f takes a function that returns them for all that the store holds at that moment.
  template <class F>
  void with_places(FluidStore& fluid, bool listed, const F& f);
  /// Positions sheared back.
  Span<const Vec3d> lattice(const FluidStore& fluid, bool listed = false);
  /// Runs a pass over the pairs of fluid.
  template <class Pass>
  void run(const Pass& pass) {
    if constexpr (kSupportsShear<Pass>)
      if (shear_.acts())
        return fluid_fluid_.run_within(range() * shear_.stretch(),
                                       ShearedPass<Pass>{pass, Real(shear_.strain), Real(shear_.rate)});
    fluid_fluid_.run(pass);
  }
  /// And of fluid and walls.
  template <class Pass>
  void run_with_walls(const Pass& pass) {
    if constexpr (kSupportsShear<Pass>)
      if (shear_.acts()) return run(pass);
    fluid_fluid_.run_with(fluid_wall_, pass);
  }
  /// Of W over the fluid around, below which it is none, 1/m3.
  Real least_sum() const { return Real(1e-3 / parameters_.domain.cell_volume(parameters_.fluid.h_most())); }
  /// walls() by WallPass.
  template <class W, class Lengths = OneLength>
  void extrapolate(const W& w, const FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose,
                   const Real3& gravity, double drag_dt, bool moving, const Lengths& lengths = {}) {
    const WallPass<W, Lengths> pass{.w = w,
                                    .eos = eos_,
                                    .fluid = view(fluid),
                                    .drag_kick = fluid.drag_kick,
                                    .rate = Real(drag_dt > 0 ? 1 / drag_dt : 0),
                                    .x0 = walls.x0,
                                    .bodies = {walls.body, pose},
                                    .gravity = gravity,
                                    .least_sum = least_sum(),
                                    .v_rho = walls.v_rho,
                                    .no_slip = walls.no_slip,
                                    .state = walls.state,
                                    .compression = walls.compression,
                                    .lengths = lengths};
    run_over_walls(pass, moving);
    relisted_ = false;
  }
  /// Over the wall particles that have fluid around them; over all where dry ones ask for it, and since lists
  /// are new.
  template <class Pass>
  void run_over_walls(const Pass& pass, bool all = false) {
    if (all || relisted_)
      wall_fluid_.run(pass);
    else
      wall_fluid_.run_for(wet_walls_, pass);
  }
  /// Density of frozen walls over dt by continuity; no thinner than `least`.
  template <class W>
  void frozen_continuity(const W& w, const FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose,
                         double dt, Real least) {
    if (!parameters_.frozen) return;
    wall_fluid_.run(FrozenPass<W>{.w = w,
                                  .rho0 = Real(parameters_.fluid.rho0),
                                  .dt = Real(dt),
                                  .least = least,
                                  .fluid = view(fluid),
                                  .walls = view(walls),
                                  .bodies = {walls.body, pose},
                                  .compression = walls.compression});
  }
  double repulsion_cap(double dt) const;  ///< m/s2, in a step of dt, s

  FluidParameters parameters_;
  Frame frame_;
  double kappa_;
  std::unique_ptr<SmoothingLengths> lengths_;
  EquationOfState eos_;
  MeanShear shear_;
  double listed_strain_ = 0;  ///< where the lists were built
  Edges edges_;
  Scratch of_fluid_, of_walls_;  ///< what passes leave for others within a call
  ScratchArray<Vec3d> lattice_{of_fluid_, shear_.acts()};
  std::unique_ptr<Field<Real>> collisions_;  ///< number of each particle; null where they do not collide
  ScratchArray<VelocityDensity<>> collided_{of_fluid_, parameters_.visc.collision};
  double half_skin_ = 0, wall_skin_ = 0;  ///< the largest of fluid, that of walls, m
  double horizon_ = 0;                    ///< time for which fast particles get a skin, s
  CellGrid grid_, wall_grid_;
  const GrainStore* grains_ = nullptr;  ///< that are divided alike; null: none
  CellGrid* grain_cells_ = nullptr;
  double grain_range_ = 0;  ///< m
  double imbalance_ = 1;    ///< largest part of a rank over the mean, when they were last divided
#if BL_CUDA
  Pairing<TileList> fluid_fluid_;
#else
  Pairing<> fluid_fluid_;
#endif
  Pairing<> fluid_wall_, wall_fluid_, image_fluid_;
  Pairing<> wall_wall_;  ///< of frozen walls whose density is summed up
  Reading<FluidExtremes> extremes_;
  Buffer<Index> order_;
  Buffer<Index> beside_walls_;                       ///< fluid with wall particles around it
  Buffer<Index> wet_walls_;                          ///< wall particles with fluid around them
  bool relisted_ = true;                             ///< since walls() was last called
  SurfaceSet repelling_;                             ///< empty where no wall repels
  Buffer<Orifice> orifices_;                         ///< empty where none repels
  Buffer<LayerLaw> layers_;                          ///< one a body; empty without single layers
  std::vector<std::unique_ptr<Field<Real>>> rates_;  ///< of s, one_pass(): at the last three ends of steps
  double last_dt_ = 0, dt_before_ = 0;               ///< s, of the steps between them; 0: there was none
};

}  // namespace BL_SOLVER
