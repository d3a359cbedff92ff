// What a simulation tells of its wall bodies, prescribed and free, and of rigid groups of grains.

#include <utility>

#include "src/time/coupled_simulation.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

/// Who pushes a body, and how.
using NamedLoads = std::vector<std::pair<const char*, LoadSum>>;

void add(std::vector<Quantity>& out, const std::string& name, const char* unit, const Vec3d& v) {
  for (int k = 0; k < 3; ++k) out.push_back({name + "_" + "xyz"[k], unit, v[k]});
}

std::vector<Quantity> rows_of(const RigidMotion& m, const NamedLoads& loads) {
  std::vector<Quantity> out;
  add(out, "centre", "m", m.origin());
  out.push_back({"rotation_w", "-", m.rotation.w});
  add(out, "rotation", "-", {m.rotation.x, m.rotation.y, m.rotation.z});
  add(out, "velocity", "m/s", m.v);
  add(out, "angular_velocity", "rad/s", m.omega);
  for (const auto& [by, load] : loads) {
    add(out, std::string("force_by_") + by, "N", load.force());
    add(out, std::string("torque_by_") + by, "N m", load.torque());
    out.push_back({std::string("power_by_") + by, "W", dot(load.force(), m.v) + dot(load.torque(), m.omega)});
  }
  return out;
}

}  // namespace

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
  if (!state_.has_fluid || state_.walls.size() == 0) return loads;
  const WallForces& forces = wall_forces();
  const Span<const BodyPose> poses = state_.poses_now();
  const WallRepulsion repulsion = stepper_.fluid().repulsion(state_.fluid, poses, state_.clock.last_dt);
  for (std::uint32_t b = 0; b < loads.pressure.size(); ++b) {
    const auto sum = [&](const Buffer<Vec3d>& force) {
      return reduce(state_.walls.owned(),
                    WallLoadReduction{{b, state_.walls.body, state_.walls.x0, poses.data}, force});
    };
    loads.pressure[b] = sum(forces.pressure);
    loads.friction[b] = sum(forces.friction);
    if (repulsion.walls.surfaces.size > 0)
      LoadSum::combine(loads.pressure[b],
                       reduce(state_.fluid.owned(), BodyRepulsion{repulsion, b, state_.fluid.x,
                                                                  state_.fluid.mass, state_.fluid.heading}));
  }
  return loads;
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

std::vector<Quantity> CoupledSimulation::body_force(const ProbeConfig& p) {
  std::vector<Quantity> out;
  const int body = wall_named(p.body);
  const Vec3d from =
      state_.frame.nearest_image(state_.motion.pose(body, state_.clock.time).origin() - p.about);
  const auto load = [&](const std::string& by, const LoadSum& sum) {
    add(out, "force_by_" + by, "N", sum.force());
    add(out, "torque_by_" + by, "N m", sum.torque() + cross(from, sum.force()));
  };
  const FluidLoads& loads = fluid_loads();
  const int place = state_.bodies.place_of(body);
  const LoadSum corrected = place >= 0 ? state_.bodies.correction(place) : LoadSum::zero();
  LoadSum by_fluid = loads.all(body);
  LoadSum::combine(by_fluid, corrected);
  load("fluid", by_fluid);
  load("grains", grain_load(body));
  add(out, "pressure_force", "N", loads.pressure[body].force() + corrected.force());
  add(out, "friction_force", "N", loads.friction[body].force());
  return out;
}

std::vector<Quantity> CoupledSimulation::body_state(int body) {
  NamedLoads loads;
  if (const int group = body - state_.motion.walls(); group >= 0) {
    const RigidGroups& groups = stepper_.solids().groups();
    if (state_.has_fluid)
      loads.push_back({"fluid", groups.by_fluid(group, state_.grains, state_.clock.last_dt)});
    loads.push_back({"contacts", groups.by_contacts(group, state_.grains)});
    return rows_of(groups.motion(group), loads);
  }
  BodyForces f;
  if (const int k = state_.bodies.place_of(body); k >= 0) {
    f = state_.bodies.forces(k);
  } else {
    f.fluid = fluid_loads().all(body);
    f.grains = grain_load(body);
    if (state_.bodies.any()) f.bodies = state_.bodies.contact_load(body);
  }
  if (state_.has_fluid) loads.push_back({"fluid", f.fluid});
  if (state_.has_grains) loads.push_back({"grains", f.grains});
  if (state_.bodies.any()) loads.push_back({"bodies", f.bodies});
  return rows_of(state_.motion.pose(body, state_.clock.time), loads);
}

}  // namespace bedload::inline BL_VARIANT
