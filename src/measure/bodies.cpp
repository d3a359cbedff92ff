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
  if (wall_forces_.due(clock_.step))
    fluid_solver_->wall_forces(fluid_, walls_, poses_now(), clock_.last_dt, wall_forces_.value.pressure,
                               wall_forces_.value.friction);
  return wall_forces_.value;
}

const CoupledSimulation::FluidLoads& CoupledSimulation::fluid_loads() {
  FluidLoads& loads = fluid_loads_.value;
  if (!fluid_loads_.due(clock_.step)) return loads;
  loads.pressure.assign(motion_.bodies(), LoadSum::zero());
  loads.friction = loads.pressure;
  if (!has_fluid() || walls_.size() == 0) return loads;
  const WallForces& forces = wall_forces();
  const Span<const BodyPose> poses = poses_now();
  const WallRepulsion repulsion = fluid_solver_->repulsion(poses, clock_.last_dt);
  for (std::uint32_t b = 0; b < loads.pressure.size(); ++b) {
    const auto sum = [&](const Buffer<Vec3d>& force) {
      return reduce(walls_.owned(), WallLoadReduction{b, walls_.body, walls_.x0, force, poses.data});
    };
    loads.pressure[b] = sum(forces.pressure);
    loads.friction[b] = sum(forces.friction);
    if (repulsion.walls.surfaces.size > 0)
      LoadSum::combine(loads.pressure[b], reduce(fluid_.owned(), BodyRepulsion{repulsion, b, fluid_.x,
                                                                               fluid_.mass, fluid_.heading}));
  }
  return loads;
}

LoadSum CoupledSimulation::grain_load(int body) {
  if (!has_grains()) return LoadSum::zero();
  if (grain_loads_.due(clock_.step)) grain_loads_.value = solid_solver_->body_loads(grains_, poses_now());
  return grain_loads_.value[body];
}

int CoupledSimulation::wall_named(const std::string& name) const {
  int body = 0;
  for (int b = 0; b < motion_.walls(); ++b)
    if (config_.wall.bodies[b].name == name) body = b;
  return body;
}

std::vector<Quantity> CoupledSimulation::body_force(const ProbeConfig& p) {
  std::vector<Quantity> out;
  const int body = wall_named(p.body);
  const Vec3d from = frame_.nearest_image(motion_.pose(body, clock_.time).origin() - p.about);
  const auto load = [&](const std::string& by, const LoadSum& sum) {
    add(out, "force_by_" + by, "N", sum.force());
    add(out, "torque_by_" + by, "N m", sum.torque() + cross(from, sum.force()));
  };
  const FluidLoads& loads = fluid_loads();
  load("fluid", loads.all(body));
  load("grains", grain_load(body));
  add(out, "pressure_force", "N", loads.pressure[body].force());
  add(out, "friction_force", "N", loads.friction[body].force());
  return out;
}

std::vector<Quantity> CoupledSimulation::body_state(int body) {
  NamedLoads loads;
  if (const int group = body - motion_.walls(); group >= 0) {
    const RigidGroups& groups = solid_solver_->groups();
    if (has_fluid()) loads.push_back({"fluid", groups.by_fluid(group, grains_, clock_.last_dt)});
    loads.push_back({"contacts", groups.by_contacts(group, grains_)});
    return rows_of(groups.motion(group), loads);
  }
  BodyForces f;
  if (const int k = bodies_.place_of(body); k >= 0) {
    f = bodies_.forces(k);
  } else {
    f.fluid = fluid_loads().all(body);
    f.grains = grain_load(body);
    if (bodies_.any()) f.bodies = bodies_.contact_load(body);
  }
  if (has_fluid()) loads.push_back({"fluid", f.fluid});
  if (has_grains()) loads.push_back({"grains", f.grains});
  if (bodies_.any()) loads.push_back({"bodies", f.bodies});
  return rows_of(motion_.pose(body, clock_.time), loads);
}

}  // namespace bedload::inline BL_VARIANT
