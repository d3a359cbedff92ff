#include "resolve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "bedload/case/grain_sizes.hpp"
#include "bedload/core/error.hpp"

namespace bedload {
namespace {

/// Unit vector; one that already is stays as it is, so that a resolved case reads back unchanged.
Vec3d direction(const Vec3d& v, const Value& root, const std::string& path) {
  const double n = norm(v);
  if (n == 0) reject(root, path, "[0, 0, 0]", "must not be zero");
  return std::abs(n - 1) < 1e-12 ? v : Vec3d{v.x / n, v.y / n, v.z / n};
}

[[noreturn]] void missing(const Value& root, const std::string& key, const char* what) {
  throw CaseError(fmt::format("{}: {} must be given ({})", nearest_value(root, key).place(), key, what));
}

void resolve_walls(Config& c, const Value& root) {
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
    WallBody& body = c.wall.bodies[i];
    const std::string path = fmt::format("wall.body.{}.", i);
    if (body.shape == "plane") body.normal = direction(body.normal, root, path + "normal");
    if (body.motion.kind == "rotation")
      body.motion.axis = direction(body.motion.axis, root, path + "motion.axis");
  }
}

void resolve_fluid(Config& c, const Value& root, const std::filesystem::path& checkpoint) {
  FluidConfig& f = c.fluid;
  if (f.fills.empty()) missing(root, "fluid.fill", "[[fluid.fill]] with min and max");
  resolve_listed_fluid(c, root, checkpoint);
  const double gH = norm(c.gravity) * (f.depth = height(f.fills, c.gravity));
  double vmax = std::max(f.vmax, std::sqrt(2 * gH));
  for (const WallBody& body : c.wall.bodies) vmax = std::max(vmax, wall_speed(body, c.domain));
  if (vmax == 0) missing(root, "fluid.vmax", "m/s; neither gravity nor a wall sets a speed here");
  f.vmax = vmax;
  f.c = c.eos.type == "tait" ? f.c_factor * vmax : std::sqrt(c.eos.alpha * c.eos.p0 / f.rho0);
  if (c.wall.dx == 0) c.wall.dx = f.dx;
  if (c.wall.rep_D == 0) c.wall.rep_D = gH > 0 ? 5 * gH : vmax * vmax;
  if (c.wall.rep_r0 == 0) c.wall.rep_r0 = 0.5 * f.dx;
}

void check_sieve(const SizeClass& s, const Value& root, const std::string& path) {
  const auto fail = [&](const char* list, const std::vector<double>& values, const std::string& must) {
    reject(root, path + list, fmt::format("[{}]", fmt::join(values, ", ")), must);
  };
  if (s.openings.size() < 2) fail(".openings", s.openings, "must hold two openings or more");
  if (s.passing.size() != s.openings.size())
    fail(".passing", s.passing,
         fmt::format("must hold a share for each of the {} openings", s.openings.size()));
  if (std::adjacent_find(s.openings.begin(), s.openings.end(), std::greater_equal<>()) != s.openings.end())
    fail(".openings", s.openings, "must rise from each to the next");
  if (!std::is_sorted(s.passing.begin(), s.passing.end()))
    fail(".passing", s.passing, "must not fall from the finer mesh to the coarser");
  if (s.passing.front() != 0 || s.passing.back() != 1)
    fail(".passing", s.passing,
         "must begin with 0 and end with 1; add the meshes that stop and pass everything");
}

/// The ends of a log-normal distribution lie 3 sigma from its median.
void resolve_size(SizeClass& s, const Value& root, const std::string& path) {
  if (s.kind == "sieve") check_sieve(s, root, path);
  if (s.kind != "log_normal") return;
  if (s.d_min == 0) s.d_min = s.median * std::exp(-3 * s.sigma);
  if (s.d_max == 0) s.d_max = s.median * std::exp(3 * s.sigma);
}

void resolve_grains(Config& c, const Value& root, const std::filesystem::path& checkpoint) {
  GrainConfig& g = c.grain;
  if (g.fills.empty()) missing(root, "grain.fill", "[[grain.fill]] with a box or positions");
  g.seed = c.seed;
  g.d_min = 1e300;
  for (std::size_t i = 0; i < g.fills.size(); ++i) {
    GrainFill& fill = g.fills[i];
    if (!fill.file.empty() && resolve_listed_grains(c, i, root, checkpoint)) continue;
    if (fill.sizes.empty()) {
      if (g.d == 0) missing(root, "grain.d", "diameter, m, where a grain.fill has no sizes");
      fill.sizes = {{.d = g.d, .share = 1}};
    }
    if (!fill.positions.empty()) fill.count = std::int64_t(fill.positions.size());
    for (std::size_t k = 0; k < fill.sizes.size(); ++k) {
      resolve_size(fill.sizes[k], root, fmt::format("grain.fill.{}.sizes.{}", i, k));
      const auto [smallest, largest] = size_range(fill.sizes[k]);
      g.d_min = std::min(g.d_min, smallest);
      g.d_max = std::max(g.d_max, largest);
    }
  }
  const double fall = height(std::vector<DomainConfig>{c.domain}, c.gravity);
  if (g.settle && g.settle_time == 0 && fall > 0) g.settle_time = 20 * std::sqrt(2 * fall / norm(c.gravity));
}

}  // namespace

double wall_speed(const WallBody& body, const DomainConfig& domain) {
  const MotionConfig& m = body.motion;
  if (m.kind == "velocity") return norm(m.velocity);
  if (m.kind == "oscillation") return 2 * std::numbers::pi * m.frequency * norm(m.amplitude);
  if (m.kind != "rotation") return 0;
  const bool bounded = body.shape != "plane";
  const Vec3d& lo = bounded ? body.min : domain.min;
  const Vec3d& hi = bounded ? body.max : domain.max;
  double reach = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d x{corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z};
    reach = std::max(reach, norm(cross(m.axis, x - m.centre)));
  }
  return std::abs(m.rate) * reach;
}

double solid_volume(const GrainFill& fill, double rho) {
  const Vec3d side = fill.max - fill.min;
  if (fill.packing_fraction > 0) return fill.packing_fraction * side.x * side.y * side.z;
  if (fill.mass > 0) return fill.mass / rho;
  return double(fill.count) * mean_volume(fill.sizes, std::size_t(fill.count));
}

void resolve(Config& c, const Value& root, const std::filesystem::path& checkpoint) {
  resolve_walls(c, root);
  if (c.fluid.present) resolve_fluid(c, root, checkpoint);
  if (c.grain.present) resolve_grains(c, root, checkpoint);
  if (c.fluid.present && c.grain.present && c.couple.hc == 0)
    c.couple.hc = std::max(c.fluid.h(), 4 * c.grain.d_max / c.fluid.kappa());
  if (c.out.diagnostics_every == 0) c.out.diagnostics_every = c.out.every;
  for (ProbeConfig& probe : c.out.probes)
    if (probe.every == 0) probe.every = c.out.every;
}

}  // namespace bedload
