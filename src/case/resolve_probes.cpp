// Probes: what follows for patches from the surface on which they lie.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bedload/core/error.hpp"
#include "bedload/geometry/depth.hpp"
#include "bedload/geometry/wall_surface.hpp"
#include "resolve.hpp"

namespace bedload {
namespace {

constexpr double kMostPatches = 10000, kMostPoints = 10000;

/// The wall body of that name that stops fluid; CaseError if there is none.
const WallBody& wall_named(const Config& c, const std::string& name, const Value& root,
                           const std::string& path) {
  std::string names;
  for (const WallBody& body : c.wall.bodies) {
    if (!body.stops_fluid()) continue;
    if (body.name == name) return body;
    names += (names.empty() ? "" : ", ") + body.name;
  }
  reject(root, path, fmt::format("\"{}\"", name),
         fmt::format("must name a wall.body that stops fluid; this case has {}",
                     names.empty() ? "none" : names));
}

void check_sides(const ProbeConfig& p, const Value& root, const std::string& path) {
  if ((p.radius > 0) != p.size.empty())
    throw CaseError(fmt::format("{}: probe \"{}\" must have exactly one of radius and size",
                                nearest_value(root, path + "size").place(), p.name));
  const auto fail = [&](const char* key, const std::vector<double>& values, const std::string& must) {
    reject(root, path + key, fmt::format("[{}]", fmt::join(values, ", ")), must);
  };
  if (p.radius == 0 && p.size.size() != 2) fail("size", p.size, "must hold two lengths");
  if (p.count.empty()) return;
  if (p.count.size() != 2 || p.count[0] != std::floor(p.count[0]) || p.count[1] != std::floor(p.count[1]))
    fail("count", p.count, "must hold two whole numbers");
  if (p.count[0] * p.count[1] > kMostPatches)
    fail("count", p.count, fmt::format("must make at most {} patches", kMostPatches));
}

/// Horizontal and to the right, as seen from the fluid; x on a floor or ceiling.
Vec3d default_along(const Vec3d& normal, const Vec3d& gravity) {
  const Vec3d right = cross(upwards(gravity), normal);
  if (norm(right) > 1e-6) return right;
  const Vec3d x = Vec3d{1, 0, 0} - normal.x * normal;
  return norm(x) > 1e-6 ? x : Vec3d{0, 1, 0};
}

void resolve_patches(const Config& c, ProbeConfig& p, const Value& root, const std::string& path) {
  check_sides(p, root, path);
  const WallBody& body = wall_named(c, p.body, root, path + "body");
  const SurfacePoint surface = nearest_surface(body, p.at, c.domain);
  if (const double off = std::abs(surface.distance), most = 0.5 * c.fluid.dx; off > most)
    reject(
        root, path + "at", fmt::format("[{}, {}, {}]", p.at.x, p.at.y, p.at.z),
        fmt::format("must lie on the surface of wall.body \"{}\", up to half a fluid.dx; it is {:.4g} m away",
                    p.body, off));
  p.normal = direction(p.normal == Vec3d{} ? surface.normal : p.normal, root, path + "normal");
  const Vec3d given = p.along == Vec3d{} ? default_along(p.normal, c.gravity) : p.along;
  if (c.domain.two_d && given.y != 0 && std::abs(given.y) < norm(given) * (1 - 1e-9))
    reject(root, path + "along", fmt::format("[{}, {}, {}]", given.x, given.y, given.z),
           "must lie in the plane of x and z, or along y, with domain.two_d");
  const double lean = dot(given, p.normal);
  if (std::abs(lean) <= 1e-9 * norm(given)) {
    p.along = direction(given, root, path + "along");
    return;
  }
  if (norm(given - lean * p.normal) < 1e-6 * norm(given))
    reject(root, path + "along", fmt::format("[{}, {}, {}]", given.x, given.y, given.z),
           "must not point along the normal");
  p.along = direction(given - lean * p.normal, root, path + "along");
}

/// Several points, and the direction of a line.
void resolve_points(const Config& c, ProbeConfig& p, const Value& root, const std::string& path) {
  const auto fail = [&](const char* key, const std::string& must) {
    reject(root, path + key, fmt::format("[{}]", fmt::join(p.count, ", ")), must);
  };
  if (p.span.size() > 3)
    reject(root, path + "span", fmt::format("{} vectors", p.span.size()),
           "must be one, two or three vectors");
  if (!p.span.empty() && p.count.size() != p.span.size())
    fail("count", fmt::format("must have a number for each span; there are {}", p.span.size()));
  double all = 1;
  for (const double n : p.count) {
    if (n != std::floor(n)) fail("count", "must hold whole numbers");
    all *= n;
  }
  if (all > kMostPoints) fail("count", fmt::format("must make at most {} points", kMostPoints));
  if (p.type == ProbeType::field) {
    double volume = 1, most = 1;  // of what unit vectors along the spans enclose, squared
    if (p.span.size() == 2) volume = norm2(cross(p.span[0], p.span[1]));
    if (p.span.size() == 3) volume = std::pow(dot(cross(p.span[0], p.span[1]), p.span[2]), 2);
    for (const Vec3d& span : p.span) most *= norm2(span);
    if (!(most > 0) || (p.span.size() > 1 && volume <= 1e-12 * most))
      reject(root, path + "span", fmt::format("{} vectors", p.span.size()),
             "must not be 0, nor lie along one another or in one plane");
  }
  if (p.along == Vec3d{}) return;
  const Vec3d given = p.along;
  if (c.domain.two_d && given.y != 0)
    reject(root, path + "along", fmt::format("[{}, {}, {}]", given.x, given.y, given.z),
           "must lie in the plane of x and z with domain.two_d");
  p.along = direction(given, root, path + "along");
}

}  // namespace

void resolve_probes(Config& c, const Value& root) {
  for (std::size_t i = 0; i < c.out.probes.size(); ++i) {
    ProbeConfig& p = c.out.probes[i];
    if (p.every == 0) p.every = c.out.every;
    if (p.type == ProbeType::wall_pressure && c.fluid.present)
      resolve_patches(c, p, root, fmt::format("probe.{}.", i));
    if (p.type == ProbeType::point || p.type == ProbeType::height || p.type == ProbeType::field)
      resolve_points(c, p, root, fmt::format("probe.{}.", i));
  }
}

}  // namespace bedload
