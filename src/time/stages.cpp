// The stages of a step in the order of Stepper::step(), each with the fields that it uses.
// tests/time/stages_test.cpp checks these against what the stages do, docs/architecture.md lists them.

#include <algorithm>
#include <utility>

#include "bedload/parallel/rank_record.hpp"
#include "src/time/stepper.hpp"

namespace BL_SOLVER {
namespace {

Fields operator+(Fields a, const Fields& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
Fields& operator+=(Fields& a, const Fields& b) { return a = std::move(a) + b; }

Fields all_of(const Store& store) { return {store.fields().begin(), store.fields().end()}; }

Fields all_of(const std::vector<const Store*>& stores) {
  Fields out;
  for (const Store* store : stores) out += all_of(*store);
  return out;
}

/// What outlives a step, among others.
Fields lasting(Fields fields) {
  std::erase_if(fields, [](const FieldBase* f) { return f->lifetime == Lifetime::derived; });
  return fields;
}

Fields only_if(bool condition, Fields fields) { return condition ? std::move(fields) : Fields{}; }

/// What the case has of them, each once, without those in `other`.
Fields present(const Fields& fields, const Fields& other = {}) {
  const auto in = [](const Fields& all, const FieldBase* f) {
    return std::find(all.begin(), all.end(), f) != all.end();
  };
  Fields out;
  for (const FieldBase* f : fields)
    if (f->used() && !in(out, f) && !in(other, f)) out.push_back(f);
  return out;
}

template <class Particles>
const FieldBase* at_end(const Particles& p) {
  return &p.xp;
}
template <class Particles>
const FieldBase* at_mid(const Particles& p) {
  return &p.xp_mid;
}

}  // namespace

/// Begins a stage: starts the clock of its part, passes its fields to an observer, if there is one, and
/// brings what it reads near of the particles of other ranks. `fields` makes the list of fields, the same on
/// all ranks, whatever particles they have.
template <class MakeAccess>
void Stepper::begin(Step& now, std::string_view name, Part part, const MakeAccess& fields) {
  if (now.watch && part != now.timed) now.watch->lap(int(now.timed));
  now.timed = part;
  const bool observed = now.observer && *now.observer, several = Context::current().several();
  if (!observed && !several) return;
  if (several) rank_record().enter(name.data(), clock_.step);
  const Access all = fields();
  const Fields near = present(all.near);
  if (observed) {
    const Stage stage{name, part, {near, present(all.reads, near), present(all.writes)}};
    (*now.observer)(&stage);
  }
  if (!several || part == Part::lists) return;  // new lists come with new ghosts
  share(near);
  outdate(all.writes);
}

std::vector<Store*> Stepper::divided_stores() {
  std::vector<Store*> out;
  if (has_fluid()) out = {&fluid_, &walls_};
  if (has_grains()) out.push_back(&grains_);
  return out;
}

void Stepper::share(const Fields& fields) {
  for (Store* store : divided_stores())
    store->share(
        [&](const FieldBase& f) { return std::find(fields.begin(), fields.end(), &f) != fields.end(); });
}

void Stepper::share_all() {
  for (Store* store : divided_stores()) store->share([](const FieldBase&) { return true; });
}

void Stepper::outdate(const Fields& fields) {
  if (!Context::current().several()) return;
  for (Store* store : divided_stores())
    for (FieldBase* f : store->fields())
      if (std::find(fields.begin(), fields.end(), f) != fields.end()) f->set_shared(false);
}

std::vector<const Store*> Stepper::stores() const {
  std::vector<const Store*> out{&fluid_, &walls_, &walls_.mirrors, &grains_};
  for (const Store* store : bodies_.stores()) out.push_back(store);
  for (const Store* store : clump_stores()) out.push_back(store);
  return out;
}

Fields Stepper::moving_of_clumps() const {
  return has_grains() ? std::as_const(*solid_solver_).clumps().moving() : Fields{};
}

std::vector<const Store*> Stepper::clump_stores() const {
  if (!has_grains()) return {};
  const Clumps& clumps = std::as_const(*solid_solver_).clumps();
  return clumps.any() ? std::vector<const Store*>{&clumps.store()} : std::vector<const Store*>{};
}

// -- fields that several stages use ------------------------------------------------

/// What pair loops read of fluid.
Fields Stepper::fluid_in_pairs() const {
  const SmoothingLengths* const own = fluid_solver_->lengths();
  return Fields{&fluid_.xp, flux(), &fluid_.eos_state} + (own ? Fields{&own->h, &own->omega} : Fields{});
}

/// And of walls.
Fields Stepper::walls_in_pairs() const { return {&walls_.xp, &walls_.v_rho, &walls_.state}; }

/// What density, or forces in one pass with it, makes of the arrangement of particles.
Fields Stepper::fields_of_order() const {
  return Fields{&fluid_.exposure, &fluid_.exposure_next, &fluid_.correction, &fluid_.compression_rate} +
         only_if(fluid_solver_->shifts(), drift());
}

/// Velocities with which particles move in addition to their own.
Fields Stepper::drift() const { return only_if(fluid_solver_->drifts(), {&fluid_.drift}); }

/// Velocity and density that pair loops read.
const FieldBase* Stepper::flux() const {
  return fluid_.flux.used() ? static_cast<const FieldBase*>(&fluid_.flux) : &fluid_.v_rho;
}

// -- stages --------------------------------------------------------------------------

void Stepper::renew_lists(Step& now) {
  begin(now, "renew_lists", Part::lists, [&] {
    Access a;
    if (has_fluid()) {
      a.near += {&fluid_.x, &walls_.x, &walls_.mirrors.x};
      a.writes += all_of({&fluid_, &walls_, &walls_.mirrors});
      a.reads += {&fluid_.xp, &walls_.xp, &walls_.mirrors.xp};
    }
    if (has_grains()) {
      a.near += {&grains_.x};
      a.writes += all_of(grains_);
    }
    if (coupled()) a.reads += {&grains_.xp};
    a.reads += lasting(a.writes);
    return a;
  });
  refresh_if_needed(now.dt);
}

/// Fluid velocity, drag coefficient and porosity at grains [H] Eqs. 21-25.
void Stepper::interpolate(Step& now) {
  const FluidStore& f = fluid_;
  const GrainStore& g = grains_;
  begin(now, "interpolate", Part::coupling, [&] {
    Access a{
        .near = {&f.xp, &f.v_rho, &f.eos_state, &f.eps, &f.stress_acceleration, &f.solid_factor, &f.x, &g.xp},
        .reads = {&f.mass, &g.x, &g.v, &g.omega, &g.radius, &g.fluid_force, &g.id},
        .writes = {&g.fluid_velocity, &g.fluid_angular_velocity, &g.drag_coefficient, &g.rot_drag_coefficient,
                   &g.eps, &g.wetness, &g.x_before, &g.still, &g.by_slip, &g.lever_at_centre,
                   &g.lever_off_centre, &f.drag_rate}};
    if (std::as_const(*solid_solver_).clumps().share_drag()) a.near += std::exchange(a.reads, {});
    return a;
  });
  coupling_->gather(fluid_, grains_, poses_now(), now.dt, clock_.step);
}

/// Grains and free bodies, in substeps.
void Stepper::move_solids(Step& now) {
  const GrainStore& g = grains_;
  begin(now, "move_solids", Part::grains, [&] {
    Access a{.near = lasting(all_of(bodies_.stores())), .reads = {}, .writes = all_of(bodies_.stores())};
    if (!has_grains()) return a;
    const Fields rows = std::as_const(*solid_solver_).places_at_walls();
    const Fields own = std::as_const(*solid_solver_).fields_of_contacts() +
                       Fields{&g.force, &g.torque, &g.drag_force, &g.impulse, &g.spin_impulse};
    a.writes += own + rows + Fields{&g.x, &g.v, &g.omega} + moving_of_clumps();
    a.near +=
        lasting(Fields{&g.x, &g.v, &g.omega, &g.radius, &g.material, &g.id} + rows + all_of(clump_stores()));
    a.reads += lasting(own) + Fields{&g.fluid_velocity,   &g.fluid_angular_velocity,
                                     &g.drag_coefficient, &g.rot_drag_coefficient,
                                     &g.fluid_force,      &g.wetness};
    if (std::as_const(*solid_solver_).lubricates()) a.near += {&g.wetness};
    if (!clump_stores().empty()) a.near += std::exchange(a.reads, {});  // a clump moves by all its grains
    return a;
  });
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

/// Drag of the grains on the fluid.
void Stepper::react(Step& now) {
  const FluidStore& f = fluid_;
  const GrainStore& g = grains_;
  begin(now, "react", Part::coupling, [&] {
    return Access{.near = {&f.xp, &g.xp, &f.eos_state, &g.impulse, &g.spin_impulse, &g.fluid_velocity,
                           &g.fluid_angular_velocity, &g.drag_coefficient, &g.rot_drag_coefficient, &g.still,
                           &g.by_slip, &g.lever_at_centre, &g.lever_off_centre},
                  .reads = {&f.v_rho, &f.mass},
                  .writes = {&f.v_rho, &f.drag_kick, &f.reaction, &f.drag_rate, &g.reaction_impulse,
                             &g.reaction_force, &g.reaction_spin, &g.reaction_couple}};
  });
  coupling_->react(fluid_, grains_, now.dt);
}

/// Fluid particles that are too close rebound (visc.collision).
void Stepper::collide(Step& now) {
  begin(now, "collide", Part::fluid, [&] {
    return Access{.near = {&fluid_.xp, &fluid_.v_rho, &fluid_.mass},
                  .reads = {},
                  .writes = {&fluid_.v_rho, fluid_solver_->collisions()}};
  });
  fluid_solver_->collide(fluid_);
}

void Stepper::kick_drift(Step& now) {
  const FluidStore& f = fluid_;
  begin(now, "kick_drift", Part::fluid, [&] {
    return Access{.near = {},
                  .reads = drift() + Fields{&f.x, &f.xp, &f.v_rho, &f.acc, &f.reaction},
                  .writes = Fields{&f.x, &f.xp, &f.xp_mid, &f.v_rho} +
                            only_if(fluid_solver_->shear().acts(), {&f.flux})};
  });
  fluid_solver_->kick_drift(fluid_, now.dt - now.last_kick, now.dt, now.last_kick, two_way());
}

/// Kick, drift, density from former rates, and state (time.integrator = "ab3").
void Stepper::advance(Step& now) {
  const FluidStore& f = fluid_;
  begin(now, "advance", Part::fluid, [&] {
    return Access{
        .near = {},
        .reads = fluid_solver_->fields_of_forces() + drift() +
                 Fields{&f.x, &f.xp, &f.v_rho, &f.acc, &f.compression, &f.mass, &f.eps, &f.compression_rate},
        .writes = Fields{&f.x, &f.xp, &f.v_rho, &f.compression, &f.eos_state, &f.p_rho2} +
                  only_if(fluid_solver_->shear().acts(), {&f.flux})};
  });
  fluid_solver_->advance(fluid_, now.dt - now.last_kick, now.dt, now.last_kick);
}

/// Wall particles, and where they are in the middle of the step.
void Stepper::move_walls(Step& now) {
  const WallStore& w = walls_;
  const MirrorStore& m = w.mirrors;
  begin(now, "move_walls", Part::fluid, [&] {
    Access a{.near = all_of(bodies_.stores()), .reads = {}, .writes = {}};
    if (w.everywhere() == 0 || !motion_.moves()) return a;
    a.reads = {&w.x0, &w.body, &w.v_rho, &m.x0};
    a.writes = {&w.x, &w.v_rho, &w.xp, &w.xp_mid, &m.x, &m.xp};
    return a;
  });
  now.poses = motion_.poses_at(now.end);
  if (w.size() == 0 || !(motion_.moves() || w.xp_mid.used())) return;
  const double back = fluid_solver_->one_pass() ? 0 : now.last_kick;
  if (motion_.moves()) WallMotion::place(frame_, walls_, motion_.poses_in_step(now.end, back, now.dt));
  fluid_solver_->pack(walls_, back);
}

/// [H] Eq. 6, between fluid and grains that have both moved.
void Stepper::porosity(Step& now) {
  const FluidStore& f = fluid_;
  const GrainStore& g = grains_;
  begin(now, "porosity", Part::coupling, [&] {
    Access a{.near = {&f.xp, &g.x, &g.x_before, &g.v, &g.radius},
             .reads = {&f.x, &f.v_rho, &f.mass, &f.eos_state, &f.xp_mid},
             .writes = {&g.xp, &f.eps}};
    if (two_way())
      a.writes += {&f.solid_factor, &f.flux, &f.eos_state, &f.xp, &f.xp_mid, &f.viscosity, &f.grains_around};
    return a;
  });
  coupling_->porosity(fluid_, grains_, now.poses, now.dt);
}

/// By continuity, from positions and velocities in the middle of the step; or summed up.
void Stepper::density(Step& now) {
  const FluidStore& f = fluid_;
  const WallStore& w = walls_;
  begin(now, "density", Part::fluid, [&] {
    Fields near = fluid_in_pairs() + walls_in_pairs() + Fields{&f.exposure, &w.body};
    if (f.xp_mid.used()) std::replace(near.begin(), near.end(), at_end(f), at_mid(f));
    if (w.xp_mid.used()) std::replace(near.begin(), near.end(), at_end(w), at_mid(w));
    return Access{
        .near = near,
        .reads = drift() + Fields{&f.compression, &f.viscosity, &f.eps, &f.grains_around, &w.compression},
        .writes = fields_of_order() + Fields{&f.compression, &f.compression_next} +
                  only_if(fluid_solver_->freezes(), {&w.compression}) + Fields{&w.work}};
  });
  fluid_solver_->density(fluid_, walls_, now.poses, moment_, now.dt);
}

/// Pressure; velocity predicted for the end of the step.
void Stepper::fluid_state(Step& now) {
  const FluidStore& f = fluid_;
  begin(now, "fluid_state", Part::fluid, [&] {
    Access a{.near = {},
             .reads = {flux(), &f.x, &f.v_rho, &f.acc, &f.reaction, &f.compression, &f.mass, &f.eps,
                       &f.compression_rate},
             .writes = {flux(), &f.v_rho, &f.compression, &f.eos_state, &f.p_rho2}};
    if (const SmoothingLengths* own = fluid_solver_->lengths()) {
      a.reads += {&own->h_list};
      a.writes += {&own->h};
    }
    return a;
  });
  fluid_solver_->state(fluid_, now.last_kick, two_way());
}

/// Pressure and velocity of wall particles, from the fluid around them.
void Stepper::wall_state(Step& now) {
  const WallStore& w = walls_;
  begin(now, "wall_state", Part::fluid, [&] {
    return Access{
        .near = fluid_in_pairs() + Fields{&fluid_.drag_kick, &w.xp, &w.mirrors.xp},
        .reads = {&w.v_rho, &w.state, &w.no_slip, &w.compression, &w.x0, &w.x, &w.body, &w.mirrors.x},
        .writes = {&w.v_rho, &w.no_slip, &w.state, &w.compression}};
  });
  if (walls_.size() == 0) return;
  fluid_solver_->walls(fluid_, walls_, now.poses, Real3(gravity_.at(now.end)), two_way() ? now.dt : 0,
                       motion_.moves());
}

/// Pressure and viscosity between pairs of fluid and with walls, gravity and drive.
void Stepper::forces(Step& now) {
  const FluidStore& f = fluid_;
  const WallStore& w = walls_;
  begin(now, "forces", Part::fluid, [&] {
    const bool one_pass = fluid_solver_->one_pass();
    const Fields of_model = fluid_solver_->fields_of_forces();
    return Access{.near = fluid_in_pairs() + walls_in_pairs() + lasting(of_model) +
                          Fields{&f.p_rho2, &f.id, &f.viscosity, &w.no_slip, &w.body, &w.id} +
                          (one_pass ? Fields{&f.exposure} : Fields{&f.correction}) +
                          only_if(config_.eos.filter, {&f.compression}),
                  .reads = drift() + Fields{&f.x, &f.compression, &f.mass},
                  .writes = Fields{&f.stress_acceleration, &f.acc_next} + drift() + of_model +
                            only_if(one_pass, fields_of_order() + Fields{&f.compression}) +
                            only_if(fluid_solver_->lengths() || config_.eos.filter, {&f.p_rho2}) +
                            only_if(config_.eos.filter, {&f.eos_state})};
  });
  moment_ = moment(now.end, clock_.step + 1);
  fluid_solver_->forces(fluid_, walls_, now.poses, moment_, now.dt);
}

/// Push of wall surfaces and orifices on fluid that is too close.
void Stepper::repel(Step& now) {
  const FluidStore& f = fluid_;
  begin(now, "repel", Part::fluid, [&] {
    return Access{.near = {},
                  .reads = drift() + Fields{&f.x, &f.v_rho, &f.acc, &f.acc_next, &f.exposure},
                  .writes = drift() + Fields{&f.acc_next, &f.heading}};
  });
  fluid_solver_->repel(fluid_, now.poses, now.last_kick, now.dt);
}

/// Force of the fluid on free bodies.
void Stepper::load_bodies(Step& now) {
  const FluidStore& f = fluid_;
  const WallStore& w = walls_;
  begin(now, "load_bodies", Part::fluid, [&] {
    return Access{.near = all_of(bodies_.stores()) + fluid_in_pairs() + walls_in_pairs() +
                          fluid_solver_->fields_of_forces() +
                          Fields{&f.x, &f.mass, &f.acc, &f.acc_next, &f.heading, &f.exposure, &f.correction,
                                 &f.viscosity, &w.no_slip, &w.x0, &w.body},
                  .reads = {},
                  .writes = all_of(bodies_.stores())};
  });
  of_walls_.resize(walls_.size());
  if (walls_.size() > 0)
    fluid_solver_->wall_forces(fluid_, walls_, now.poses, moment_, 0, now.dt, wall_force_);
  const bool corrected = fluid_solver_->fits() && walls_.everywhere() > 0;
  if (corrected) fluid_solver_->correct_pressure(fluid_, walls_, now.poses, bodies_.pressure_correction());
  const WallRepulsion repulsion = fluid_solver_->repulsion(fluid_, now.poses, now.dt);
  bodies_.add_fluid_loads(walls_, wall_force_, corrected,
                          repulsion.walls.surfaces.size > 0 ? &repulsion : nullptr, fluid_, now.poses,
                          fluid_solver_->load_bounds(), now.last_kick, now.dt);
}

/// Velocity by the change of the acceleration over the step.
void Stepper::correct(Step& now) {
  const FluidStore& f = fluid_;
  begin(now, "correct", Part::fluid, [&] {
    Access a{.near = {},
             .reads = drift() + Fields{&f.x, &f.x_list, &f.half_skin, &f.v_rho, &f.acc, &f.acc_next,
                                       &f.compression, &f.eps, &f.viscosity},
             .writes = {&f.v_rho, &f.acc, &f.acc_next}};
    if (const SmoothingLengths* own = fluid_solver_->lengths())
      a.reads += {&own->h, &own->omega, &own->h_list};
    return a;
  });
  fluid_solver_->correct(fluid_, now.last_kick);
  corrected_ = now.last_kick;
}

/// The grains' part of the stress of the mixture: buoyancy.
void Stepper::push(Step& now) {
  const FluidStore& f = fluid_;
  const GrainStore& g = grains_;
  begin(now, "push", Part::coupling, [&] {
    const Fields clumps = moving_of_clumps();
    return Access{.near = all_of(clump_stores()) +
                          Fields{&f.xp, &g.xp, &f.stress_acceleration, &f.eos_state, &f.solid_factor} +
                          only_if(!clumps.empty(), {&g.v, &g.omega, &g.radius, &g.material, &g.fluid_force}),
                  .reads = {&g.v, &g.omega, &g.radius, &g.material, &g.fluid_force},
                  .writes = Fields{&g.fluid_force, &g.v} + only_if(!clumps.empty(), {&g.omega}) + clumps};
  });
  coupling_->push(fluid_, grains_, now.last_kick, now.held);
  solid_solver_->clumps().follow(grains_, {}, 0);
}

/// Advances the clock and looks for particles that broke down.
void Stepper::finish(Step& now) {
  const GrainStore& g = grains_;
  begin(now, "finish", Part::checks, [&] {
    return Access{.near = {},
                  .reads = all_of(bodies_.stores()) +
                           only_if(has_grains(), {&g.x, &g.v, &g.omega, &g.drag_coefficient}),
                  .writes = {}};
  });
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

}  // namespace BL_SOLVER
