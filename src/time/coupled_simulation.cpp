#include "src/time/coupled_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "src/measure/sweeps.hpp"

namespace bedload::inline BL_VARIANT {

StepInfo CoupledSimulation::step() {
  std::string_view binding;
  const double dt = clock_.next_dt(limits(), binding);
  watch_.start();
  refresh_if_needed(dt);
  watch_.lap(kLists);

  const double speed_before = motion_.top_speed(clock_.time);
  int substeps = 0;
  if (has_grains() || bodies_.any()) {
    if (!held() || bodies_.any()) substeps = int(std::ceil(dt / longest_substep() * (1 - 1e-9)));
    substeps = std::max(1, substeps);
    if (coupled()) {
      coupling_->gather(fluid_, grains_, poses_now(), dt);
      drag_limit_ = coupling_->stable_dt();
      watch_.lap(kCoupling);
    }
    const auto gravity = gravity_.along(clock_.time, dt, substeps);
    const Span<BodyPose> poses = motion_.poses(clock_.time, dt, substeps);
    if (bodies_.any())
      bodies_.begin(poses, motion_.bodies(), clock_.time, dt, substeps, dt - last_kick(dt), gravity);
    if (has_grains())
      solid_solver_->advance(grains_, poses, motion_.bodies(), dt, substeps, held(), gravity, wall_travel(dt),
                             drive_grains());
    else
      bodies_.advance();
    watch_.lap(kGrains);
    if (two_way()) coupling_->react(fluid_, grains_, dt);
    watch_.lap(kCoupling);
  }
  if (has_fluid()) {
    advance_fluid(dt);
    watch_.lap(kFluid);
  }

  clock_.time += dt;
  motion_.advance(clock_.time);
  clock_.last_dt = dt;
  ++clock_.step;
  bodies_.read_back(clock_.time);
  walls_moved_ += dt * std::max(speed_before, motion_.top_speed(clock_.time));
  remove_cleared_bodies();
  sweep();
  watch_.lap(kChecks);
  watch_.stop();
  const bool rebuilt = std::exchange(rebuilt_, false);
  return {clock_.step, clock_.time, dt, substeps, binding, std::sqrt(fluid_extremes_.v2), rebuilt};
}

std::vector<Quantity> CoupledSimulation::time_spent() const {
  std::vector<Quantity> out{{"lists", "s", watch_.seconds(kLists)}};
  if (has_fluid()) out.push_back({"fluid", "s", watch_.seconds(kFluid)});
  if (has_grains() || bodies_.any()) out.push_back({"grains", "s", watch_.seconds(kGrains)});
  if (coupled()) out.push_back({"coupling", "s", watch_.seconds(kCoupling)});
  out.push_back({"checks", "s", watch_.seconds(kChecks)});
  return out;
}

double CoupledSimulation::wall_travel(double dt) const {
  const double before = motion_.top_speed(clock_.time, dt),
               after = motion_.prescribed_speed(clock_.time + dt);
  return 1.5 * dt * std::max(before, after);
}

double CoupledSimulation::longest_substep() {
  if (config_.time.dt_dem > 0) return config_.time.dt_dem;
  double longest = std::numeric_limits<double>::infinity();
  if (has_grains() && !held()) longest = solid_solver_->stable_dt(grain_watch_).seconds;
  if (bodies_.any()) longest = std::min(longest, bodies_.stable_dt(motion_.prescribed_speed(clock_.time)));
  return longest;
}

/// Kick-drift-kick, with density from a pass of its own in the middle of the step or from former rates; or
/// symplectic Euler: velocity, then position and density from the new velocity, which is the cycle of [H]
/// Fig. 3 (density, velocity, position) begun at its second station.
void CoupledSimulation::advance_fluid(double dt) {
  FluidSolver& fluid = *fluid_solver_;
  fluid.collide(fluid_);
  const double half = last_kick(dt), back = fluid.one_pass() ? 0 : half;
  if (fluid.one_pass())
    fluid.advance(fluid_, dt - half, dt, half);
  else
    fluid.kick_drift(fluid_, dt - half, dt, back, two_way());
  if (two_way()) {
    update_porosity(dt);
    fluid.pack(fluid_, half);
  }
  // density follows from places and velocities in the middle of a kick-drift-kick step, the fluid's and the
  // walls'
  Span<const BodyPose> pose;
  if (walls_.size() > 0) {
    pose = motion_.poses_in_step(clock_.time + dt, back, dt);
    if (motion_.moves()) {
      WallMotion::place(frame_, walls_, pose);
      fluid.pack(walls_, back);
    }
  }
  if (!fluid.one_pass()) {
    fluid.density(fluid_, walls_, pose, dt);
    fluid.accept_density(fluid_);
    if (motion_.moves()) fluid.pack(walls_);
    fluid.state(fluid_, half, two_way());
  }
  evaluate_fluid(dt, half);
  load_bodies(half, dt);
  fluid.correct(fluid_, half);
  if (coupled()) push_grains(dt, half);
}

Span<const Real3> CoupledSimulation::drive_grains() {
  if (!config_.drive.on_grains()) return {};
  grain_drive_.resize(grains_.size());
  for_each(grains_.owned(),
           GrainDrivePass{drive_factor_.field<Vec3d>(config_.drive, frame_, grains_.x, clock_.time),
                          config_.drive.mode, matter_.of(grains_), grains_.x, grains_.radius, grain_drive_});
  return grain_drive_;
}

void CoupledSimulation::update_porosity(double dt) {
  fluid_solver_->pack(fluid_);
  watch_.lap(kFluid);
  coupling_->porosity(fluid_, grains_, motion_.poses(clock_.time + dt, 0, 1), dt);
  watch_.lap(kCoupling);
}

void CoupledSimulation::push_grains(double dt, double kick) {
  watch_.lap(kFluid);
  coupling_->push(fluid_, grains_, motion_.poses(clock_.time + dt, 0, 1), kick, held());
  solid_solver_->groups().follow(grains_, {}, {}, 0);
  watch_.lap(kCoupling);
}

void CoupledSimulation::load_bodies(double kick, double dt) {
  if (!bodies_.any()) return;
  const Span<const BodyPose> poses = motion_.poses(clock_.time + dt, 0, 1);
  if (walls_.size() > 0) fluid_solver_->wall_forces(fluid_, walls_, poses, dt, wall_force_);
  const WallRepulsion repulsion = fluid_solver_->repulsion(poses, dt);
  bodies_.feel_fluid(walls_, wall_force_, repulsion.walls.surfaces.size > 0 ? &repulsion : nullptr, fluid_,
                     poses, kick, dt);
}

void CoupledSimulation::evaluate_fluid(double dt, double predict) {
  FluidSolver& fluid = *fluid_solver_;
  const Span<const BodyPose> pose = motion_.poses(clock_.time + dt, 0, 1);
  fluid.set_gravity(gravity_.at(clock_.time + dt));
  fluid.set_drive(fluid_, clock_.time + dt);
  fluid.set_step(clock_.step + 1);
  if (walls_.size() > 0) fluid.walls(fluid_, walls_, pose, two_way() ? dt : 0, motion_.moves());
  fluid.forces(fluid_, walls_, pose, dt);
  fluid.repel(fluid_, pose, predict, dt);
}

std::vector<StepLimit> CoupledSimulation::limits() {
  std::vector<StepLimit> out;
  const auto& t = config_.time;
  if (has_fluid()) {
    const double hs = fluid_solver_->half_range(fluid_extremes_), c = config_.fluid.c;
    out.push_back({"cfl", t.cfl * hs / (c + std::sqrt(fluid_extremes_.v2))});
    if (const double longest = fluid_solver_->friction_limit(fluid_extremes_); std::isfinite(longest))
      out.push_back({"viscous", longest});
    if (fluid_extremes_.acc2 > 0)
      out.push_back({"body", t.body * std::sqrt(hs / std::sqrt(fluid_extremes_.acc2))});
    if (coupled()) out.push_back({"drag", drag_limit_});
  }
  const double wall_speed = motion_.top_speed(clock_.time);
  double travel = std::numeric_limits<double>::infinity();
  if (!has_fluid())  // without fluid there is no other clock: a step is a handful of substeps
    for (const StepLimit& limit : body_limits()) out.push_back({limit.name, 20 * limit.seconds});
  if (has_grains()) {
    const double v = grain_watch_.speed;
    if (v > 0 && !held()) travel = 0.05 * config_.grain.d_min / v;
    if (!has_fluid()) out.push_back({"contact", 20 * solid_solver_->stable_dt(grain_watch_).seconds});
  }
  if (wall_speed > 0 && (has_fluid() || has_grains()))
    travel = std::min(travel, 0.1 * (has_fluid() ? config_.fluid.dx : config_.grain.d_min) / wall_speed);
  if (travel < t.end) out.push_back({"travel", travel});
  auto least =
      std::min_element(out.begin(), out.end(), [](auto& a, auto& b) { return a.seconds < b.seconds; });
  if (least != out.end()) least->binds = true;
  return out;
}

std::vector<Quantity> CoupledSimulation::numerical_viscosity() const {
  const FluidConfig& f = config_.fluid;
  if (!has_fluid() || f.mu == 0) return {};
  const double own = f.mu / f.rho0, sound = f.h() * f.c;
  const double artificial = config_.visc.alpha * sound / 20 / own;
  return {{"artificial_bulk", "-", artificial},
          {"artificial_bed", "-", two_way() ? artificial : 0},
          {"local_slip_bed", "-", two_way() ? coupling_->bed_viscosity(0.4, config_.grain.d_max) / f.mu : 0},
          {"density_diffusion", "-", config_.density.delta * sound / own}};
}

std::vector<StepLimit> CoupledSimulation::body_limits() const {
  return bodies_.limits(motion_.prescribed_speed(clock_.time));
}

void CoupledSimulation::sweep() {
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

void CoupledSimulation::settle(double longest, const std::function<void(double)>& progress) {
  if (!has_grains()) return;
  refresh(false, true);
  bodies_.settle(true);
  solid_solver_->evaluate(grains_, poses_now());
  const double rest = 1e-3 * std::sqrt(norm(config_.gravity) * config_.grain.d_max);  // rms speed, m/s
  double done = 0;
  for (int k = 0; done < longest; ++k) {
    grain_watch_ = solid_solver_->watch(grains_);
    const double v = grain_watch_.speed, tau = solid_solver_->stable_dt(grain_watch_).seconds;
    const double dt = std::min({20 * tau, v > 0 ? 0.05 * config_.grain.d_min / v : 20 * tau, longest - done});
    if (2 * (grain_watch_.displacement + 1.5 * v * dt) > solid_solver_->skin())
      solid_solver_->refresh(grains_, grain_grid_);
    const int n = std::max(1, int(std::ceil(dt / tau)));
    solid_solver_->advance(grains_, motion_.poses(clock_.time, 0, n), motion_.bodies(), dt, n, false, {}, 0);
    done += dt;
    if (k % 50 == 0) {
      progress(done);
      const auto totals = solid_solver_->totals(grains_);
      if (k > 0 && std::sqrt(2 * totals.kinetic / totals.mass) < rest) break;
    }
  }
  grains_.v.buffer().zero();
  grains_.omega.buffer().zero();
  solid_solver_->groups().stop();
  bodies_.settle(false);
}

void CoupledSimulation::refresh_if_needed(double dt) {
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

void CoupledSimulation::refresh(bool fluid, bool grains, double dt) {
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

/// The lists as they were when the checkpoint was written: built where x_list says.
void CoupledSimulation::restore_lists(const SavedState& state) {
  if (has_grains()) solid_solver_->load_contacts(grains_, grain_grid_, store_of(state, "contacts"));
  const auto swap_positions = [&] {
    fluid_.x.buffer().swap(fluid_.x_list.buffer());
    walls_.x.buffer().swap(walls_.x_list.buffer());
    walls_.mirrors.x.buffer().swap(walls_.mirrors.x_list.buffer());
  };
  if (has_fluid()) {
    swap_positions();
    fluid_solver_->relist(fluid_, walls_, true);
    swap_positions();
    fluid_solver_->pack(fluid_);
    fluid_solver_->pack(walls_);
  }
  if (coupled()) relist_coupling();
}

void CoupledSimulation::relist_coupling() {
  coupling_->rebuild_lists(fluid_, fluid_solver_->grid().view(), grains_, grain_grid_.view(),
                           (fluid_solver_->skin() + solid_solver_->skin()) / 2);
}

void CoupledSimulation::remove_cleared_bodies() {
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
