// Plane flows: what domain.two_d means for a case, and what it excludes.

#include <fmt/format.h>

#include <cmath>

#include "bedload/core/error.hpp"
#include "resolve.hpp"
#include "src/motion/survey.hpp"

namespace bedload {
namespace {

/// Whether what moves so stays in planes of x and z.
bool stays_in_plane(const MotionConfig& motion, double until) {
  const MotionLaw law(motion, until);
  for (const double t : survey_times(motion, until)) {
    const RigidMotion m = law.at(t);
    if (m.translation.y != 0 || m.v.y != 0) return false;
    if (std::hypot(m.omega.x, m.omega.z) > 1e-9 * norm(m.omega)) return false;
    if (std::abs(m.rotation.rotate({0, 1, 0}).y - 1) > 1e-9) return false;
  }
  return true;
}

}  // namespace

void resolve_plane(Config& c) {
  const double lo = c.domain.min.y, hi = c.domain.max.y;
  c.domain.periodic[1] = true;
  for (WallBody& body : c.wall.bodies)
    if (!body.solid.shape) body.min.y = lo, body.max.y = hi;
  for (FluidFill& fill : c.fluid.fills) fill.min.y = lo, fill.max.y = hi;
  for (OutletConfig& outlet : c.outlets)
    if (outlet.shape == "box") outlet.min.y = lo, outlet.max.y = hi;
  for (ProbeConfig& probe : c.out.probes) {
    probe.at.y = c.domain.middle();
    probe.min.y = lo, probe.max.y = hi;
  }
}

void check_plane(const Config& c, const Value& root) {
  const auto without = [&](bool present, const char* what) {
    if (present) reject(root, "domain.two_d", "true", fmt::format("must be false with {}", what));
  };
  without(c.grain.present, "[grain]; grains are spheres");
  without(!c.inlets.empty(), "[[inlet]]");
  without(c.wall.free_bodies() > 0, "free bodies");
  const auto flat = [&](const char* key, const Vec3d& v) {
    if (v.y != 0)
      reject(root, key, fmt::format("[{}, {}, {}]", v.x, v.y, v.z), "must be 0 along y with domain.two_d");
  };
  flat("gravity", c.gravity);
  flat("drive.f", c.drive.f);
  const auto moves = [&](const std::string& path, const MotionConfig& motion) {
    if (motion.moves() && !stays_in_plane(motion, c.time.end))
      reject(root, path + ".kind", fmt::format("\"{}\"", motion.kind),
             "must stay in the plane of x and z with domain.two_d: nothing along y, turning about y alone");
  };
  moves("frame.motion", c.frame.motion);
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i)
    moves(fmt::format("wall.body.{}.motion", i), c.wall.bodies[i].motion);
}

}  // namespace bedload
