// Shapes, wall bodies and motions against the rest of a case.

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bedload/geometry/body.hpp"
#include "bedload/geometry/sampling.hpp"
#include "bedload/geometry/shape.hpp"
#include "checks.hpp"
#include "src/geometry/wall_faces.hpp"

namespace bedload {

void Checks::meshes() const {
  const auto largest = [](const Vec3d& side) { return std::max({side.x, side.y, side.z}); };
  const Vec3d extent = c.domain.max - c.domain.min;
  for (const ShapeConfig& shape : c.shapes) {
    if (shape.kind != ShapeKind::mesh && shape.kind != ShapeKind::terrain) continue;
    const Bounds bounds = shape.solid.shape->bounds();
    const Vec3d side = bounds.max - bounds.min;
    const double times = largest(side) / largest(extent);
    if (times > 20 || times < 1e-3)
      warn(
          "shape \"{}\": its mesh is {:.3g} x {:.3g} x {:.3g} m large, the domain {:.3g} x {:.3g} x {:.3g} "
          "m; does it need another scale?",
          shape.name, side.x, side.y, side.z, extent.x, extent.y, extent.z);
  }
}

void Checks::walls() const {
  std::set<std::string> names;
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
    const WallBody& body = c.wall.bodies[i];
    const std::string path = fmt::format("wall.body.{}", i);
    file_name(path + ".name", body.name);
    if (!names.insert(body.name).second)
      fail(path + ".name", quoted(body.name), "must differ from other bodies'");
    for (const int fill : c.grain.rigid_fills())
      if (body.name == fmt::format("grain_fill_{}", fill + 1))
        fail(path + ".name", quoted(body.name),
             fmt::format("must differ from that of the table of grain.fill {}, a rigid group", fill + 1));
    if (body.shape != WallShape::plane) box(path, body.min, body.max);
    if (body.solid.shape) within_period(path + ".shape", body);
    if (body.shape == WallShape::plane) repeats(path + ".normal", body);
    countable(path + ".shape", body);
    if (!body.moves()) met(body), rim(body);
    if (body.free.present) touchable(path, body);
  }
  if (!c.fluid.present) return;
  const Value* given = root_.find("wall");  // a resolved case gives both keys
  if (c.wall.energy_consistent && !c.wall.suction && given && given->find("energy_consistent") &&
      !given->find("suction"))
    warn("wall.energy_consistent = true: not used, since wall.suction = false");
  const double dx = c.fluid.dx;
  if (c.wall.dx < 0.25 * dx * (1 - 1e-9) || c.wall.dx > dx * (1 + 1e-9))
    fail("wall.dx", c.wall.dx,
         fmt::format("must be within {}..{}; a quarter of fluid.dx to fluid.dx", dx / 4, dx));
  if (c.wall.rep_r0 > dx * (1 + 1e-9))
    fail("wall.rep_r0", c.wall.rep_r0, fmt::format("must be at most fluid.dx = {}", dx));
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
    const WallBody& body = c.wall.bodies[i];
    const double spacing = c.wall.spacing(body), most = body.single_layer() ? dx / 2 : dx;
    if (spacing < 0.25 * dx * (1 - 1e-9) || spacing > most * (1 + 1e-9))
      fail(fmt::format("wall.body.{}.dx", i), spacing,
           fmt::format("must be within {}..{}; a quarter of fluid.dx to {}", dx / 4, most,
                       body.single_layer() ? "half of it for a single_layer" : "fluid.dx"));
    const double r0 = c.wall.layer_r0;
    if (body.single_layer() && (r0 < spacing * (1 - 1e-9) || r0 > dx * (1 + 1e-9)))
      fail("wall.layer_r0", r0,
           fmt::format("must be within {}..{}; the spacing of wall.body \"{}\" to fluid.dx", spacing, dx,
                       body.name));
  }
}

void Checks::countable(const std::string& path, const WallBody& body) const {
  if (!c.fluid.present || body.shape == WallShape::plane || !body.stops_fluid()) return;
  const Vec3d side = body.max - body.min;
  const double spacing = c.wall.spacing(body);
  const double layer = std::max({side.x * side.y, side.y * side.z, side.z * side.x}) / (spacing * spacing);
  if (layer >= 2147483648.0)
    fail(
        path, quoted(body.shape.name()),
        fmt::format("must be smaller; at {:.3g} x {:.3g} x {:.3g} m a layer of wall particles {} m apart has "
                    "{:.3g} of at most 2147483647",
                    side.x, side.y, side.z, spacing, layer));
}

void Checks::touchable(const std::string& path, const WallBody& body) const {
  const double spacing = body.free.contact_spacing;
  if (!(spacing > 0) || (body.shape != WallShape::box && !body.solid.shape)) return;
  constexpr double kMost = 1e6;
  const double balls = expected_places(body, spacing, spacing, c.domain);
  if (balls > kMost)
    fail(path + ".free.contact_spacing", spacing,
         fmt::format(
             "must be at least about {:.2g} m: balls so far apart make {:.2g} on the surface of \"{}\", "
             "more than 1000000",
             spacing * std::pow(balls / kMost, c.domain.two_d ? 1.0 : 0.5), balls, body.name));
}

void Checks::met(const WallBody& body) const {
  const Vec3d &lo = c.domain.min, &hi = c.domain.max;
  const double rounding = 1e-9 * norm(hi - lo);
  if (body.shape == WallShape::plane) {
    double nearest = 1e300;  // of the domain's corners, before the plane
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d at{corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z};
      nearest = std::min(nearest, dot(at - body.point, body.normal));
    }
    if (nearest > rounding)
      warn("wall.body \"{}\" lies {:.3g} m outside the domain, so particles leave before they meet it",
           body.name, nearest);
  } else if (body.shape == WallShape::tank) {
    for (int face = 0; face < 6; ++face) {
      const int k = face / 2;
      const double beyond = face % 2 ? body.max[k] - hi[k] : lo[k] - body.min[k];
      if (body.faces[face] && !c.domain.periodic[k] && beyond > rounding)
        warn(
            "face {} of wall.body \"{}\" lies {:.3g} m outside the domain, so particles leave before they "
            "meet it",
            kFaces[face], body.name, beyond);
    }
  } else if (!in_sight(body.min, body.max)) {
    warn("wall.body \"{}\" lies outside the domain, so particles leave before they meet it", body.name);
  }
}

void Checks::rim(const WallBody& body) const {
  const double g = norm(c.gravity);
  if (!c.fluid.present || body.shape != WallShape::tank || g == 0 || c.fluid.fills.empty()) return;
  for (const OutletConfig& outlet : c.outlets)
    if (outlet.takes(Phase::fluid)) return;
  for (int k = 0; k < 3; ++k) {
    const bool up = c.gravity[k] < 0;
    const std::size_t top = 2 * std::size_t(k) + up;
    if (std::abs(c.gravity[k]) < 0.9 * g || body.faces[top] || c.domain.periodic[k]) continue;
    if (c.domain.reflect.slip[top] || c.domain.reflect.no_slip[top]) continue;
    const double edge = up ? c.domain.max[k] : -c.domain.min[k], rim = up ? body.max[k] : -body.min[k];
    double floor = 1e300;
    for (const FluidFill& fill : c.fluid.fills) floor = std::min(floor, up ? fill.min[k] : -fill.max[k]);
    const double depths = (edge - floor) / c.fluid.depth;
    if (edge > rim + 0.5 * c.fluid.dx || depths > 3 || still_in(body, k)) continue;  // jets climb to three
    warn(
        "the domain ends at {} = {:g} m, at the rim of wall.body \"{}\" and {:.2g} times the fluid's depth "
        "above its floor: splash leaves over it and is lost, and the run ends with exit code 4 where that is "
        "more "
        "than run.max_lost; make both higher, or close it: face \"{}\" of the tank, or domain.reflect.slip",
        "xyz"[k], up ? edge : -edge, body.name, depths, kFaces[top]);
  }
}

bool Checks::still_in(const WallBody& tank, int up_axis) const {
  if (c.frame.motion.moves() || !c.inlets.empty() || norm(c.drive.f) > 0 || c.drive.pulls()) return false;
  for (const WallBody& body : c.wall.bodies)
    if (body.moves() || norm(body.surface_velocity) > 0) return false;
  for (const FluidFill& fill : c.fluid.fills)
    if (fill.velocity != FluidFill().velocity) return false;
  for (int k = 0; k < 3; ++k) {
    if (k == up_axis || c.domain.periodic[k] || c.domain.flat(k)) continue;
    // each fill spans the tank, as layers on each other do
    for (const FluidFill& fill : c.fluid.fills)
      if (fill.min[k] > tank.min[k] + c.fluid.dx || fill.max[k] < tank.max[k] - c.fluid.dx) return false;
  }
  return true;
}

void Checks::within_period(const std::string& path, const WallBody& body) const {
  for (int k = 0; k < 3; ++k) {
    const double lo = c.domain.min[k], hi = c.domain.max[k];
    const double rounding =
        period_slack(c.domain, k) + 1.2e-7 * std::max(std::abs(lo), std::abs(hi));  // STL: floats
    if (c.domain.periodic[k] && !c.domain.flat(k) &&
        (body.min[k] < lo - rounding || body.max[k] > hi + rounding))
      fail(path, quoted(body.shape.name()),
           fmt::format("must lie within the period along {}, {}..{} m; only tank, box and plane run through",
                       "xyz"[k], lo, hi));
  }
}

void Checks::repeats(const std::string& path, const WallBody& plane) const {
  if (!c.fluid.present || !plane.stops_fluid()) return;
  for (int k = 0; k < 3; ++k)
    if (c.domain.periodic[k] && std::abs(plane.normal[k]) > 1e-12)
      fail(path, to_text(plane.normal),
           fmt::format("must be 0 along {}, in which the domain is periodic; the plane would not repeat",
                       "xyz"[k]));
}

void Checks::motions() const {
  for (const WallBody& body : c.wall.bodies) {
    const std::vector<Vec3d> at = corners(body, c.domain);
    if (const double shift = initial_shift(body.motion, at); shift > 1e-9)
      warn("wall.body \"{}\": its motion begins {:.4g} m away from where fluid and grains start for it",
           body.name, shift);
    auto jumps = velocity_jumps(body.motion, at, c.time.end);
    std::erase_if(jumps, [&](const VelocityJump& jump) { return jump.time == 0 && steady(body.motion); });
    warn_of(jumps, fmt::format("wall.body \"{}\"", body.name), "");
  }
  const MotionConfig& frame = c.frame.motion;
  for_parts(frame, "frame.motion",
            [&](const MotionPart& m, const std::string& path) { translates(m, path); });
  auto jumps = velocity_jumps(frame, {Vec3d{}}, c.time.end);
  // what is inside begins at the frame's own velocity
  std::erase_if(jumps, [](const VelocityJump& jump) { return jump.time == 0; });
  warn_of(jumps, "frame.motion", "; it does not act on what is inside");
}

bool Checks::steady(const MotionConfig& m) {
  return m.add.empty() && (m.kind == MotionKind::velocity || m.kind == MotionKind::rotation);
}

void Checks::warn_of(const std::vector<VelocityJump>& jumps, const std::string& of, const char* note) const {
  constexpr std::size_t few = 4;
  for (std::size_t k = 0; k < jumps.size() && (k < few || jumps.size() == few + 1); ++k)
    warn("{}: its velocity jumps by {:.4g} m/s at t = {:.4g} s{}", of, jumps[k].size, jumps[k].time, note);
  if (jumps.size() > few + 1)
    warn("{}: its velocity jumps {} times more until t = {:.4g} s", of, jumps.size() - few,
         jumps.back().time);
}

void Checks::translates(const MotionPart& m, const std::string& path) const {
  const char* must = "must not turn; a frame can only be translated";
  if (m.kind == MotionKind::rotation || m.kind == MotionKind::flap)
    fail(path + ".kind", quoted(m.kind.name()), must);
  if (m.rotation != MotionPart().rotation)
    fail(path + ".rotation", fmt::format("[{}]", fmt::join(m.rotation, ", ")), must);
  for (const MotionRow& row : m.rows)
    if (row[4] != 0 || row[5] != 0 || row[6] != 0)
      fail(path + ".kind", fmt::format("a table with rx, ry, rz = {}, {}, {} deg", row[4], row[5], row[6]),
           must);
}
}  // namespace bedload
