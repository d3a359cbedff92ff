// What a simulation tells of its wall bodies, prescribed and free, and of rigid groups of grains.

#include <utility>

#include "src/time/coupled_simulation.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

/// Who pushes a body, and how.
using NamedLoads = std::vector<std::pair<const char*, LoadSum>>;

std::vector<Quantity> rows_of(const RigidMotion& m, const NamedLoads& loads) {
  std::vector<Quantity> out;
  const auto vec = [&](const std::string& name, const char* unit, const Vec3d& v) {
    for (int k = 0; k < 3; ++k) out.push_back({name + "_" + "xyz"[k], unit, v[k]});
  };
  vec("centre", "m", m.origin());
  out.push_back({"rotation_w", "-", m.rotation.w});
  vec("rotation", "-", {m.rotation.x, m.rotation.y, m.rotation.z});
  vec("velocity", "m/s", m.v);
  vec("angular_velocity", "rad/s", m.omega);
  for (const auto& [by, load] : loads) {
    vec(std::string("force_by_") + by, "N", load.force());
    vec(std::string("torque_by_") + by, "N m", load.torque());
    out.push_back({std::string("power_by_") + by, "W", dot(load.force(), m.v) + dot(load.torque(), m.omega)});
  }
  return out;
}

}  // namespace

std::vector<Quantity> CoupledSimulation::body_state(int body) {
  NamedLoads loads;
  if (const int group = body - motion_.walls(); group >= 0) {
    const RigidGroups& groups = solid_solver_->groups();
    if (has_fluid()) loads.push_back({"fluid", groups.by_fluid(group, grains_, clock_.last_dt)});
    loads.push_back({"contacts", groups.by_contacts(group, grains_)});
    return rows_of(groups.motion(group), loads);
  }
  if (loads_.step != clock_.step) {
    loads_ = {clock_.step, wall_loads(), {}};
    if (has_grains()) loads_.grains = solid_solver_->body_loads(grains_, poses_now());
  }
  BodyForces f;
  if (const int k = bodies_.place_of(body); k >= 0) {
    f = bodies_.forces(k);
  } else {
    f.fluid = loads_.fluid[body];
    if (has_grains()) f.grains = loads_.grains[body];
    if (bodies_.any()) f.bodies = bodies_.contact_load(body);
  }
  if (has_fluid()) loads.push_back({"fluid", f.fluid});
  if (has_grains()) loads.push_back({"grains", f.grains});
  if (bodies_.any()) loads.push_back({"bodies", f.bodies});
  return rows_of(motion_.pose(body, clock_.time), loads);
}

}  // namespace bedload::inline BL_VARIANT
