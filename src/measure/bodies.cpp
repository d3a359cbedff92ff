// Output of wall bodies, prescribed and free, and of rigid groups of grains, which are the first clumps.

#include <utility>

#include "bedload/parallel/reductions.hpp"
#include "src/measure/body_rows.hpp"
#include "src/time/coupled_simulation.hpp"

namespace BL_SOLVER {
const CoupledSimulation::WallForces& CoupledSimulation::wall_forces() {
  if (wall_forces_.due(state_.clock.step))
    stepper_.fluid().wall_forces(state_.fluid, state_.walls, state_.poses_now(), stepper_.moment(),
                                 stepper_.corrected(), state_.clock.last_dt, wall_forces_.value.pressure,
                                 wall_forces_.value.friction);
  return wall_forces_.value;
}

const CoupledSimulation::FluidLoads& CoupledSimulation::fluid_loads() {
  FluidLoads& loads = fluid_loads_.value;
  if (!fluid_loads_.due(state_.clock.step)) return loads;
  loads.pressure.assign(state_.motion.bodies(), LoadSum::zero());
  loads.friction = loads.pressure;
  if (!state_.has_fluid || state_.walls.everywhere() == 0) return loads;
  const WallForces& forces = wall_forces();
  const Span<const BodyPose> poses = state_.poses_now();
  const WallRepulsion repulsion = stepper_.fluid().repulsion(state_.fluid, poses, state_.clock.last_dt);
  for (std::uint32_t b = 0; b < loads.pressure.size(); ++b) {
    const auto sum = [&](const Buffer<Vec3d>& force) {
      return total(state_.walls.owned(), WallLoadReduction{particles_of(b, state_.walls, poses), force});
    };
    loads.pressure[b] = sum(forces.pressure);
    loads.friction[b] = sum(forces.friction);
    if (repulsion.walls.surfaces.size > 0)
      LoadSum::combine(loads.pressure[b],
                       total(state_.fluid.owned(), BodyRepulsion{repulsion, b, state_.fluid.x,
                                                                 state_.fluid.mass, state_.fluid.heading}));
  }
  return loads;
}

Span<const LoadSum> CoupledSimulation::held_corrections() {
  if (!state_.has_fluid || state_.walls.everywhere() == 0 || !stepper_.fluid().fits()) return {};
  std::unique_ptr<PressureCorrection>& held = held_.value;
  if (!held) held = std::make_unique<PressureCorrection>(held_solids(config_), config_.domain.two_d ? 2 : 3);
  if (!held->any()) return {};
  if (held_.due(state_.clock.step))
    stepper_.fluid().correct_pressure(state_.fluid, state_.walls, state_.poses_now(), *held);
  return held->added();
}

LoadSum CoupledSimulation::correction(int body) {
  if (const int place = state_.bodies.place_of(body); place >= 0) return state_.bodies.correction(place);
  LoadSum load = LoadSum::zero();
  if (const Span<const LoadSum> all = held_corrections()) copy_to_host(&load, &all[body], sizeof load);
  return load;
}

LoadSum CoupledSimulation::grain_load(int body) {
  if (!state_.has_grains) return LoadSum::zero();
  if (grain_loads_.due(state_.clock.step))
    grain_loads_.value = stepper_.solids().body_loads(state_.grains, state_.poses_now());
  return grain_loads_.value[body];
}

int CoupledSimulation::wall_named(const std::string& name) const {
  int body = 0;
  for (int b = 0; b < state_.motion.walls(); ++b)
    if (config_.wall.bodies[b].name == name) body = b;
  return body;
}

BodyActions CoupledSimulation::actions_on(int body, const Vec3d& about) {
  const RigidMotion motion = state_.motion.pose(body, state_.clock.time);
  const Vec3d from = state_.frame.nearest_image(motion.origin() - about);
  const FluidLoads& loads = fluid_loads();
  const int place = state_.bodies.place_of(body);
  LoadSum by[kActionParts] = {loads.pressure[body], loads.friction[body],
                              place >= 0 ? state_.bodies.forces(place).grains : grain_load(body),
                              state_.bodies.any() ? body_load(body) : LoadSum::zero()};
  LoadSum::combine(by[kByPressure], correction(body));
  BodyActions out;
  for (int k = 0; k < kActionParts; ++k) out[k] = BodyAction::of(by[k], from, motion.v, motion.omega);
  return out;
}

LoadSum CoupledSimulation::body_load(int body) {
  const int place = state_.bodies.place_of(body);
  return place >= 0 ? state_.bodies.forces(place).bodies : state_.bodies.contact_load(body);
}

std::vector<Quantity> CoupledSimulation::body_force(const ProbeConfig& p) {
  const int meter = p.sample == ForceSample::mean ? meters_.place_of(p.name) : -1;
  const BodyActions by =
      meter >= 0 ? meters_.mean(meter, state_.clock.time) : actions_on(wall_named(p.body), p.about);
  BodyAction fluid = by[kByPressure];
  fluid.add(1, by[kByFriction]);
  std::vector<std::pair<const char*, BodyAction>> all{{"by_fluid", fluid}, {"by_grains", by[kByGrains]}};
  if (state_.bodies.any()) all.emplace_back("by_bodies", by[kByBodies]);
  BodyAction total{};
  for (const auto& [name, action] : all) total.add(1, action);

  std::vector<Quantity> out;
  const auto load = [&](const std::string& name, const BodyAction& action) {
    add(out, "force_" + name, "N", action.force());
    add(out, "torque_" + name, "N m", action.torque());
  };
  load("by_fluid", fluid);
  load("by_grains", by[kByGrains]);
  add(out, "pressure_force", "N", by[kByPressure].force());
  add(out, "friction_force", "N", by[kByFriction].force());
  if (state_.bodies.any()) load("by_bodies", by[kByBodies]);
  load("total", total);
  all.emplace_back("total", total);
  for (const auto& [name, action] : all) out.push_back({std::string("power_") + name, "W", action.power()});
  return out;
}

void CoupledSimulation::add_meters() {
  for (const ProbeConfig& p : config_.out.probes)
    if (p.type == ProbeType::force && p.sample == ForceSample::mean) {
      const int body = wall_named(p.body);
      meters_.add(p, body, state_.bodies.place_of(body));
    } else if (p.type == ProbeType::field && p.sample_every > 0) {
      field_means_.add(p.name, p.sample_every);
    }
}

void CoupledSimulation::begin_meters(const SavedState* saved) {
  if (!meters_.any()) return;
  stepper_.share_all();
  if (state_.has_grains) stepper_.solids().substep_loads().record_on(meters_.bodies());
  state_.bodies.substep_loads().record_on(meters_.bodies());
  for (const ProbeConfig& p : config_.out.probes)
    if (const int m = meters_.place_of(p.name); m >= 0 && !(saved && meters_.load(m, *saved)))
      meters_.begin(m, state_.clock.time, actions_on(wall_named(p.body), p.about));
}

/// Without waiting for the device, or for other ranks alone.
void CoupledSimulation::advance_meters(double dt) {
  const std::size_t n = meters_.bodies().size();
  for (Buffer<LoadSum>* loads : {&meter_pressure_, &meter_friction_, &meter_repulsion_})
    loads->resize(n), loads->zero();
  const Span<const BodyPose> poses = state_.poses_now();
  SumActionsPass pass{};
  if (state_.has_fluid && state_.walls.everywhere() > 0) {
    stepper_.share_all();
    const WallForces& forces = wall_forces();
    const WallRepulsion repulsion = stepper_.fluid().repulsion(state_.fluid, poses, dt);
    const auto bounds = stepper_.fluid().load_bounds().load();
    for (std::size_t m = 0; m < n; ++m) {
      const std::uint32_t b = meters_.bodies()[m];
      const auto sum = [&](LoadSum* out, const Buffer<Vec3d>& force) {
        total_into(out, state_.walls.owned(), WallLoadReduction{particles_of(b, state_.walls, poses), force},
                   bounds);
      };
      sum(meter_pressure_.data() + m, forces.pressure);
      sum(meter_friction_.data() + m, forces.friction);
      if (repulsion.walls.surfaces.size > 0)
        total_into(meter_repulsion_.data() + m, state_.fluid.owned(),
                   BodyRepulsion{repulsion, b, state_.fluid.x, state_.fluid.mass, state_.fluid.heading},
                   bounds);
    }
    for_each({0, Index(n)}, AddLoadsPass{meter_repulsion_, meter_pressure_});
    pass.corrections = held_corrections();
    pass.last_kick = stepper_.corrected();
    pass.first_kick = dt - pass.last_kick;
    if (state_.bodies.any())
      pass.free_force = state_.bodies.fluid_force(), pass.free_torque = state_.bodies.fluid_torque();
  }
  pass.frame = state_.frame;
  pass.now = poses.data;
  pass.by_pressure = meter_pressure_, pass.by_friction = meter_friction_;
  if (const Span<const BodyPose> rows = stepper_.substep_poses(); rows) {
    pass.rows = rows.data;
    pass.row_size = state_.motion.bodies();
    pass.substeps = int(rows.size) / pass.row_size - 1;
    pass.substep = dt / pass.substeps;
    if (state_.has_grains) pass.by_grains = stepper_.solids().substep_loads().loads();
    if (state_.bodies.any()) pass.by_bodies = state_.bodies.substep_loads().loads();
  }
  meters_.advance(pass);
}

void CoupledSimulation::begin_interval(const ProbeConfig& probe) {
  if (const int m = meters_.place_of(probe.name); m >= 0) meters_.begin_interval(m, state_.clock.time);
  field_means_.begin_interval(probe.name, state_.clock.time);
}

std::vector<Quantity> CoupledSimulation::body_state(int body) {
  stepper_.share_all();
  NamedLoads loads;
  if (const int group = body - state_.motion.walls(); group >= 0) {
    const Clumps& clumps = stepper_.solids().clumps();
    if (state_.has_fluid)
      loads.push_back({"fluid", clumps.by_fluid(group, state_.grains, state_.clock.last_dt)});
    loads.push_back({"contacts", clumps.by_contacts(group, state_.grains)});
    return rows_of(clumps.motion(group), loads);
  }
  BodyForces f;
  if (const int k = state_.bodies.place_of(body); k >= 0) {
    f = state_.bodies.forces(k);
  } else {
    f.fluid = fluid_loads().all(body);
    LoadSum::combine(f.fluid, correction(body));
    f.grains = grain_load(body);
    if (state_.bodies.any()) f.bodies = body_load(body);
  }
  if (state_.has_fluid) loads.push_back({"fluid", f.fluid});
  if (state_.has_grains) loads.push_back({"grains", f.grains});
  if (state_.bodies.any()) loads.push_back({"bodies", f.bodies});
  const BodyPose pose = state_.motion.pose(body, state_.clock.time);
  std::vector<Quantity> out = rows_of(pose, loads);
  if (config_.wall.bodies[body].motion.remove_when_clear)
    out.push_back({"present", "-", pose.present ? 1.0 : 0.0});
  return out;
}

}  // namespace BL_SOLVER
