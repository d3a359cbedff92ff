#include "src/fluid/fluid_solver.hpp"

#include <algorithm>
#include <cmath>

#include "bedload/parallel/reductions.hpp"
#include "kernels/fluid/collision_pass.hpp"
#include "kernels/integrate/fluid_kicks.hpp"
#include "src/fluid/registry.hpp"

namespace BL_SOLVER {
namespace {

/// What bounds the next step; on the way velocities are corrected by `kick` of what the acceleration has
/// changed.
struct CorrectSweep {
  using Value = FluidExtremes;
  FluidMotion fluid;
  Real kick;  ///< s
  Span<const Real3> acc_old, acc;
  Span<const Real> eps, viscosity, compression;  ///< the first two empty where they are 1
  Span<const Real3> drift;
  Span<const FluidPosition> x_list;
  Span<const Real> half_skin;
  double longest;  ///< of steps, s
  /// By the end of the next, how far the mean shear will have parted pairs (m) since the lists were built,
  /// and the strain: among positions sheared back, what moves along z moves along x, too.
  double spread, strained;
  Span<const Real> h, h_list;  ///< empty where all have one length
  MeanShear listed;            ///< where the lists were built
  Span<const Id> id;

  BL_HD Value identity() const { return {}; }
  BL_HD Value operator()(Index a) const {
    const Real3 acceleration = acc[a];
    Real3 v = fluid.v_rho[a].v;
    if (kick != 0) {
      v += kick * (acceleration - acc_old[a]);
      fluid.v_rho[a] = {v, fluid.v_rho[a].rho};
    }
    if (drift) v += drift[a];
    const auto& [frame, shear, x, v_rho] = fluid;
    const Vec3d now = fluid.at(a);
    Vec3d moved = frame.separation(shear.lattice(now), listed.lattice(coordinates(frame, x_list[a])));
    moved.x += listed.strain * moved.z;
    Value out;
    out.v2 = norm2(shear.peculiar(v, now.z));
    out.acc2 = norm2(acceleration);
    const double speed = std::sqrt(out.v2) + longest * std::sqrt(out.acc2);
    const double left = half_skin[a] - norm(moved) - spread / 2;
    out.lasts = left < 0 ? 0 : left / max_of(speed * (1 + strained), 1e-30);
    if (eps) out.eps_min = eps[a];
    if (viscosity) out.thickest = viscosity[a];
    if (h) out.h_min = h[a], out.growth = h[a] / h_list[a];
    const bool good =
        out.v2 < 1e30 && out.acc2 < 1e30 && compression[a] >= Real(-0.5) && compression[a] <= Real(1);
    out.bad = good ? kNone : id[a];
    return out;
  }
  BL_HD void combine(Value& into, const Value& v) const { bound(into, v); }
  BL_HD static void bound(Value& into, const Value& v) {
    into.v2 = max_of(into.v2, v.v2);
    into.acc2 = max_of(into.acc2, v.acc2);
    into.lasts = min_of(into.lasts, v.lasts);
    into.eps_min = min_of(into.eps_min, v.eps_min);
    into.thickest = max_of(into.thickest, v.thickest);
    into.h_min = min_of(into.h_min, v.h_min);
    into.growth = max_of(into.growth, v.growth);
    into.bad = min_of(into.bad, v.bad);
  }
};

}  // namespace

std::unique_ptr<FluidSolver> FluidSolver::make(const FluidParameters& parameters, const Frame& frame,
                                               const WallGeometry& walls, FluidStore& fluid) {
  return FluidModels::make(parameters, frame, walls, fluid);
}

FluidSolver::FluidSolver(const FluidParameters& p, const Frame& frame, const WallGeometry& walls,
                         FluidStore& fluid, double kappa)
    : parameters_(p),
      frame_(frame),
      kappa_(kappa),
      lengths_(p.fluid.variable_h ? std::make_unique<SmoothingLengths>(fluid, p.fluid.h()) : nullptr),
      eos_(EquationOfState::of(p.eos, p.fluid, p.density.cavitation_limit)),
      shear_{p.domain.shear_rate, 0, p.domain.min.z, p.domain.max.z - p.domain.min.z},
      edges_(p.domain.reflect, frame) {
  renew_skins({});
  if (p.repelled) repelling_ = walls.view();
  orifices_.assign(p.orifices);
  layers_.assign(p.layers);
  if (!(p.density.count_grains && p.mixed)) fluid.grains_around.leave_out();
  if (!p.several) fluid.species.leave_out();
  if (!p.viscosity_varies()) fluid.viscosity.leave_out();
  fluid.drift.begin_at_zero();
  if (!drifts()) fluid.drift.leave_out();
  fluid.exposure.begin_at_zero();
  if (!shifts()) fluid.exposure.leave_out(), fluid.exposure_next.leave_out();
  fluid.correction.begin_at_zero();
  if (!fits()) fluid.correction.leave_out();
  fluid.compression_rate.begin_at_zero();
  if (p.pressure.damper == 0) fluid.compression_rate.leave_out();
  if (p.visc.collision)
    collisions_ = std::make_unique<Field<Real>>(fluid, "collisions", "-", Lifetime::derived);
  const bool summed = p.density.method == DensityMethod::summation;
  if (p.time.integrator != TimeIntegrator::kdk || summed) fluid.xp_mid.leave_out();
  if (p.time.integrator != TimeIntegrator::ab3) return;
  fluid.compression_next.leave_out();
  for (const char* name : {"density_rate", "density_rate_before", "density_rate_long_before"}) {
    rates_.push_back(std::make_unique<Field<Real>>(fluid, name, "1/s", Lifetime::kept));
    rates_.back()->begin_at_zero();
  }
}

void FluidSolver::accept_rates(double dt) {
  rates_[0]->buffer().swap(rates_[2]->buffer());
  rates_[1]->buffer().swap(rates_[2]->buffer());
  dt_before_ = last_dt_;
  last_dt_ = dt;
}

void FluidSolver::save(std::vector<Quantity>& scalars) const {
  scalars.push_back({"half_skin_fluid", "m", half_skin_});
  scalars.push_back({"half_skin_walls", "m", wall_skin_});
  if (lengths_) scalars.push_back({"smoothing_length_listed", "m", lengths_->listed});
  if (shear_.acts()) {
    scalars.push_back({"shear_strain", "-", shear_.strain});
    scalars.push_back({"shear_strain_listed", "-", listed_strain_});
  }
  scalars.push_back({"density_last_dt", "s", last_dt_});
  scalars.push_back({"density_dt_before", "s", dt_before_});
}

StepLimit FluidSolver::friction_limit(const FluidExtremes& now) const {
  if (parameters_.visc.model == ViscosityModel::none || parameters_.fluid.mu == 0) return {Limit::viscous};
  return {Limit::viscous, parameters_.time.visc * square(half_range(now)) * now.eps_min *
                              parameters_.fluid.rho0 / (parameters_.fluid.mu * now.thickest)};
}

double FluidSolver::repulsion_cap(double dt) const {
  return dt > 0 ? 0.1 * parameters_.fluid.dx / (dt * dt) : 1e30;
}

Drive FluidSolver::drive(const FluidStore& fluid, const StepTime& now) const {
  const DriveConfig& d = parameters_.drive;
  const Vec3d spring{d.rate.x * d.rate.x, d.rate.y * d.rate.y, d.rate.z * d.rate.z};
  const DriveField field = d.on_fluid() ? now.drive : DriveField{frame_, {}, {}, -1};
  return {.field = field,
          .x = fluid.x,
          .mode = d.mode,
          .shared = d.on == DrivenPhase::both,
          .spring = spring,
          .centre = d.centre,
          .pulls = d.pulls()};
}

void FluidSolver::collide(FluidStore& fluid) {
  const ViscosityConfig& c = parameters_.visc;
  if (!c.collision) return;
  const double range = c.collision_range * parameters_.fluid.dx;
  of_fluid_.resize(fluid.size());
  fluid_fluid_.run_within(range, CollisionCountPass{Real(range * range), fluid.v_rho, *collisions_});
  share(fluid, {collisions_.get()});
  fluid_fluid_.run_within(range, CollisionPass{.range2 = Real(range * range),
                                               .restitution = Real(c.collision_restitution),
                                               .guard = Real(1e-12 * range * range),
                                               .v_rho = fluid.v_rho,
                                               .mass = fluid.mass,
                                               .count = *collisions_,
                                               .v_next = collided_});
  fluid.v_rho.buffer().swap(collided_);
}

WallRepulsion FluidSolver::repulsion(const FluidStore& fluid, Span<const BodyPose> pose, double dt) const {
  const double dx = parameters_.fluid.dx, rate = dt > 0 ? std::min(parameters_.fluid.c / dx, 0.5 / dt) : 0;
  const Repulsion& law = parameters_.repulsion;
  return {.law = {law.D, law.r0, Real(repulsion_cap(dt))},
          .limit = {Real(dx), Real(rate), Real(dt > 0 ? 1 / dt : 0)},
          .frame = frame_,
          .walls = repelling_,
          .pose = pose,
          .exposure = span_if(shifts(), fluid.exposure)};
}

OrificeRepulsion FluidSolver::orifice_repulsion(Span<const BodyPose> pose, double dt) const {
  const Repulsion& law = parameters_.repulsion;
  return {.law = {law.D, law.r0, Real(repulsion_cap(dt))},
          .gentle = Real(0.01 * parameters_.fluid.c),
          .rate = dt > 0 ? Real(1 / dt) : Real(0),
          .frame = frame_,
          .orifices = orifices_,
          .pose = pose};
}

void FluidSolver::repel(FluidStore& fluid, Span<const BodyPose> pose, double kick, double dt) {
  if (!repels()) return;
  for_each({0, Index(beside_walls_.size())}, RepelPass{.walls = repulsion(fluid, pose, dt),
                                                       .orifices = orifice_repulsion(pose, dt),
                                                       .kick = Real(kick),
                                                       .dt = Real(dt),
                                                       .beside_walls = beside_walls_,
                                                       .x = fluid.x,
                                                       .v_rho = fluid.v_rho,
                                                       .acc_before = fluid.acc,
                                                       .acc = fluid.acc_next,
                                                       .heading = fluid.heading,
                                                       .drift = drift_of(fluid)});
}

KickDriftPass FluidSolver::kick_drift_pass(FluidStore& fluid, double kick, double drift, double back,
                                           bool coupled) {
  return {.fluid = motion(fluid),
          .copies = copies(fluid),
          .kick = Real(kick),
          .drift = Real(drift),
          .back = Real(back),
          .acc = fluid.acc,
          .reaction = span_if(coupled, fluid.reaction),
          .beside = drift_of(fluid),
          .edges = edges_};
}

StatePass FluidSolver::state_pass(FluidStore& fluid, const DensityHistory& history, double kick,
                                  bool coupled) {
  return {.fluid = motion(fluid),
          .eos = eos_,
          .damping = Real(damping()),
          .compression_rate = fluid.compression_rate,
          .history = history,
          .kick = Real(kick),
          .acc = fluid.acc,
          .reaction = span_if(coupled, fluid.reaction),
          .compression = fluid.compression,
          .mass = fluid.mass,
          .eps = span_if(parameters_.mixed, fluid.eps),
          .flux = span_if(parameters_.mixed || shear_.acts(), fluid.flux),
          .eos_state = fluid.eos_state,
          .p_rho2 = fluid.p_rho2};
}

void FluidSolver::kick_drift(FluidStore& fluid, double kick, double drift, double back, bool coupled) {
  shear_.strain += shear_.rate * drift;
  for_each(fluid.owned(), kick_drift_pass(fluid, kick, drift, back, coupled));
}

void FluidSolver::state(FluidStore& fluid, double kick, bool coupled) {
  for_each(fluid.owned(), state_pass(fluid, {}, kick, coupled));
  if (lengths_) for_each(fluid.owned(), length_pass(fluid, false));
}

LengthPass FluidSolver::length_pass(FluidStore& fluid, bool renew) {
  const FluidProperties& f = parameters_.fluid;
  return {.sigma = Real(f.sigma_h),
          .least = Real(f.h_least()),
          .most = Real(f.h_most()),
          .thickness = Real(parameters_.domain.thickness()),
          .rho0 = Real(f.rho0),
          .first = !lengths_->begun,
          .renew = renew,
          .mass = fluid.mass,
          .eos_state = fluid.eos_state,
          .listed = lengths_->h_list,
          .h = lengths_->h,
          .omega = lengths_->omega};
}

void FluidSolver::advance(FluidStore& fluid, double kick, double dt, double predict) {
  const DensityHistory history(*rates_[0], *rates_[1], *rates_[2], dt, last_dt_, dt_before_);
  for_each(fluid.owned(), AdvancePass{kick_drift_pass(fluid, kick, dt, 0, false),
                                      state_pass(fluid, history, predict, false)});
}

void FluidSolver::correct(FluidStore& fluid, double kick) {
  fluid.acc.buffer().swap(fluid.acc_next.buffer());
  survey(fluid, kick);
}

void FluidSolver::survey(FluidStore& fluid, double kick) {
  MeanShear listed = shear_;
  listed.strain = listed_strain_;
  const double longest = longest_step();
  const auto strained = [&](double dt) {
    return std::abs(shear_.strain + shear_.rate * dt - listed_strain_);
  };
  const double most = std::max(strained(0), strained(longest));
  const Span<const Real> none;
  extremes_.take(fluid.owned(), CorrectSweep{.fluid = motion(fluid),
                                             .kick = Real(kick),
                                             .acc_old = fluid.acc_next,
                                             .acc = fluid.acc,
                                             .eps = span_if(parameters_.mixed, fluid.eps),
                                             .viscosity = span_if(parameters_.thickens, fluid.viscosity),
                                             .compression = fluid.compression,
                                             .drift = drift_of(fluid),
                                             .x_list = fluid.x_list,
                                             .half_skin = fluid.half_skin,
                                             .longest = longest,
                                             .spread = most * range(),
                                             .strained = most,
                                             .h = lengths_ ? Span<const Real>(lengths_->h) : none,
                                             .h_list = lengths_ ? Span<const Real>(lengths_->h_list) : none,
                                             .listed = listed,
                                             .id = fluid.id});
}

FluidExtremes FluidSolver::extremes() const {
  FluidExtremes out =
      all_reduce(extremes_.read(), [](auto& into, const auto& from) { CorrectSweep::bound(into, from); });
  if (!std::isfinite(out.h_min)) out.h_min = parameters_.fluid.h();  // one length, or no fluid
  return out;
}

}  // namespace BL_SOLVER
