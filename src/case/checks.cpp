// Keys against each other: domain, time, and what all sections share.

#include <algorithm>
#include <cmath>
#include <limits>

#include "bedload/case/limits.hpp"
#include "bedload/geometry/depth.hpp"
#include "checks.hpp"

namespace bedload {

void Checks::domain() const {
  box("domain", c.domain.min, c.domain.max);
  if (!c.fluid.present && !c.grain.present && c.wall.free_bodies() == 0)
    throw CaseError(root_.place() + ": nothing to compute; give [fluid], [grain] or both");
  for (int k = 0; k < 3; ++k) {
    if (!c.domain.periodic[k]) continue;
    if (c.drive.rate[k] != 0)
      fail("drive.rate", to_text(c.drive.rate),
           fmt::format("must be 0 along {}, which is periodic and has no centre", "xyz"[k]));
    if (c.domain.flat(k)) continue;
    period(k, 2 * c.fluid.reach(), c.fluid.variable_h ? "4 kappa h" : "2 kappa h",
           c.fluid.present && !c.fluid.lattice());
    period(k, 2 * c.farthest_average(), "2 kappa h_c", coupled());
    period(k, 2 * c.grain.d_max, "4 R", c.grain.present);
  }
  if (c.block != 1 && c.block != 2 && c.block != 4 && c.block != 8)
    fail("run.block", c.block, "must be 1, 2, 4 or 8");
  written_positions();
  reflection();
  if (c.domain.two_d) check_plane(c, root_);
  if (c.domain.sheared() && !(c.fluid.present && c.fluid.lattice())) shear();
}

void Checks::written_positions() const {
  if (c.precision == Precision::fp64) return;
  double far = 0;
  for (int k = 0; k < 3; ++k) far = std::max({far, std::abs(c.domain.min[k]), std::abs(c.domain.max[k])});
  const double step = std::nextafter(float(far), std::numeric_limits<float>::infinity()) - float(far);
  const double dx = c.fluid.present ? c.fluid.dx : INFINITY,
               d = c.grain.present ? c.grain.smallest() : INFINITY;
  const double size = std::min(dx, d);
  if (step <= 1e-3 * size || !std::isfinite(size)) return;
  warn(
      "frames hold positions in steps of {:.2g} m at the far side of the domain, {:.4g} m from the origin, "
      "{:.2g} times {} of {} m; bring the case nearer to the origin, or write doubles with run.precision = "
      "\"double\"",
      step, far, step / size, dx <= d ? "fluid.dx" : "the smallest grain", size);
}

void Checks::reflection() const {
  const ReflectConfig& r = c.domain.reflect;
  for (std::size_t face = 0; face < kFaces.size(); ++face) {
    if (!r.slip[face] && !r.no_slip[face]) continue;
    const std::string key = r.no_slip[face] ? "domain.reflect.no_slip" : "domain.reflect.slip",
                      side = quoted(std::string(kFaces[face]));
    if (r.slip[face] && r.no_slip[face]) fail(key, side, "must not be one of domain.reflect.slip as well");
    if (c.domain.flat(int(face / 2))) fail(key, side, "must be a side along x or z with domain.two_d");
    if (c.domain.periodic[face / 2])
      fail(key, side, fmt::format("must be a side across which nothing is periodic; {} is", "xyz"[face / 2]));
    if (!c.grain.rigid_fills().empty()) fail(key, side, "must not be given with [grain.fill.rigid]");
    if (c.grain.has_clumps()) fail(key, side, "must not be given with clumps");
  }
}

void Checks::shear() const {
  const FluidConfig& f = c.fluid;
  if (!f.present) fail("domain.shear_rate", c.domain.shear_rate, "must be 0 without [fluid]");
  for (const auto& [there, what] : {std::pair{c.grain.present, "[grain]"},
                                    {!c.wall.bodies.empty(), "[[wall.body]]"},
                                    {!c.inlets.empty() || !c.grain_inlets.empty(), "inlets"},
                                    {!c.outlets.empty(), "[[outlet]]"},
                                    {c.domain.reflect.any(), "domain.reflect"},
                                    {c.frame.motion.moves(), "frame.motion"},
                                    {norm(c.gravity) > 0, "gravity"},
                                    {norm(c.drive.f) > 0 || c.drive.pulls(), "[drive]"},
                                    {f.variable_h, "fluid.variable_h"},
                                    {!f.species.empty(), "fluid.species"},
                                    {c.visc.collision, "visc.collision"},
                                    {c.xsph > 0, "xsph > 0"},
                                    {c.tensile > 0, "tensile > 0"},
                                    {c.time.integrator == TimeIntegrator::ab3, "time.integrator = \"ab3\""}})
    if (there) fail("domain.shear_rate", c.domain.shear_rate, fmt::format("must be 0 with {}", what));
  for (std::size_t i = 0; i < c.out.probes.size(); ++i)
    if (const auto& type = c.out.probes[i].type; type == ProbeType::point || type == ProbeType::height)
      fail(fmt::format("probe.{}.type", i), quoted(type.name()), "must be another with domain.shear_rate");
  for (const int k : {0, 2})
    if (!c.domain.periodic[k])
      fail("domain.periodic", fmt::format("false along {}", "xyz"[k]), "must be true with domain.shear_rate");
  // images across x are apart also where those across z have moved by half a period
  const Vec3d side = c.domain.max - c.domain.min;
  const double strain = 0.5 * side.x / side.z + 1.5 * c.skin_fluid * f.dx / f.reach();
  period(0, 2 * f.reach() * std::sqrt(1 + strain * strain), "2 kappa h, sheared", true);
}

void Checks::time() const {
  for (const StepLimit& limit : grain_limits(c)) {
    if (c.time.dt_dem <= limit.seconds * (1 + 1e-9)) continue;
    if (!c.time.force_dt)
      fail("time.dt_dem", c.time.dt_dem,
           fmt::format("must be <= {:.4g}; limited by {}", limit.seconds, with_key(limit.limit)));
    warn("time.dt_dem = {} is above its limit {:.4g} by {}", c.time.dt_dem, limit.seconds,
         with_key(limit.limit));
  }
  if (c.time.integrator == TimeIntegrator::ab3) one_pass();
  if (c.time.integrator == TimeIntegrator::euler) warn("time.integrator = \"euler\" is first order in time");
}

void Checks::one_pass() const {
  if (c.time.cfl > 0.3) fail("time.cfl", c.time.cfl, "must be <= 0.3 with time.integrator = \"ab3\"");
  const auto frozen = [](const WallBody& body) { return !body.type->one_pass; };
  for (const auto& [there, what] :
       {std::pair{coupled() && c.couple.mode == CouplingMode::two_way, "grains that the fluid feels"},
        {std::any_of(c.wall.bodies.begin(), c.wall.bodies.end(), frozen), "frozen walls"},
        {c.tensile > 0, "tensile > 0"},
        {c.xsph > 0, "xsph > 0"}})
    if (there) fail("time.integrator", "\"ab3\"", fmt::format("must be \"kdk\" with {}", what));
}

void Checks::box(const std::string& path, const Vec3d& lo, const Vec3d& hi) const {
  for (int k = 0; k < 3; ++k)
    if (!(hi[k] > lo[k]))
      fail(path + ".max", to_text(hi),
           fmt::format("must exceed {}.min = {} on every axis", key_of(path), to_text(lo)));
}

void Checks::period(int axis, double least, const char* name, bool applies) const {
  const double length = c.domain.max[axis] - c.domain.min[axis];
  if (applies && length <= least)
    fail("domain.periodic", fmt::format("{} m along {}", length, "xyz"[axis]),
         fmt::format("must be a period > {} = {}; enlarge the domain or refine", name, least));
}

bool Checks::in_sight(const Vec3d& lo, const Vec3d& hi) const {
  for (int k = 0; k < 3; ++k)
    if (!c.domain.periodic[k] && (hi[k] < c.domain.min[k] || lo[k] > c.domain.max[k])) return false;
  return true;
}

void Checks::inside_domain(const std::string& path, const Vec3d& x) const {
  const Vec3d &lo = c.domain.min, &hi = c.domain.max;
  for (int k = 0; k < 3; ++k) {
    const double slack = 1e-9 * (hi[k] - lo[k]);
    if (x[k] < lo[k] - slack || x[k] > hi[k] + slack)
      fail(path, to_text(x), fmt::format("must lie in the domain {}..{}", to_text(lo), to_text(hi)));
  }
}

void Checks::column_in_domain(const std::string& path, const Vec3d& x, const Vec3d& along) const {
  const bool vertical = along == Vec3d{};
  const auto [from, to] = line_in_box(x, vertical ? upwards(c.gravity) : along, c.domain.min, c.domain.max);
  if (from > to)
    fail(path, to_text(x),
         fmt::format("must have a part of the domain {}..{} {}", to_text(c.domain.min), to_text(c.domain.max),
                     vertical ? "above or below it" : "on the line through it"));
}

void Checks::file_name(const std::string& path, const std::string& name) const {
  const auto plain = [](unsigned char ch) { return std::isalnum(ch) || ch == '_' || ch == '-' || ch == '.'; };
  if (!std::all_of(name.begin(), name.end(), plain) || name[0] == '.')
    fail(path, quoted(name), "must consist of letters, digits, '_', '-' and '.'");
}

void Checks::body_exists(const std::string& path, const std::string& name) const {
  std::string all;
  for (const WallBody& body : c.wall.bodies) {
    if (body.name == name) return;
    all += (all.empty() ? "" : ", ") + body.name;
  }
  fail(path, quoted(name), "must name a wall.body; this case has " + (all.empty() ? "none" : all));
}

void cross_check(const Config& config, const Value& root, std::vector<std::string>& warnings) {
  const Checks checks(config, root, warnings);
  checks.domain();
  if (config.fluid.present && config.fluid.lattice()) checks.lattice();
  if (config.fluid.present && !config.fluid.lattice()) checks.fluid();
  checks.meshes();
  checks.walls();
  checks.motions();
  if (config.grain.present) checks.grains();
  checks.contact_pairs();
  checks.grain_energy();
  checks.openings();
  checks.coupling();
  checks.time();
  checks.probes();
}

}  // namespace bedload
