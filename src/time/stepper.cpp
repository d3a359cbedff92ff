// One step, by kick-drift-kick with density from a pass in the middle of the step, or from former rates; or
// by symplectic Euler: velocity, then position and density from the new velocity, which is the cycle of [H]
// Fig. 3 (density, velocity, position) begun at its second station.

#include "src/time/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "bedload/parallel/reductions.hpp"
#include "bedload/particles/along.hpp"
#include "src/domain/divide.hpp"

namespace BL_SOLVER {
namespace {

/// What a formula makes of a time is known only then.
void must_be_finite(const Vec3d& v, const char* what, double t) {
  if (!std::isfinite(norm2(v)))
    throw SimulationFault(std::string(what) + " is not finite at t = " + std::to_string(t) + " s");
}

constexpr double kMostSubsteps = 1e6;  ///< of a step

/// A run with so many would never end, and the poses of walls at each would fill the memory. At the first
/// step the case is wrong. `body`: name of the free body that sets the limit, empty for other limits.
[[noreturn]] void refuse_substeps(const Clock& clock, double dt, double substeps, const StepLimit& longest,
                                  const std::string& body) {
  const NamedLimit& bound = kLimits[std::size_t(longest.limit)];
  const std::string limit =
      '"' + std::string(bound.name) + '"' + (body.empty() ? "" : " of wall.body \"" + body + '"');
  char start[160], end[80];
  std::snprintf(start, sizeof start, "a step of %.3g s would take %.3g substeps of %.3g s, by the limit ", dt,
                substeps, longest.seconds);
  std::snprintf(end, sizeof end, ", at t = %.6g s; at most %.0f are allowed", clock.time, kMostSubsteps);
  if (clock.step > 0) throw SimulationFault(start + limit + end);
  const bool named = !bound.key.empty() && longest.limit != Limit::fixed;
  const std::string key(named ? bound.key : "time.dt_dem");
  throw KeyError(key, key + ": " + start + limit + end);
}

/// Where the particle of that id is, on whichever rank.
template <class Particles>
Vec3d place_of(Id id, const Particles& particles, const Frame& frame) {
  struct Found {
    bool here;
    Vec3d x;
  } own{false, {}};
  const auto ids = particles.id.values();
  const auto end = ids.begin() + particles.owned().size();
  if (const auto at = std::find(ids.begin(), end, id); at != end)
    own = {true, coordinates(frame, particles.x.values()[std::size_t(at - ids.begin())])};
  return all_reduce(own,
                    [](Found& into, const Found& other) {
                      if (other.here) into = other;
                    })
      .x;
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
    // smaller ones than fluid searches for would only be many
    const double least_cell = wet ? config.couple.hc / 16 : 0;
    grain_grid_ = CellGrid(frame_, frame_.origin, frame_.origin + frame_.length,
                           std::max(solid_solver_->range(), least_cell), int(config.block));
  }
  if (has_fluid())
    fluid_solver_ = FluidSolver::make(fluid_parameters(config), frame_, state.geometry, fluid_);
  if (coupled()) {
    coupling_ = std::make_unique<Coupling>(coupling_parameters(config), frame_, state.geometry);
    fluid_solver_->divide_with(grains_, grain_grid_, coupling_->range() + solid_solver_->skin() / 2);
    solid_solver_->follow();
    if (Clumps& clumps = solid_solver_->clumps(); clumps.share_drag()) coupling_->share_drag(clumps);
  }
  if (!fluid_.xp_mid.used() || !motion_.moves()) walls_.xp_mid.leave_out();
  if (!has_fluid() || !fluid_solver_->pays_for_walls()) walls_.work.leave_out();
}

ParticleBytes Stepper::scratch_bytes() const {
  ParticleBytes all{.walls = of_walls_.entry_bytes(),
                    .grains = of_grains_.entry_bytes() + bodies_.record_bytes()};
  if (config_.drive.on_fluid()) all.fluid += fluid_factor_.scratch_bytes();
  if (config_.drive.on_grains()) all.grains += grain_factor_.scratch_bytes();
  if (has_fluid()) all += fluid_solver_->scratch_bytes();
  if (has_grains()) all += solid_solver_->scratch_bytes();
  if (coupled()) all += coupling_->scratch_bytes();
  return all;
}

StepInfo Stepper::step(const Observer& observer) {
  Step now = next_step();
  now.observer = &observer;
  now.watch = &watch_;
  watch_.start();

  renew_lists(now);
  if (coupled()) interpolate(now);
  if (has_grains() || bodies_.any()) move_solids(now);
  if (two_way()) react(now);
  if (has_fluid()) {
    if (config_.visc.collision) collide(now);
    fluid_solver_->one_pass() ? advance(now) : kick_drift(now);
    move_walls(now);
    if (coupled()) porosity(now);
    if (!fluid_solver_->one_pass()) {
      density(now);
      fluid_state(now);
    }
    evaluate(now);
  }
  finish(now);

  watch_.lap(int(now.timed));
  watch_.stop();
  if (observer) observer(nullptr);
  return info_of(now);
}

void Stepper::evaluate(Step& now) {
  wall_state(now);
  forces(now);
  if (fluid_solver_->repels()) repel(now);
  if (bodies_.any()) load_bodies(now);
  correct(now);
  if (coupled()) push(now);
}

void Stepper::start() {
  Step now;
  now.held = held();
  // settled grains were divided without the fluid
  if (coupled() && Context::current().several()) fluid_solver_->divide(fluid_, walls_, false);
  refresh(has_fluid(), has_grains());
  now.poses = poses_now();
  if (has_grains()) solid_solver_->evaluate(grains_, now.poses);
  if (bodies_.any()) bodies_.evaluate(now.poses);
  if (has_fluid()) {
    initialise_fluid(now);
    if (coupled()) porosity(now);
    fluid_state(now);
    fluid_solver_->pack(fluid_);
    outdate({&fluid_.xp, &fluid_.xp_mid});
    evaluate(now);
  }
  sweep();
  if (coupled()) interpolate(now);  // for the first step's drag limit
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
  const double substeps = std::ceil(now.dt / longest.seconds * (1 - 1e-9));
  if (!(substeps <= kMostSubsteps))
    refuse_substeps(clock_, now.dt, substeps, longest,
                    longest.body < 0 ? "" : config_.wall.bodies[longest.body].name);
  now.substep_limit = longest.limit;
  now.substeps = std::max(1, int(substeps));
  return now;
}

StepInfo Stepper::info_of(const Step& now) {
  return {clock_.step,
          clock_.time,
          now.dt,
          now.substeps,
          now.limit,
          now.substep_limit,
          std::sqrt(fluid_extremes_.v2),
          std::exchange(rebuilt_, false)};
}

std::vector<Quantity> Stepper::time_spent() const {
  std::vector<Quantity> out;
  const auto add = [&](Part part) {
    out.push_back({std::string(name_of(part)), "s", watch_.seconds(int(part))});
  };
  add(Part::lists);
  if (has_fluid()) add(Part::fluid);
  if (has_grains() || bodies_.any()) add(Part::grains);
  if (coupled()) add(Part::coupling);
  add(Part::checks);
  return out;
}

// -- limits of a step, lists, checks -----------------------------------------------

double Stepper::wall_travel(double dt) const {
  const double before = motion_.top_speed(clock_.time, dt),
               after = motion_.prescribed_speed(clock_.time + dt);
  return 1.5 * dt * std::max(before, after);
}

StepLimit Stepper::longest_substep() const {
  if (config_.time.dt_dem > 0) return {Limit::fixed, config_.time.dt_dem};
  return least_of(substep_limits());
}

StepTime Stepper::moment(double t, std::int64_t step) {
  StepTime m{std::uint64_t(step), Real3(gravity_.at(t)), {}};
  must_be_finite(gravity_.at(t), "frame.motion: its acceleration", t);
  if (!config_.drive.on_fluid()) return m;
  m.drive = fluid_factor_.field<FluidPosition>(config_.drive, frame_, fluid_.x, t);
  must_be_finite(m.drive.f, "drive.factor", t);
  return m;
}

Span<const Real3> Stepper::drive_grains() {
  if (!config_.drive.on_grains()) return {};
  of_grains_.resize(grains_.size());
  for_each(grains_.owned(),
           GrainDrivePass{grain_factor_.field<Vec3d>(config_.drive, frame_, grains_.x, clock_.time),
                          config_.drive.mode,
                          config_.drive.mode == DriveMode::volume ? state_.matter.volume_of(grains_)
                                                                  : state_.matter.of(grains_),
                          grains_.x, grains_.radius, grain_drive_});
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
  if (has_grains()) solid_solver_->begin_watch(grains_);  // waited for with the fluid's
  if (has_fluid()) {
    fluid_extremes_ = fluid_solver_->extremes();
    if (const Id bad = fluid_extremes_.bad; bad != kNone)
      fault("fluid particle " + std::to_string(bad), place_of(bad, fluid_, frame_),
            "its density left 0.5..2 rho0 or became NaN; likely causes: fluid.vmax too low (sound speed), "
            "time step too large, or fluid overlapping walls or grains at the start");
  }
  if (has_grains()) {
    grain_watch_ = solid_solver_->watch();
    if (const Id bad = grain_watch_.bad; bad != kNone)
      fault("grain " + std::to_string(bad), place_of(bad, grains_, frame_),
            "its position or velocity became NaN; likely causes: overlapping grains at the start or "
            "time.dt_dem too large");
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
    grains_due = grains_due || 2 * moved + solid_solver_->image_travel(dt) > solid_solver_->skin();
  }
  refresh(fluid_due, grains_due, dt);
}

void Stepper::refresh(bool fluid, bool grains, double dt) {
  if (fluid) {
    fluid_.drop_ghosts();
    open_.renew(fluid_, walls_, fluid_solver_->eos(), clock_.time, gravity_.at(clock_.time));
    const double fastest = std::sqrt(fluid_extremes_.v2) + dt * std::sqrt(fluid_extremes_.acc2);
    fluid_solver_->refresh(fluid_, walls_, rebuilds_ == 0 || walls_moved_ > 0,
                           {dt, fastest, motion_.top_speed(clock_.time, dt), motion_.moves()});
    walls_moved_ = 0;
  }
  if (grains) {
    solid_solver_->refresh(grains_, grain_grid_, open_.renew(grains_, *solid_solver_, clock_.time));
  } else if (fluid && coupled()) {
    solid_solver_->regroup(grains_, grain_grid_);
  }
  if (!fluid && !grains) return;
  if (coupled()) relist_coupling();
  rebuilt_ = true;
  ++rebuilds_;
}

HostArray Stepper::blocks_of_grains() const { return solid_solver_->blocks(grains_, grain_grid_); }

void Stepper::relist_coupling() {
  const bool in_levels = solid_solver_->in_levels();
  const Span<const Index> order =
      in_levels ? solid_solver_->order_by_cells(grains_, grain_grid_) : Span<const Index>();
  coupling_->rebuild_lists(fluid_, fluid_solver_->grid().view(), fluid_solver_->half_skins(fluid_), grains_,
                           {grain_grid_.view(), order, in_levels ? &solid_solver_->levels() : nullptr},
                           solid_solver_->skin() / 2, motion_.moves() ? Span<const BodyPose>() : poses_now());
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

}  // namespace BL_SOLVER
