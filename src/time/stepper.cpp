#include "src/time/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "src/measure/sweeps.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

/// What a formula makes of a time is known only then.
void must_be_finite(const Vec3d& v, const char* what, double t) {
  if (!std::isfinite(norm2(v)))
    throw SimulationFault(std::string(what) + " is no finite number at t = " + std::to_string(t) + " s");
}

}  // namespace

Stepper::Stepper(const Config& config, State& state)
    : config_(config),
      state_(state),
      frame_(state.frame),
      clock_(state.clock),
      fluid_(state.fluid),
      walls_(state.walls),
      grains_(state.grains),
      bodies_(state.bodies),
      motion_(state.motion),
      open_(state.open),
      gravity_(state.gravity),
      fluid_factor_(config.drive),
      grain_factor_(config.drive) {
  if (has_grains()) {
    const bool wet = has_fluid() && config.couple.mode != CouplingMode::off;
    solid_solver_ = std::make_unique<SolidSolver>(solid_parameters(config), frame_, state.grain_geometry,
                                                  grains_, &bodies_, wet);
    grain_grid_ = CellGrid(frame_, frame_.origin, frame_.origin + frame_.length, solid_solver_->range());
  }
  if (has_fluid())
    fluid_solver_ = FluidSolver::make(fluid_parameters(config), frame_, state.geometry, fluid_);
  if (coupled()) coupling_ = std::make_unique<Coupling>(coupling_parameters(config), frame_, state.geometry);
  list_stages();
}

StepInfo Stepper::step(const Observer& observer) {
  Step now = next_step();
  watch_.start();
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    const Stage& stage = stages_[k];
    if (observer) observer(k);
    (this->*stage.run)(now);
    if (k + 1 == stages_.size() || stages_[k + 1].part != stage.part) watch_.lap(int(stage.part));
  }
  watch_.stop();
  if (observer) observer(stages_.size());
  return {clock_.step,
          clock_.time,
          now.dt,
          now.substeps,
          now.limit,
          now.substep_limit,
          std::sqrt(fluid_extremes_.v2),
          std::exchange(rebuilt_, false)};
}

Step Stepper::next_step() {
  Step now;
  now.start = clock_.time;
  now.dt = clock_.next_dt(limits(), now.limit);
  now.end = now.start + now.dt;
  now.last_kick = config_.time.integrator == TimeIntegrator::euler ? 0 : now.dt / 2;
  now.held = held();
  if (!has_grains() && !bodies_.any()) return now;
  now.substeps = 1;
  if (now.held && !bodies_.any()) return now;
  const StepLimit longest = longest_substep();
  now.substep_limit = longest.limit;
  now.substeps = std::max(1, int(std::ceil(now.dt / longest.seconds * (1 - 1e-9))));
  return now;
}

std::vector<Quantity> Stepper::time_spent() const {
  std::vector<Quantity> out;
  for (const Part part : {Part::lists, Part::fluid, Part::grains, Part::coupling, Part::checks})
    if (std::any_of(stages_.begin(), stages_.end(), [&](const Stage& stage) { return stage.part == part; }))
      out.push_back({std::string(name_of(part)), "s", watch_.seconds(int(part))});
  return out;
}

// -- stages ------------------------------------------------------------------
//
// Kick-drift-kick, with density from a pass of its own in the middle of the step or from former rates; or
// symplectic Euler: velocity, then position and density from the new velocity, which is the cycle of [H]
// Fig. 3 (density, velocity, position) begun at its second station.

void Stepper::renew_lists(Step& now) { refresh_if_needed(now.dt); }

void Stepper::interpolate(Step& now) { coupling_->gather(fluid_, grains_, poses_now(), now.dt, clock_.step); }

/// Grains and bodies, in substeps.
void Stepper::move_solids(Step& now) {
  const auto gravity = gravity_.along(now.start, now.dt, now.substeps);
  const Span<BodyPose> poses = motion_.poses(now.start, now.dt, now.substeps);
  substep_poses_ = poses;
  if (bodies_.any())
    bodies_.begin(poses, motion_.bodies(), now.start, now.dt, now.substeps, now.dt - now.last_kick, gravity);
  if (has_grains())
    solid_solver_->advance(grains_, poses, motion_.bodies(), now.dt, now.substeps, now.held, gravity,
                           wall_travel(now.dt), drive_grains());
  else
    bodies_.advance();
}

void Stepper::react(Step& now) { coupling_->react(fluid_, grains_, now.dt); }

void Stepper::collide(Step&) { fluid_solver_->collide(fluid_); }

void Stepper::kick_drift(Step& now) {
  fluid_solver_->kick_drift(fluid_, now.dt - now.last_kick, now.dt, now.last_kick, two_way());
}

void Stepper::advance(Step& now) {
  fluid_solver_->advance(fluid_, now.dt - now.last_kick, now.dt, now.last_kick);
}

/// Density follows from places and velocities in the middle of a kick-drift-kick step, the fluid's and the
/// walls'.
void Stepper::move_walls(Step& now) {
  now.poses = motion_.poses_at(now.end);
  if (walls_.size() == 0 || !motion_.moves()) return;
  const double back = fluid_solver_->one_pass() ? 0 : now.last_kick;
  WallMotion::place(frame_, walls_, motion_.poses_in_step(now.end, back, now.dt));
  fluid_solver_->pack(walls_, back);
}

/// Between fluid and grains that have both moved.
void Stepper::porosity(Step& now) {
  fluid_solver_->pack(fluid_);
  coupling_->porosity(fluid_, grains_, now.poses, now.dt);
  fluid_solver_->pack(fluid_, now.last_kick);
}

void Stepper::density(Step& now) {
  fluid_solver_->density(fluid_, walls_, now.poses, moment_, now.dt);
  if (motion_.moves()) fluid_solver_->pack(walls_);
}

void Stepper::fluid_state(Step& now) { fluid_solver_->state(fluid_, now.last_kick, two_way()); }

void Stepper::wall_state(Step& now) {
  if (walls_.size() == 0) return;
  fluid_solver_->walls(fluid_, walls_, now.poses, Real3(gravity_.at(now.end)), two_way() ? now.dt : 0,
                       motion_.moves());
}

void Stepper::forces(Step& now) {
  moment_ = moment(now.end, clock_.step + 1);
  fluid_solver_->forces(fluid_, walls_, now.poses, moment_, now.dt);
}

void Stepper::repel(Step& now) { fluid_solver_->repel(fluid_, now.poses, now.last_kick, now.dt); }

/// The fluid's force on free bodies.
void Stepper::load_bodies(Step& now) {
  if (walls_.size() > 0)
    fluid_solver_->wall_forces(fluid_, walls_, now.poses, moment_, 0, now.dt, wall_force_);
  const bool corrected = fluid_solver_->fits() && walls_.size() > 0;
  if (corrected)
    fluid_solver_->body_pressures(fluid_, walls_, bodies_.fit_pressure(walls_, now.poses), wall_in_fit_);
  const WallRepulsion repulsion = fluid_solver_->repulsion(fluid_, now.poses, now.dt);
  bodies_.feel_fluid(walls_, wall_force_, corrected ? &wall_in_fit_ : nullptr,
                     repulsion.walls.surfaces.size > 0 ? &repulsion : nullptr, fluid_, now.poses,
                     now.last_kick, now.dt);
}

void Stepper::correct(Step& now) {
  fluid_solver_->correct(fluid_, now.last_kick);
  corrected_ = now.last_kick;
}

/// What of the fluid's stress falls to the grains.
void Stepper::push(Step& now) {
  coupling_->push(fluid_, grains_, now.last_kick, now.held);
  solid_solver_->groups().follow(grains_, {}, {}, 0);
}

void Stepper::finish(Step& now) {
  const double speed_before = motion_.top_speed(now.start);
  clock_.time = now.end;
  motion_.advance(clock_.time);
  clock_.last_dt = now.dt;
  ++clock_.step;
  bodies_.read_back(clock_.time);
  walls_moved_ += now.dt * std::max(speed_before, motion_.top_speed(clock_.time));
  remove_cleared_bodies();
  sweep();
  if (coupled()) coupling_->read_survey();
}

// -- what stages go by ---------------------------------------------------------

double Stepper::wall_travel(double dt) const {
  const double before = motion_.top_speed(clock_.time, dt),
               after = motion_.prescribed_speed(clock_.time + dt);
  return 1.5 * dt * std::max(before, after);
}

StepLimit Stepper::longest_substep() const {
  if (config_.time.dt_dem > 0) return {Limit::fixed, config_.time.dt_dem};
  return least_of(substep_limits());
}

Moment Stepper::moment(double t, std::int64_t step) {
  Moment m{std::uint64_t(step), Real3(gravity_.at(t)), {}};
  must_be_finite(gravity_.at(t), "frame.motion: its acceleration", t);
  if (!config_.drive.on_fluid()) return m;
  m.drive = fluid_factor_.field<FluidPosition>(config_.drive, frame_, fluid_.x, t);
  must_be_finite(m.drive.f, "drive.factor", t);
  return m;
}

Span<const Real3> Stepper::drive_grains() {
  if (!config_.drive.on_grains()) return {};
  grain_drive_.resize(grains_.size());
  for_each(
      grains_.owned(),
      GrainDrivePass{grain_factor_.field<Vec3d>(config_.drive, frame_, grains_.x, clock_.time),
                     config_.drive.mode, state_.matter.of(grains_), grains_.x, grains_.radius, grain_drive_});
  return grain_drive_;
}

std::vector<StepLimit> Stepper::limits() {
  std::vector<StepLimit> out;
  const auto& t = config_.time;
  if (has_fluid()) {
    const double hs = fluid_solver_->half_range(fluid_extremes_), c = config_.fluid.c;
    out.push_back({Limit::cfl, t.cfl * hs / (c + std::sqrt(fluid_extremes_.v2))});
    if (const StepLimit friction = fluid_solver_->friction_limit(fluid_extremes_);
        std::isfinite(friction.seconds))
      out.push_back(friction);
    if (fluid_extremes_.acc2 > 0)
      out.push_back({Limit::body, t.body * std::sqrt(hs / std::sqrt(fluid_extremes_.acc2))});
    if (coupled()) out.push_back({Limit::drag, coupling_->stable_dt()});
  }
  const double wall_speed = motion_.top_speed(clock_.time);
  double travel = std::numeric_limits<double>::infinity();
  if (!has_fluid())  // without fluid there is no other clock: a step is a handful of substeps
    for (const StepLimit& substep : body_limits()) out.push_back({substep.limit, 20 * substep.seconds});
  if (has_grains()) {
    const double v = grain_watch_.speed;
    if (v > 0 && !held()) travel = 0.05 * config_.grain.d_min / v;
    if (!has_fluid()) {
      const StepLimit substep = solid_solver_->stable_dt(grain_watch_);
      out.push_back({substep.limit, 20 * substep.seconds});
    }
  }
  if (wall_speed > 0 && (has_fluid() || has_grains()))
    travel = std::min(travel, 0.1 * (has_fluid() ? config_.fluid.dx : config_.grain.d_min) / wall_speed);
  if (travel < t.end) out.push_back({Limit::travel, travel});
  return with_binding(std::move(out));
}

std::vector<StepLimit> Stepper::body_limits() const {
  return bodies_.limits(motion_.prescribed_speed(clock_.time));
}

std::vector<StepLimit> Stepper::substep_limits() const {
  std::vector<StepLimit> out = body_limits();
  if (!has_grains() || held()) return with_binding(std::move(out));
  const std::vector<StepLimit> grains = solid_solver_->limits(grain_watch_);
  out.insert(out.begin(), grains.begin(), grains.end());
  return with_binding(std::move(out));
}

void Stepper::sweep() {
  const auto fault = [&](const std::string& what, const Vec3d& x, const char* cause) {
    char text[300];
    std::snprintf(text, sizeof text, " at (%.6g, %.6g, %.6g) m broke down at t = %.6g s, step %lld: ", x.x,
                  x.y, x.z, clock_.time, static_cast<long long>(clock_.step));
    throw SimulationFault(what + text + cause);
  };
  if (has_fluid()) {
    fluid_extremes_ = fluid_solver_->extremes();
    if (const Index a = fluid_extremes_.bad; a != kNone)
      fault("fluid particle " + std::to_string(fluid_.id.values()[a]),
            coordinates(frame_, fluid_.x.values()[a]),
            "its density left 0.5..2 rho0 or became NaN; likely causes: fluid.vmax too low (sound speed), "
            "time step too large, or fluid overlapping walls or grains at the start");
  }
  if (has_grains()) {
    grain_watch_ = solid_solver_->watch(grains_);
    if (const Id bad = grain_watch_.bad; bad != kNone) {
      const auto id = grains_.id.values();
      const std::size_t i = std::find(id.begin(), id.end(), bad) - id.begin();
      fault("grain " + std::to_string(bad), grains_.x.values()[i],
            "its position or velocity became NaN; likely causes: overlapping grains at the start or "
            "time.dt_dem too large");
    }
  }
  if (const int k = bodies_.broken(); k >= 0)
    fault("wall.body \"" + config_.wall.bodies[bodies_.body(k)].name + '"', bodies_.motion(k).origin(),
          "its place or velocity became NaN; likely causes: it overlaps others at the start, time.dt_dem too "
          "large, or far lighter than the fluid around it");
}

void Stepper::refresh_if_needed(double dt) {
  // by the end of this step; while each particle keeps to its half skin, the lists across the phases hold too
  bool fluid_due = open_.fluid_due(), grains_due = open_.grains_due(clock_.time);
  if (has_fluid())
    fluid_due = fluid_due || fluid_solver_->due(fluid_extremes_, dt,
                                                walls_moved_ + dt * motion_.top_speed(clock_.time, dt));
  if (has_grains() && !config_.grain.fixed) {
    const double moved =
        grain_watch_.displacement + 1.5 * dt * (grain_watch_.speed + dt * norm(gravity_.at(clock_.time)));
    grains_due = grains_due || 2 * moved > solid_solver_->skin();
  }
  refresh(fluid_due, grains_due, dt);
}

void Stepper::refresh(bool fluid, bool grains, double dt) {
  if (fluid) {
    open_.renew(fluid_, walls_, fluid_solver_->eos(), clock_.time, gravity_.at(clock_.time));
    const double fastest = std::sqrt(fluid_extremes_.v2) + dt * std::sqrt(fluid_extremes_.acc2);
    fluid_solver_->refresh(fluid_, walls_, rebuilds_ == 0 || walls_moved_ > 0,
                           {dt, fastest, motion_.top_speed(clock_.time, dt), motion_.moves()});
    walls_moved_ = 0;
  }
  if (grains) solid_solver_->refresh(grains_, grain_grid_, open_.renew(grains_, clock_.time));
  if (!fluid && !grains) return;
  if (coupled()) relist_coupling();
  rebuilt_ = true;
  ++rebuilds_;
}

void Stepper::relist_coupling() {
  coupling_->rebuild_lists(fluid_, fluid_solver_->grid().view(), fluid_solver_->half_skins(fluid_), grains_,
                           grain_grid_.view(), solid_solver_->skin() / 2,
                           motion_.moves() ? Span<const BodyPose>() : poses_now());
}

void Stepper::remove_cleared_bodies() {
  const double g = norm(config_.gravity);
  if (g == 0 || clock_.step % 20 != 0) return;
  const Vec3d up = config_.gravity * (-1 / g);
  for (int b = 0; b < motion_.walls(); ++b) {
    const auto& motion = config_.wall.bodies[b].motion;
    if (!motion.remove_when_clear || motion_.removed(b) || clock_.time <= motion.start) continue;
    double top = -std::numeric_limits<double>::infinity();
    if (has_fluid())
      top = std::max(top, max_over(fluid_.owned(), AlongBody<FluidPosition>{frame_, fluid_.x, up}) +
                              fluid_solver_->range());
    if (has_grains())
      top = std::max(
          top, max_over(grains_.owned(), AlongBody<Vec3d>{frame_, grains_.x, up}) + config_.grain.d_max);
    if (motion_.lowest(b, clock_.time, up) > top) motion_.remove(b);
  }
}

}  // namespace bedload::inline BL_VARIANT
