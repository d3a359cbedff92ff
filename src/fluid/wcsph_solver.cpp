#include <cmath>

#include "bedload/core/first_look.hpp"
#include "kernels/fluid/body_pressure.hpp"
#include "kernels/fluid/density_pass.hpp"
#include "kernels/fluid/force_pass.hpp"
#include "kernels/fluid/one_pass.hpp"
#include "kernels/fluid/power_pass.hpp"
#include "kernels/fluid/wall_density.hpp"
#include "kernels/smoothing/registry.hpp"
#include "src/fluid/wcsph.hpp"

namespace BL_SOLVER {
namespace {

/// The passes that know the kernel function, and whether smoothing lengths are variable.
template <class W, class Lengths>
class WcsphSolver final : public FluidSolver {
 public:
  WcsphSolver(const FluidParameters& parameters, const Frame& frame, const WallGeometry& walls,
              FluidStore& fluid, const W& w)
      : FluidSolver(parameters, frame, walls, fluid, W::kappa), w_(w), cut_(CutFraction::of(w)) {}

  void walls(const FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose, const Real3& gravity,
             double drag_dt, bool moving) override {
    if (walls.mirrors.size() > 0) {
      const MirrorPass<W> mirror{.w = w_,
                                 .frame = frame_,
                                 .rho0 = Real(parameters_.fluid.rho0),
                                 .least = least(),
                                 .least_sum = least_sum(),
                                 .fluid = view(fluid),
                                 .x = walls.x,
                                 .image = walls.mirrors.x,
                                 .bodies = {walls.body, pose},
                                 .compression = walls.compression};
      image_fluid_.run(mirror);
    }
    extrapolate(w_, fluid, walls, pose, gravity, drag_dt, moving, lengths());
  }

  void forces(FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose, const StepTime& now,
              double dt) override {
    if constexpr (Lengths::vary) {
      run_with_walls(OmegaPass<W>{.w = w_,
                                  .lengths = lengths(),
                                  .least = Real(parameters_.fluid.h_least()),
                                  .most = Real(parameters_.fluid.h_most()),
                                  .rho0 = Real(parameters_.fluid.rho0),
                                  .eos_state = fluid.eos_state,
                                  .wall_state = walls.state,
                                  .omega = lengths_->omega,
                                  .p_rho2 = fluid.p_rho2});
      share(fluid, {&lengths_->omega, &fluid.p_rho2});
      artificial().acts() ? momentum<true, false>(fluid, walls, now)
                          : momentum<false, false>(fluid, walls, now);
    } else {
      constant_length_forces(fluid, walls, now, dt);
    }
    if (layers_.size() > 0)
      fluid_wall_.run(LayerPass<W>{.layer = layer(pose, dt),
                                   .flux = flux(fluid),
                                   .wall_v_rho = walls.v_rho,
                                   .wall_body = walls.body,
                                   .out = {fluid.stress_acceleration, fluid.acc_next}});
  }

  void wall_forces(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose,
                   const StepTime&, double corrected, double dt, Buffer<Vec3d>& force) override {
    force.resize(walls.size());
    forces_on_walls<WholeForce>(fluid, walls, pose, corrected, dt, force, {});
  }
  void wall_forces(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose,
                   const StepTime&, double corrected, double dt, Buffer<Vec3d>& pressure,
                   Buffer<Vec3d>& friction) override {
    pressure.resize(walls.size());
    friction.resize(walls.size());
    forces_on_walls<ForceParts>(fluid, walls, pose, corrected, dt, pressure, friction);
  }

  Span<const FluidPowers> powers(FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose,
                                 const StepTime& now, double dt) override {
    if (shear_.acts()) return {};
    powers_.resize(fluid.size());
    if constexpr (!Lengths::vary) {
      const bool varies = parameters_.viscosity_varies();
      if (shifts() && varies) return spend<true>(fluid, walls, pose, now, dt, shifting(fluid, dt));
      if (shifts()) return spend<false>(fluid, walls, pose, now, dt, shifting(fluid, dt));
      if (varies) return spend<true>(fluid, walls, pose, now, dt, NoShifting{});
    }
    return spend<false>(fluid, walls, pose, now, dt, NoShifting{});
  }

  void moments(FluidStore& fluid, const WallStore& walls, const StepTime& now, double,
               FluidMoments& out) override {
    if (shear_.acts()) pack(fluid);  // velocities as they are now
    if constexpr (!Lengths::vary)
      if (parameters_.viscosity_varies()) return stress<true, true>(fluid, walls, now, out);
    parameters_.tensile > 0 ? stress<true>(fluid, walls, now, out) : stress<false>(fluid, walls, now, out);
  }

 private:
  void body_pressures(const FluidStore& fluid, const WallStore& walls,
                      const BodyPressures& pressures) override {
    wall_fluid_.run(BodyPressurePass<W>{.w = w_,
                                        .eos_state = fluid.eos_state,
                                        .correction = fluid.correction,
                                        .wall_state = walls.state,
                                        .x0 = walls.x0,
                                        .body = walls.body,
                                        .pressures = pressures});
  }
  void find_density(FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose, const StepTime& start,
                    double dt) override {
    const AtMidStep places(fluid, walls);
    const Real3& gravity = start.gravity;
    find_wall_work(fluid, walls, pose);
    if (!smooths() && !shifts())
      continuity<false, false>(fluid, walls, gravity, dt, NoShifting{}, NoFit{});
    else
      with_order(fluid, dt, [&](const auto& shift, const auto& fit) {
        parameters_.mixed ? continuity<true, true>(fluid, walls, gravity, dt, shift, fit)
                          : continuity<true, false>(fluid, walls, gravity, dt, shift, fit);
      });
    frozen_continuity(w_, fluid, walls, pose, dt, least());
  }
  Lengths lengths() const {
    if constexpr (Lengths::vary)
      return {lengths_->h, lengths_->omega, Real(parameters_.fluid.h()), parameters_.domain.two_d};
    else
      return {};
  }
  void constant_length_forces(FluidStore& fluid, const WallStore& walls, const StepTime& now, double dt) {
    const bool added = parameters_.tensile > 0 || parameters_.xsph > 0;
    if (one_pass())
      smooths() || shifts() ? with_order(fluid, dt,
                                         [&](const auto& shift, const auto& fit) {
                                           momentum_and_continuity<true>(fluid, walls, now, dt, shift, fit);
                                         })
                            : momentum_and_continuity<false>(fluid, walls, now, dt, NoShifting{}, NoFit{});
    else if (parameters_.viscosity_varies())
      momentum<true, true, true>(fluid, walls, now);
    else if (artificial().acts())
      added ? momentum<true, true>(fluid, walls, now) : momentum<true, false>(fluid, walls, now);
    else
      added ? momentum<false, true>(fluid, walls, now) : momentum<false, false>(fluid, walls, now);
  }
  template <class Force>
  void forces_on_walls(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose,
                       double corrected, double dt, Span<Vec3d> force, Span<Vec3d> friction) {
    const WallForcePass<W, Force, Lengths> pass{.w = w_,
                                                .wall = wall_pair(),
                                                .layer = layer(pose, dt),
                                                .before = before_correction(fluid, corrected),
                                                .fluid = view(fluid),
                                                .walls = view(walls),
                                                .wall_body = walls.body,
                                                .force = force,
                                                .friction = friction,
                                                .relative_viscosity = fluid.viscosity,
                                                .lengths = lengths()};
    wall_fluid_.run(pass);
  }
  /// What the pressure of walls does by places and velocities as they are, for density_pass().
  void find_wall_work(const FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose) {
    if (!parameters_.energy_consistent) return;
    const WallWorkPass<W, Lengths> pass{.w = w_,
                                        .least_sum = least_sum(),
                                        .fluid = view(fluid),
                                        .walls = view(walls),
                                        .bodies = {walls.body, pose},
                                        .work = walls.work,
                                        .lengths = lengths()};
    run_over_walls(pass);
    if (!Context::current().several()) return;
    walls.work.set_shared(false);
    share(walls, {&walls.work});
  }
  Real least() const { return -Real(parameters_.density.cavitation_limit); }
  Viscosity viscosity() const {
    return Viscosity::of(parameters_.visc.model, parameters_.fluid.mu, parameters_.fluid.rho0,
                         parameters_.fluid.c, w_);
  }
  WallPair wall_pair() const { return {viscosity(), parameters_.suction}; }
  ArtificialViscosity artificial() const {
    return {Real(parameters_.visc.alpha), Real(parameters_.visc.beta), Real(parameters_.fluid.c),
            Real(parameters_.fluid.h())};
  }
  /// Writes compression_new.
  template <bool kSmooth, bool kPorous, class Shift, class Fit>
  DensityPass<W, Shift, Fit, kSmooth, kPorous, Lengths> density_pass(FluidStore& fluid,
                                                                     const WallStore& walls,
                                                                     const Real3& gravity, double dt,
                                                                     const Shift& shift, const Fit& fit,
                                                                     Span<Real> compression_new) {
    const double c = parameters_.fluid.c;
    return {.w = w_,
            .fluid = view(fluid),
            .walls = view(walls),
            .diffusion = Real(2 * parameters_.density.delta * parameters_.fluid.h() * c),
            .hydrostatic = gravity * Real(parameters_.fluid.rho0 / (c * c)),
            .stiffening = eos_.gamma - 2,
            .rho0 = Real(parameters_.fluid.rho0),
            .dt = Real(dt),
            .compression = fluid.compression,
            .compression_new = compression_new,
            .cut = cut_,
            .least = least(),
            .fading = Real(parameters_.density.void_relaxation * c / parameters_.fluid.h()),
            .spreading = Real(parameters_.spreading * c / parameters_.fluid.h()),
            .compression_rate = fluid.compression_rate,
            .shift = shift,
            .drift = drift_of(fluid),
            .fit = fit,
            .lengths = lengths(),
            .wall_work = span_if(parameters_.energy_consistent, walls.work)};
  }
  template <bool kArtificial, bool kAdded, bool kSpecies = false>
  ForcePass<W, kArtificial, kAdded, kSpecies, Lengths> force_pass(FluidStore& fluid, const WallStore& walls,
                                                                  const StepTime& now) {
    return {.w = w_,
            .wall = wall_pair(),
            .fluid = view(fluid),
            .p_rho2 = fluid.p_rho2,
            .walls = view(walls),
            .artificial = artificial(),
            .tensile = tensile(),
            .xsph_factor = Real(parameters_.xsph),
            .gravity = now.gravity,
            .drive = drive(fluid, now),
            .out = {fluid.stress_acceleration, fluid.acc_next},
            .drift = fluid.drift,
            .relative_viscosity = fluid.viscosity,
            .correction = fluid.correction,
            .lengths = lengths()};
  }
  template <bool kSmooth, bool kPorous, class Shift, class Fit>
  void continuity(FluidStore& fluid, const WallStore& walls, const Real3& gravity, double dt,
                  const Shift& shift, const Fit& fit) {
    run_with_walls(
        density_pass<kSmooth, kPorous>(fluid, walls, gravity, dt, shift, fit, fluid.compression_next));
  }
  template <bool kArtificial, bool kAdded, bool kSpecies = false>
  void momentum(FluidStore& fluid, const WallStore& walls, const StepTime& now) {
    run_with_walls(force_pass<kArtificial, kAdded, kSpecies>(fluid, walls, now));
  }
  template <bool kTensile, bool kSpecies = false>
  void stress(FluidStore& fluid, const WallStore& walls, const StepTime& now, FluidMoments& out) {
    using Force = ForcePass<W, true, kTensile, kSpecies, Lengths>;
    const Force whole = force_pass<true, kTensile, kSpecies>(fluid, walls, now);
    Force inviscid = whole;
    inviscid.artificial = {};
    inviscid.wall.viscosity.mu = 0;
    run_with_walls(StressPass<Force>{whole, inviscid, out.parts(fluid.size(), false)});
  }
  template <bool kSpecies, class Shift>
  Span<const FluidPowers> spend(FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose,
                                const StepTime& now, double dt, const Shift& shift) {
    using Force = ForcePass<W, true, false, kSpecies, Lengths>;
    using Density = DensityPass<W, Shift, NoFit, true, true, Lengths>;
    find_wall_work(fluid, walls, pose);
    Force friction = force_pass<true, false, kSpecies>(fluid, walls, now), artificial = friction;
    friction.artificial = {};
    artificial.wall.viscosity.mu = 0;
    Density density =
        density_pass<true, true>(fluid, walls, now.gravity, dt, shift, NoFit{}, fluid.compression_next);
    density.compression_rate = {};
    run_with_walls(PowerPass<Force, Density>{.friction = friction,
                                             .artificial = artificial,
                                             .density = density,
                                             .eos = eos_,
                                             .stress_acceleration = fluid.stress_acceleration,
                                             .out = powers_});
    return powers_;
  }
  template <bool kSmooth, class Shift, class Fit>
  void momentum_and_continuity(FluidStore& fluid, const WallStore& walls, const StepTime& now, double dt,
                               const Shift& shift, const Fit& fit) {
    const auto both = [&](const auto& force) {
      const auto density =
          density_pass<kSmooth, false>(fluid, walls, now.gravity, dt, shift, fit, fluid.compression);
      run_with_walls(OnePass<std::decay_t<decltype(force)>, std::decay_t<decltype(density)>>{force, density,
                                                                                             *rates_.back()});
    };
    artificial().acts() ? both(force_pass<true, false>(fluid, walls, now))
                        : both(force_pass<false, false>(fluid, walls, now));
    accept_rates(dt);
    if constexpr (Shift::acts) fluid.exposure.buffer().swap(fluid.exposure_next.buffer());
  }
  /// Calls pass(shift, fit) with what keeps particles in order over a step dt (s), and what is done about the
  /// force of the pressure where they are not.
  template <class Pass>
  void with_order(FluidStore& fluid, double dt, const Pass& pass) {
    if constexpr (!Lengths::vary) {
      if (fits()) return pass(shifting(fluid, dt), linear_fit(fluid));
      if (shifts()) return pass(shifting(fluid, dt), NoFit{});
    }
    pass(NoShifting{}, NoFit{});
  }
  Shifting shifting(FluidStore& fluid, double dt) const {
    const double h = parameters_.fluid.h(), rate = dt > 0 ? 1 / dt : 0;
    return {.area = Real(parameters_.shift * h * h),
            .stiffest = Real(0.5 * h * h * rate),
            .fastest = Real(fastest_shift(dt)),
            .plane = Real(parameters_.domain.two_d ? 1 : 0),
            .exposure = fluid.exposure,
            .exposure_new = fluid.exposure_next};
  }
  LinearFit linear_fit(FluidStore& fluid) const {
    const FluidProperties& f = parameters_.fluid;
    const auto log_of_square = [](double x) { return Real(2 * std::log10(x)); };
    return {.at_h = w_.F(Real(f.h())),
            .volume = Real(parameters_.domain.cell_volume(f.dx)),
            .at_zero = w_.F(Real(0)),
            .cell = Real(f.rho0 * square(f.dx / f.mu)),
            .whole_within = log_of_square(kExactPressure),
            .whole_at_surface = log_of_square(kExactPressureAtSurface),
            .fading = log_of_square(kExactPressureEnds),
            .viscosity = fluid.viscosity,
            .correction = fluid.correction};
  }
  TensileTerm tensile() const {
    if (parameters_.tensile == 0) return {};
    const Real s = Real(0.01);
    return {s, parameters_.tensile_one_sign ? s : Real(0.2), w_.W(Real(parameters_.fluid.dx))};
  }
  LayerForces<W> layer(Span<const BodyPose> pose, double dt) const {
    return {w_, artificial(), layers_, Real(repulsion_cap(dt)), pose};
  }

  W w_;
  CutFraction cut_;
  Buffer<FluidPowers> powers_;
};

}  // namespace

std::unique_ptr<FluidSolver> Wcsph::make(const FluidParameters& parameters, const Frame& frame,
                                         const WallGeometry& walls, FluidStore& fluid) {
  std::unique_ptr<FluidSolver> solver;
  with_fluid_kernel(parameters.fluid, parameters.domain, [&](const auto& w) {
    using W = std::decay_t<decltype(w)>;
    if (!parameters.fluid.variable_h)
      solver = std::make_unique<WcsphSolver<W, OneLength>>(parameters, frame, walls, fluid, w);
    else if constexpr (kFirstLook)
      not_in_first_look("fluid.variable_h", "smoothing lengths of one size alone");
    else
      solver = std::make_unique<WcsphSolver<W, OwnLengths>>(parameters, frame, walls, fluid, w);
  });
  return solver;
}

}  // namespace BL_SOLVER
