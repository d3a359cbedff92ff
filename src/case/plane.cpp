// Plane flows: what domain.two_d means for a case, and what it excludes.

#include <fmt/format.h>

#include <cmath>

#include "bedload/core/error.hpp"
#include "bedload/geometry/shape.hpp"
#include "bedload/geometry/shape_sampling.hpp"
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

std::string to_text(const Vec3d& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

void must_be_flat(const Value& root, const std::string& path, const Vec3d& v) {
  if (v.y != 0) reject(root, path, to_text(v), "must be 0 along y with domain.two_d");
}

/// Half the orifice in the plane, the other half along y through the whole slab.
void run_through(InletConfig& inlet, double thickness, const Value& root, const std::string& path) {
  if (inlet.shape != OrificeShape::rectangle)
    reject(root, path + "shape", fmt::format("\"{}\"", inlet.shape.name()),
           "must be \"rectangle\" with domain.two_d");
  must_be_flat(root, path + "direction", inlet.direction);
  if (inlet.half_a.y != 0) std::swap(inlet.half_a, inlet.half_b);
  if (inlet.half_a.y != 0 || inlet.half_b.x != 0 || inlet.half_b.z != 0)
    reject(root, path + "half_b", to_text(inlet.half_b),
           "must lie along y and half_a in the plane of x and z with domain.two_d, or the other way round");
  inlet.half_b.y = thickness / 2;
}

/// The keys of a body that moves in x and z and turns about y.
void keep_in_plane(FreeConfig& f, double middle, const Value& root, const std::string& path) {
  must_be_flat(root, path + "velocity", f.velocity);
  if (f.spin.x != 0 || f.spin.z != 0)
    reject(root, path + "spin", to_text(f.spin), "must be 0 along x and z with domain.two_d");
  if (f.axis.y != 0 && (f.axis.x != 0 || f.axis.z != 0))
    reject(root, path + "axis", to_text(f.axis),
           "must lie along y or in the plane of x and z with domain.two_d");
  if (f.point.size() == 3) f.point[1] = middle;
  for (BodyBall& ball : f.balls) ball.centre.y = middle;
}

/// Whether the surface stands at right angles to the plane wherever that cuts it.
bool stands_upright(const ShapePtr& shape, const DomainConfig& domain) {
  const Bounds bounds = shape->bounds();
  const double spacing = std::hypot(bounds.max.x - bounds.min.x, bounds.max.z - bounds.min.z) / 60;
  for (const Vec3d& x : sample_solid(shape, spacing, spacing, domain))
    if (std::abs(shape->nearest({x.x, domain.middle(), x.z}).normal.y) > 1e-3) return false;
  return true;
}

}  // namespace

void resolve_plane(Config& c, const Value& root) {
  const double lo = c.domain.min.y, hi = c.domain.max.y;
  c.domain.periodic[1] = true;
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
    WallBody& body = c.wall.bodies[i];
    if (!body.solid.shape) body.min.y = lo, body.max.y = hi;
    if (body.free.present)
      keep_in_plane(body.free, c.domain.middle(), root, fmt::format("wall.body.{}.free.", i));
  }
  for (FluidFill& fill : c.fluid.fills) fill.min.y = lo, fill.max.y = hi;
  for (std::size_t i = 0; i < c.inlets.size(); ++i) {
    c.inlets[i].centre.y = c.domain.middle();
    run_through(c.inlets[i], hi - lo, root, fmt::format("inlet.{}.", i));
  }
  for (OutletConfig& outlet : c.outlets)
    if (outlet.shape == OutletShape::box) outlet.min.y = lo, outlet.max.y = hi;
  for (ProbeConfig& probe : c.out.probes) {
    probe.at.y = c.domain.middle();
    for (Vec3d& span : probe.span) span.y = 0;
    probe.min.y = lo, probe.max.y = hi;
  }
}

void check_plane(const Config& c, const Value& root) {
  if (c.grain.present) reject(root, "domain.two_d", "true", "must be false with [grain]; grains are spheres");
  must_be_flat(root, "gravity", c.gravity);
  must_be_flat(root, "drive.f", c.drive.f);
  const auto moves = [&](const std::string& path, const MotionConfig& motion) {
    if (motion.moves() && !stays_in_plane(motion, c.time.end))
      reject(root, path + ".kind", fmt::format("\"{}\"", motion.kind.name()),
             "must stay in the plane of x and z with domain.two_d: nothing along y, turning about y alone");
  };
  moves("frame.motion", c.frame.motion);
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
    const WallBody& body = c.wall.bodies[i];
    moves(fmt::format("wall.body.{}.motion", i), body.motion);
    // a free body meets surfaces as they are in space
    if (c.wall.free_bodies() > 0 && body.solid.shape && !stands_upright(body.solid.shape, c.domain))
      reject(root, fmt::format("wall.body.{}.shape", i), fmt::format("\"{}\"", body.shape.name()),
             "must stand at right angles to the plane of x and z, and reach well beyond it, with free bodies "
             "and domain.two_d");
  }
}

}  // namespace bedload
