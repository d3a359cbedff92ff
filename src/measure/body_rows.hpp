#pragma once
// What the table of a body shows.

#include <string>
#include <utility>
#include <vector>

#include "bedload/core/rigid_motion.hpp"
#include "bedload/host_data.hpp"
#include "kernels/bodies/rigid_body.hpp"

namespace BL_SOLVER {

/// Loads on a body by their source.
using NamedLoads = std::vector<std::pair<const char*, LoadSum>>;

inline void add(std::vector<Quantity>& out, const std::string& name, const char* unit, const Vec3d& v) {
  for (int k = 0; k < 3; ++k) out.push_back({name + "_" + "xyz"[k], unit, v[k]});
}

inline std::vector<Quantity> rows_of(const RigidMotion& m, const NamedLoads& loads) {
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

}  // namespace BL_SOLVER
