#include <cmath>

#include "kernels/fluid/density_pass.hpp"
#include "kernels/fluid/force_pass.hpp"
#include "kernels/fluid/one_pass.hpp"
#include "kernels/fluid/power_pass.hpp"
#include "kernels/fluid/wall_density.hpp"
#include "kernels/smoothing/registry.hpp"
#include "src/fluid/wcsph.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

/// The passes that know the kernel function, and whether particles have smoothing lengths of their own.
template <class W, class Lengths>
class WcsphSolver final : public FluidSolver {
 public:
  WcsphSolver(const FluidParameters& parameters, const Frame& frame, const WallGeometry& walls,
              FluidStore& fluid, const W& w)
      : FluidSolver(parameters, frame, walls, fluid, W::kappa), w_(w), cut_(CutFraction::of(w)) {}

  void walls(const FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose, const Real3& gravity,
             double drag_dt, bool moving) override {
    if (walls.mirrors.size() > 0) {
      const MirrorPass<W> mirror{w_,
                                 frame_,
                                 Real(parameters_.fluid.rho0),
                                 least(),
                                 least_sum(),
                                 flux(fluid),
                                 fluid.m_state,
                                 walls.x,
                                 walls.mirrors.x,
                                 walls.body,
                                 pose,
                                 walls.compression};
      image_fluid_.run(mirror);
    }
    extrapolate(w_, fluid, walls, pose, gravity, drag_dt, moving, lengths());
  }

  void forces(FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose, const Moment& now,
              double dt) override {
    if constexpr (Lengths::vary) {
      run_with_walls(OmegaPass<W>{w_, lengths(), Real(parameters_.fluid.h_least()),
                                  Real(parameters_.fluid.h_most()), Real(parameters_.fluid.rho0),
                                  fluid.m_state, walls.m_state, lengths_->omega, fluid.p_rho2});
      artificial().acts() ? momentum<true, false>(fluid, walls, now)
                          : momentum<false, false>(fluid, walls, now);
    } else {
      constant_length_forces(fluid, walls, now, dt);
    }
    if (layers_.size() > 0)
      fluid_wall_.run(
          LayerPass<W>{layer(pose, dt), flux(fluid), walls.v_rho, walls.body, fluid.theta, fluid.acc_next});
  }

  void wall_forces(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose, const Moment&,
                   double corrected, double dt, Buffer<Vec3d>& force) override {
    force.resize(walls.size());
    forces_on_walls<WholeForce>(fluid, walls, pose, corrected, dt, force, {});
  }
  void wall_forces(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose, const Moment&,
                   double corrected, double dt, Buffer<Vec3d>& pressure, Buffer<Vec3d>& friction) override {
    pressure.resize(walls.size());
    friction.resize(walls.size());
    forces_on_walls<ForceParts>(fluid, walls, pose, corrected, dt, pressure, friction);
  }

  void body_pressures(const FluidStore& fluid, const WallStore& walls, const BodyPressures& pressures,
                      Buffer<Vec4<double>>& force) override {
    force.resize(walls.size());
    wall_fluid_.run(BodyPressurePass<W>{w_, fluid.m_state, fluid.correction, walls.m_state, walls.x0,
                                        walls.body, pressures, force});
  }

  Span<const FluidPowers> powers(FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose,
                                 const Moment& now, double dt) override {
    if (shear_.acts()) return {};
    powers_.resize(fluid.size());
    if constexpr (!Lengths::vary)
      if (parameters_.viscosity_varies()) return spend<true>(fluid, walls, pose, now, dt);
    return spend<false>(fluid, walls, pose, now, dt);
  }

  void moments(FluidStore& fluid, const WallStore& walls, const Moment& now, double,
               FluidMoments& out) override {
    if (shear_.acts()) pack(fluid);  // velocities as they are now
    if constexpr (!Lengths::vary)
      if (parameters_.viscosity_varies()) return stress<true, true>(fluid, walls, now, out);
    parameters_.tensile > 0 ? stress<true>(fluid, walls, now, out) : stress<false>(fluid, walls, now, out);
  }

 private:
  void find_density(FluidStore& fluid, WallStore& walls, Span<const BodyPose> pose, const Moment& start,
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
  void constant_length_forces(FluidStore& fluid, const WallStore& walls, const Moment& now, double dt) {
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
    const WallForcePass<W, Force, Lengths> pass{w_,
                                                WallPair{viscosity(), parameters_.suction},
                                                layer(pose, dt),
                                                Real(parameters_.mixed ? 0 : corrected),
                                                fluid.acc,
                                                fluid.acc_next,
                                                flux(fluid),
                                                fluid.m_state,
                                                walls.v_rho,
                                                walls.m_state,
                                                walls.v_visc,
                                                walls.body,
                                                force,
                                                friction,
                                                fluid.viscosity,
                                                lengths()};
    wall_fluid_.run(pass);
  }
  /// What the pressure of walls does by places and velocities as they are, for density_pass().
  void find_wall_work(const FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose) {
    if (!parameters_.energy_consistent) return;
    wall_work_.resize(walls.size());
    const WallWorkPass<W, Lengths> pass{w_,         least_sum(), flux(fluid), walls.v_rho, walls.m_state,
                                        walls.body, pose,        wall_work_,  lengths()};
    run_over_walls(pass);
  }
  Real least() const { return -Real(parameters_.density.cavitation_limit); }
  Viscosity viscosity() const {
    return Viscosity::of(parameters_.visc.model, parameters_.fluid.mu, parameters_.fluid.rho0,
                         parameters_.fluid.c, w_);
  }
  ArtificialViscosity artificial() const {
    return {Real(parameters_.visc.alpha), Real(parameters_.visc.beta), Real(parameters_.fluid.c),
            Real(parameters_.fluid.h())};
  }
  /// Writes s_new.
  template <bool kSmooth, bool kPorous, class Shift, class Fit>
  DensityPass<W, Shift, Fit, kSmooth, kPorous, Lengths> density_pass(FluidStore& fluid,
                                                                     const WallStore& walls,
                                                                     const Real3& gravity, double dt,
                                                                     const Shift& shift, const Fit& fit,
                                                                     Span<Real> s_new) {
    const double c = parameters_.fluid.c;
    return {w_,
            flux(fluid),
            fluid.m_state,
            walls.v_rho,
            walls.m_state,
            Real(2 * parameters_.density.delta * parameters_.fluid.h() * c),
            gravity * Real(parameters_.fluid.rho0 / (c * c)),
            eos_.gamma - 2,
            Real(parameters_.fluid.rho0),
            Real(dt),
            fluid.s,
            s_new,
            cut_,
            least(),
            Real(parameters_.density.void_relaxation * c / parameters_.fluid.h()),
            Real(parameters_.spreading * c / parameters_.fluid.h()),
            fluid.compression_rate,
            shift,
            drift_of(fluid),
            fit,
            lengths(),
            parameters_.energy_consistent ? Span<const Real>(wall_work_) : Span<const Real>()};
  }
  template <bool kArtificial, bool kAdded, bool kSpecies = false>
  ForcePass<W, kArtificial, kAdded, kSpecies, Lengths> force_pass(FluidStore& fluid, const WallStore& walls,
                                                                  const Moment& now) {
    return {w_,
            WallPair{viscosity(), parameters_.suction},
            flux(fluid),
            fluid.m_state,
            fluid.p_rho2,
            walls.v_rho,
            walls.m_state,
            walls.v_visc,
            artificial(),
            tensile(),
            Real(parameters_.xsph),
            now.gravity,
            drive(fluid, now),
            fluid.theta,
            fluid.acc_next,
            fluid.drift,
            fluid.viscosity,
            fluid.correction,
            lengths()};
  }
  template <bool kSmooth, bool kPorous, class Shift, class Fit>
  void continuity(FluidStore& fluid, const WallStore& walls, const Real3& gravity, double dt,
                  const Shift& shift, const Fit& fit) {
    run_with_walls(density_pass<kSmooth, kPorous>(fluid, walls, gravity, dt, shift, fit, fluid.s_next));
  }
  template <bool kArtificial, bool kAdded, bool kSpecies = false>
  void momentum(FluidStore& fluid, const WallStore& walls, const Moment& now) {
    run_with_walls(force_pass<kArtificial, kAdded, kSpecies>(fluid, walls, now));
  }
  template <bool kTensile, bool kSpecies = false>
  void stress(FluidStore& fluid, const WallStore& walls, const Moment& now, FluidMoments& out) {
    using Force = ForcePass<W, true, kTensile, kSpecies, Lengths>;
    const Force whole = force_pass<true, kTensile, kSpecies>(fluid, walls, now);
    Force inviscid = whole;
    inviscid.artificial = {};
    inviscid.wall.viscosity.mu = 0;
    run_with_walls(StressPass<Force>{whole, inviscid, out.parts(fluid.size(), false)});
  }
  template <bool kSpecies>
  Span<const FluidPowers> spend(FluidStore& fluid, const WallStore& walls, Span<const BodyPose> pose,
                                const Moment& now, double dt) {
    using Force = ForcePass<W, true, false, kSpecies, Lengths>;
    using Density = DensityPass<W, NoShifting, NoFit, true, true, Lengths>;
    find_wall_work(fluid, walls, pose);
    Force friction = force_pass<true, false, kSpecies>(fluid, walls, now), artificial = friction;
    friction.artificial = {};
    artificial.wall.viscosity.mu = 0;
    Density density =
        density_pass<true, true>(fluid, walls, now.gravity, dt, NoShifting{}, NoFit{}, fluid.s_next);
    density.compression = {};
    run_with_walls(PowerPass<Force, Density>{friction, artificial, density, eos_, fluid.theta, powers_});
    return powers_;
  }
  template <bool kSmooth, class Shift, class Fit>
  void momentum_and_continuity(FluidStore& fluid, const WallStore& walls, const Moment& now, double dt,
                               const Shift& shift, const Fit& fit) {
    const auto both = [&](const auto& force) {
      const auto density = density_pass<kSmooth, false>(fluid, walls, now.gravity, dt, shift, fit, fluid.s);
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
    return {Real(parameters_.shift * h * h),        Real(0.5 * h * h * rate), Real(fastest_shift(dt)),
            Real(parameters_.domain.two_d ? 1 : 0), fluid.exposure,           fluid.exposure_next};
  }
  LinearFit linear_fit(FluidStore& fluid) const {
    const FluidProperties& f = parameters_.fluid;
    const auto log_of_square = [](double x) { return Real(2 * std::log10(x)); };
    return {w_.F(Real(f.h())),
            Real(parameters_.domain.cell_volume(f.dx)),
            w_.F(Real(0)),
            Real(f.rho0 * square(f.dx / f.mu)),
            log_of_square(kExactPressure),
            log_of_square(kExactPressureAtSurface),
            log_of_square(kExactPressureEnds),
            fluid.viscosity,
            fluid.correction};
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
  Buffer<Real> wall_work_;  ///< of WallWorkPass, one a wall particle
};

}  // namespace

std::unique_ptr<FluidSolver> Wcsph::make(const FluidParameters& parameters, const Frame& frame,
                                         const WallGeometry& walls, FluidStore& fluid) {
  std::unique_ptr<FluidSolver> solver;
  with_fluid_kernel(parameters.fluid, parameters.domain, [&](const auto& w) {
    using W = std::decay_t<decltype(w)>;
    if (parameters.fluid.variable_h)
      solver = std::make_unique<WcsphSolver<W, OwnLengths>>(parameters, frame, walls, fluid, w);
    else
      solver = std::make_unique<WcsphSolver<W, OneLength>>(parameters, frame, walls, fluid, w);
  });
  return solver;
}

}  // namespace bedload::inline BL_VARIANT
