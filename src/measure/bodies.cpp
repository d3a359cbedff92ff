// What a simulation tells of its wall bodies, prescribed and free.

#include "src/time/coupled_simulation.hpp"

namespace bedload::inline BL_VARIANT {

std::vector<Quantity> CoupledSimulation::body_state(int body) {
  if (loads_.step != clock_.step) {
    loads_ = {clock_.step, wall_loads({}), {}};
    if (has_grains()) loads_.grains = solid_solver_->body_loads(grains_, poses_now());
  }
  const BodyPose pose = motion_.pose(body, clock_.time);
  const Vec3d at = pose.centre + pose.translation;
  BodyForces f;
  if (const int k = bodies_.place_of(body); k >= 0) {
    f = bodies_.forces(k);
  } else {
    f.fluid_force = loads_.fluid[2 * body];
    f.fluid_torque = loads_.fluid[2 * body + 1] - cross(at, f.fluid_force);
    if (has_grains()) f.grain_force = loads_.grains[body].force, f.grain_torque = loads_.grains[body].torque;
    if (bodies_.any()) {
      const LoadSum load = bodies_.contact_load(body);
      f.contact_force = load.force(), f.contact_torque = load.torque();
    }
  }

  std::vector<Quantity> out;
  const auto vec = [&](const std::string& name, const char* unit, const Vec3d& v) {
    for (int k = 0; k < 3; ++k) out.push_back({name + "_" + "xyz"[k], unit, v[k]});
  };
  vec("centre", "m", at);
  const Quat<double>& q = pose.rotation;
  out.push_back({"rotation_w", "-", q.w});
  vec("rotation", "-", {q.x, q.y, q.z});
  vec("velocity", "m/s", pose.v);
  vec("angular_velocity", "rad/s", pose.omega);
  const auto load = [&](const std::string& by, const Vec3d& force, const Vec3d& torque) {
    vec("force_by_" + by, "N", force);
    vec("torque_by_" + by, "N m", torque);
    out.push_back({"power_by_" + by, "W", dot(force, pose.v) + dot(torque, pose.omega)});
  };
  if (has_fluid()) load("fluid", f.fluid_force, f.fluid_torque);
  if (has_grains()) load("grains", f.grain_force, f.grain_torque);
  if (bodies_.any()) load("bodies", f.contact_force, f.contact_torque);
  return out;
}

}  // namespace bedload::inline BL_VARIANT
