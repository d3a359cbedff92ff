// SDPD: density, forces and spin; what it shares with WCSPH is in FluidSolver.

#include <cmath>

#include "kernels/sdpd/force_pass.hpp"
#include "kernels/sdpd/kernel_sums.hpp"
#include "kernels/smoothing/registry.hpp"
#include "src/fluid/sdpd.hpp"

namespace BL_SOLVER {
namespace {

/// Sums over a lattice of spacing dx around one of its points: volume times W, itself included; volume times
/// F; a third of volume times F r2, which is 1 of fluid without grain.
struct LatticeSums {
  double W = 0, F = 0, Fr2 = 0;  ///< -, 1/m2, -
  template <class Kernel>
  LatticeSums(const Kernel& w, double dx, double range) {
    const int n = int(range / dx) + 1;
    for (int i = -n; i <= n; ++i)
      for (int j = -n; j <= n; ++j)
        for (int k = -n; k <= n; ++k) {
          const double r = dx * std::sqrt(double(i * i + j * j + k * k));
          W += double(w.W(Real(r))) * dx * dx * dx;
          if (r == 0) continue;
          const double VF = double(w.F(Real(r))) * dx * dx * dx;
          F += VF;
          Fr2 += VF * r * r / 3;
        }
  }
};

/// Without the terms that smooth WCSPH: thermal noise would trigger them.
FluidParameters without_safety_terms(FluidParameters p) {
  p.xsph = p.tensile = 0;
  p.density.delta = p.density.void_relaxation = 0;
  p.density.cavitation_limit = 1;
  p.time.integrator = TimeIntegrator::kdk;
  return p;
}

template <class W, class Model>
class SdpdSolver final : public FluidSolver {
 public:
  SdpdSolver(const FluidParameters& parameters, const Frame& frame, const WallGeometry& walls,
             FluidStore& fluid, const W& w)
      : FluidSolver(without_safety_terms(parameters), frame, walls, fluid, W::kappa),
        w_(w),
        lattice_(w, parameters.fluid.dx, range()),
        friction_(
            Model::coefficients(parameters.fluid.mu, bulk_viscosity(parameters.fluid)).over(lattice_.Fr2)),
        label_(fluid, "spin_label", "rad/s, -", Lifetime::derived) {
    if (Model::spins) spin_ = std::make_unique<Spin>(fluid, parameters.sdpd.kI * square(parameters.fluid.dx));
  }

  /// The shortest time in which friction stops a particle or its spin, times time.friction.
  StepLimit friction_limit(const FluidExtremes& now) const override {
    const double rho = parameters_.fluid.rho0;
    double rate = std::max(friction_.across, friction_.along) * lattice_.F / rho;
    if (Model::spins) rate = std::max(rate, friction_.across / (rho * spin_->inertia));
    return {Limit::friction, parameters_.time.friction / (rate * now.thickest)};  // without friction infinite
  }
  Spin* spin() override { return spin_.get(); }
  std::vector<const FieldBase*> fields_of_forces() const override {
    if (!spin_) return {&label_};
    return {&label_, &spin_->omega, &spin_->acc};
  }

  void walls(const FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose, const Real3& gravity,
             double drag_dt, bool moving) override {
    extrapolate(w_, fluid, walls, pose, gravity, drag_dt, moving);
  }

  void forces(FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose, const StepTime& now,
              double dt) override {
    if (parameters_.eos.filter) filter_pressure(fluid);
    for_each(fluid.all(), PredictSpin{Real(dt), omega(), turning(), fluid.id, label_});
    of_walls_.resize(walls.size());
    for_each(walls.all(), LabelWalls{Model::spins, walls.id, {walls.body, pose}, wall_label_});
    const bool noisy = parameters_.sdpd.kT > 0 && dt > 0;
    if (!parameters_.viscosity_varies())
      noisy ? momentum<true, false>(fluid, walls, now, dt) : momentum<false, false>(fluid, walls, now, dt);
    else
      noisy ? momentum<true, true>(fluid, walls, now, dt) : momentum<false, true>(fluid, walls, now, dt);
  }

  void wall_forces(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose>, const StepTime& now,
                   double corrected, double dt, Buffer<Vec3d>& force) override {
    force.resize(walls.size());
    forces_on_walls<WholeForce>(fluid, walls, now, corrected, dt, force, {});
  }
  void wall_forces(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose>, const StepTime& now,
                   double corrected, double dt, Buffer<Vec3d>& pressure, Buffer<Vec3d>& friction) override {
    pressure.resize(walls.size());
    friction.resize(walls.size());
    forces_on_walls<ForceParts>(fluid, walls, now, corrected, dt, pressure, friction);
  }

  void moments(FluidStore& fluid, const WallStore& walls, const StepTime& now, double dt,
               FluidMoments& out) override {
    const bool noisy = parameters_.sdpd.kT > 0 && dt > 0;
    if (!parameters_.viscosity_varies())
      noisy ? stress<true, false>(fluid, walls, now, dt, out)
            : stress<false, false>(fluid, walls, now, dt, out);
    else
      noisy ? stress<true, true>(fluid, walls, now, dt, out)
            : stress<false, true>(fluid, walls, now, dt, out);
  }

 private:
  void find_density(FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose, const StepTime& start,
                    double dt) override {
    const DensityConfig& d = parameters_.density;
    if (d.method == DensityMethod::summation) {
      d.count_grains&& parameters_.mixed ? sum_up<true>(fluid, walls) : sum_up<false>(fluid, walls);
      if (sums_up_frozen()) sum_up_frozen(fluid, walls, pose);
      return;
    }
    continuity(fluid, walls, pose, dt);
    if (d.reinit_every > 0 && (start.step + 1) % std::uint64_t(d.reinit_every) == 0) reinitialise(fluid);
  }
  void continuity(FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose, double dt) {
    const AtMidStep places(fluid, walls);
    frozen_continuity(w_, fluid, walls, pose, dt, Real(-0.5));
    run_with_walls(ContinuityPass<W>{.w = w_,
                                     .rho0 = Real(parameters_.fluid.rho0),
                                     .dt = Real(dt),
                                     .fluid = view(fluid),
                                     .walls = view(walls),
                                     .compression = fluid.compression,
                                     .compression_next = fluid.compression_next});
  }
  static double bulk_viscosity(const FluidProperties& f) {
    return std::isfinite(f.zeta) ? f.zeta : 20.0 / 21 * f.mu;
  }
  Span<Real3> omega() { return spin_ ? Span<Real3>(spin_->omega) : Span<Real3>(); }
  Span<Real3> turning() { return spin_ ? Span<Real3>(spin_->acc) : Span<Real3>(); }
  template <bool kGrains>
  void sum_up(FluidStore& fluid, const WallStore& walls) {
    run_with_walls(SummationPass<W, kGrains>{.w = w_,
                                             .rho0 = Real(parameters_.fluid.rho0),
                                             .n = Real(1 / lattice_.W),
                                             .eos_state = fluid.eos_state,
                                             .wall_state = walls.state,
                                             .eps = fluid.eps,
                                             .grains = fluid.grains_around,
                                             .compression = fluid.compression_next});
  }
  bool sums_up_frozen() const {
    return parameters_.frozen && parameters_.density.method == DensityMethod::summation;
  }
  void sum_up_frozen(const FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose) {
    of_walls_.resize(walls.size());
    for_each(walls.all(), WallVolume{{walls.body, pose}, wall_volume_});
    wall_wall_.run_with(wall_fluid_, FrozenSummationPass<W>{.w = w_,
                                                            .rho0 = Real(parameters_.fluid.rho0),
                                                            .n = Real(1 / lattice_.W),
                                                            .volume = wall_volume_,
                                                            .eos_state = fluid.eos_state,
                                                            .bodies = {walls.body, pose},
                                                            .compression = walls.compression});
  }
  SdpdWallPair<W> pair(const StepTime& now, double dt) const {
    const SdpdConfig& s = parameters_.sdpd;
    PairLaw law;
    law.across = Real(friction_.across), law.along = Real(friction_.along);
    law.sliding = Real(s.force_scale[1]), law.spinning = Real(s.force_scale[2]);
    law.thermal = dt > 0 ? Real(2 * s.kT / dt * square(s.force_scale[3])) : Real(0);
    law.tensor = s.noise == NoiseForm::tensor;
    law.key = {parameters_.seed, now.step};
    law.guard = Real(1e-12 * square(parameters_.fluid.h()));
    return {w_, law, Real(s.force_scale[0]), law.thermal > 0};
  }
  template <bool kNoise, bool kSpecies>
  using Force = SdpdForcePass<W, Model::spins, kNoise, kSpecies>;
  template <bool kNoise, bool kSpecies>
  Force<kNoise, kSpecies> force_pass(FluidStore& fluid, const WallStore& walls, const StepTime& now,
                                     double dt) {
    return {.wall = pair(now, dt),
            .fluid = view(fluid),
            .spin_label = label_,
            .p_rho2 = fluid.p_rho2,
            .mass = fluid.mass,
            .id = fluid.id,
            .walls = view(walls),
            .wall_label = wall_label_,
            .gravity = now.gravity,
            .drive = drive(fluid, now),
            .dt = Real(dt),
            .inertia = Real(spin_ ? spin_->inertia : 0),
            .out = {fluid.stress_acceleration, fluid.acc_next},
            .spin = omega(),
            .spin_acc = turning(),
            .viscosity = fluid.viscosity};
  }
  template <bool kNoise, bool kSpecies>
  void momentum(FluidStore& fluid, const WallStore& walls, const StepTime& now, double dt) {
    run_with_walls(force_pass<kNoise, kSpecies>(fluid, walls, now, dt));
  }
  template <bool kNoise, bool kSpecies>
  void stress(FluidStore& fluid, const WallStore& walls, const StepTime& now, double dt, FluidMoments& out) {
    if (shear_.acts()) pack(fluid);  // velocities as they are now
    run_with_walls(SdpdStressPass<Force<kNoise, kSpecies>, kNoise>{
        force_pass<kNoise, kSpecies>(fluid, walls, now, dt), out.parts(fluid.size(), kNoise)});
  }
  template <class Force>
  void forces_on_walls(const FluidStore& fluid, const WallStore& walls, const StepTime& now, double corrected,
                       double dt, Span<Vec3d> force, Span<Vec3d> friction) {
    const SdpdWallForcePass<W, Force> pass{.wall = pair(now, dt),
                                           .before = before_correction(fluid, corrected),
                                           .fluid = view(fluid),
                                           .spin_label = label_,
                                           .walls = view(walls),
                                           .wall_label = wall_label_,
                                           .force = force,
                                           .friction = friction,
                                           .viscosity = fluid.viscosity};
    wall_fluid_.run(pass);
  }
  /// Shepard's mean of q over the fluid; densities are rho0 (1 + s).
  void average(const FluidStore& fluid, Span<const Real> s, Span<const Real> q, Span<Real> mean) {
    run(ShepardPass<W>{.w = w_,
                       .rho0 = Real(parameters_.fluid.rho0),
                       .eos_state = fluid.eos_state,
                       .compression = s,
                       .q = q,
                       .mean = mean});
  }
  /// Of a density, the mean is sum M W / sum V W.
  void reinitialise(FluidStore& fluid) {
    share(fluid, {&fluid.compression_next});
    average(fluid, fluid.compression_next, fluid.compression_next, fluid.compression);
    fluid.compression.buffer().swap(fluid.compression_next.buffer());
  }
  void filter_pressure(FluidStore& fluid) {
    of_fluid_.resize(fluid.size());
    for_each(fluid.all(), PressureOf{fluid.eos_state, pressure_});
    average(fluid, fluid.compression, pressure_, filtered_);
    for_each(fluid.owned(), SetPressure{filtered_, fluid.eos_state, fluid.p_rho2});
    share(fluid, {&fluid.eos_state, &fluid.p_rho2});
  }

  W w_;
  LatticeSums lattice_;
  FrictionCoefficients friction_;
  Field<Real4> label_;  ///< spin at the end of the step as predicted; id as pair loops carry it
  std::unique_ptr<Spin> spin_;
  ScratchArray<Real4> wall_label_{of_walls_};
  ScratchArray<Real> wall_volume_{of_walls_, sums_up_frozen()};
  ScratchArray<Real> pressure_{of_fluid_, parameters_.eos.filter},
      filtered_{of_fluid_, parameters_.eos.filter};
};

template <class Model>
std::unique_ptr<FluidSolver> make_sdpd(const FluidParameters& parameters, const Frame& frame,
                                       const WallGeometry& walls, FluidStore& fluid) {
  std::unique_ptr<FluidSolver> solver;
  with_fluid_kernel(parameters.fluid, parameters.domain, [&](const auto& w) {
    solver =
        std::make_unique<SdpdSolver<std::decay_t<decltype(w)>, Model>>(parameters, frame, walls, fluid, w);
  });
  return solver;
}

}  // namespace

std::unique_ptr<FluidSolver> Sdpd::make(const FluidParameters& parameters, const Frame& frame,
                                        const WallGeometry& walls, FluidStore& fluid) {
  return make_sdpd<Sdpd>(parameters, frame, walls, fluid);
}
std::unique_ptr<FluidSolver> SpinningSdpd::make(const FluidParameters& parameters, const Frame& frame,
                                                const WallGeometry& walls, FluidStore& fluid) {
  return make_sdpd<SpinningSdpd>(parameters, frame, walls, fluid);
}

}  // namespace BL_SOLVER
