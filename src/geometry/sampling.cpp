#include "bedload/geometry/sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "bedload/core/cores.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/lattice.hpp"
#include "bedload/geometry/shape_sampling.hpp"
#include "bedload/geometry/wall_surface.hpp"
#include "geometry/rough_size.hpp"
#include "geometry/wall_faces.hpp"

namespace bedload {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTie = 1e-6;  // of a spacing; below it only rounding decides

std::int64_t layers(double depth, double step) { return std::int64_t(std::ceil(depth / step - kTie)); }

std::vector<Vec3d> sample_tank(const WallBody& tank, double spacing, double depth,
                               const DomainConfig& domain) {
  const auto closed = closed_faces(tank, domain);
  std::array<Cells, 3> cells;
  std::array<std::int64_t, 3> first{}, last{};  // cell numbers, inside is [0, count)
  for (int k = 0; k < 3; ++k) {
    cells[k] = fit_cells(tank.min[k], tank.max[k], domain.spacing_along(k, spacing));
    const std::int64_t extra = layers(depth, cells[k].step);
    first[k] = closed[2 * k] ? -extra : 0;
    last[k] = cells[k].count + (closed[2 * k + 1] ? extra : 0);
  }
  std::vector<Vec3d> points;
  const auto inside = [&](int k, std::int64_t i) { return i >= 0 && i < cells[k].count; };
  for (std::int64_t l = first[2]; l < last[2]; ++l)
    for (std::int64_t j = first[1]; j < last[1]; ++j) {
      const bool in_yz = inside(1, j) && inside(2, l);
      for (std::int64_t i = first[0]; i < last[0]; ++i) {
        if (in_yz && i == 0) i = cells[0].count;  // skip the hollow
        if (i < last[0]) points.push_back({cells[0].centre(i), cells[1].centre(j), cells[2].centre(l)});
      }
    }
  return points;
}

std::vector<Vec3d> sample_box(const WallBody& box, double spacing, double depth, const DomainConfig& domain) {
  std::array<Cells, 3> cells;
  std::array<bool, 3> endless{};
  for (int k = 0; k < 3; ++k) {
    cells[k] = fit_cells(box.min[k], box.max[k], domain.spacing_along(k, spacing));
    endless[k] = spans_period(box, domain, k);
  }
  const auto behind_face = [&](int k, std::int64_t i) {
    if (endless[k]) return kInfinity;
    return (double(std::min(i, cells[k].count - 1 - i)) + 0.5) * cells[k].step;
  };
  std::vector<Vec3d> points;
  for (std::int64_t l = 0; l < cells[2].count; ++l)
    for (std::int64_t j = 0; j < cells[1].count; ++j) {
      const double yz = std::min(behind_face(1, j), behind_face(2, l));
      for (std::int64_t i = 0; i < cells[0].count; ++i)
        if (std::min(yz, behind_face(0, i)) < depth - kTie * spacing)
          points.push_back({cells[0].centre(i), cells[1].centre(j), cells[2].centre(l)});
    }
  return points;
}

/// A direction within a plane and the cells of the lattice along it.
struct Direction {
  Vec3d unit;
  Cells cells;
  std::int64_t extra = 0;  ///< cells beyond either end
};

/// Cells along `unit` over the domain as seen from `origin`, and `depth` beyond.
Direction plane_direction(const Vec3d& unit, const Vec3d& origin, double spacing, double depth,
                          const DomainConfig& domain) {
  double lo = 0, hi = 0;
  bool periodic = false;
  if (std::abs(unit.y) == 1) spacing = domain.spacing_along(1, spacing);
  for (int k = 0; k < 3; ++k) {
    const double a = unit[k] * (domain.min[k] - origin[k]), b = unit[k] * (domain.max[k] - origin[k]);
    lo += std::min(a, b);
    hi += std::max(a, b);
    periodic |= domain.periodic[k] && std::abs(unit[k]) == 1;
  }
  Direction direction{unit, fit_cells(lo, hi, spacing), 0};
  if (!periodic) direction.extra = layers(depth, direction.cells.step);
  return direction;
}

/// Of the lattice of a plane, whose layers lie `spacing` apart along its normal.
std::array<Direction, 2> plane_lattice(const WallBody& plane, double spacing, double depth,
                                       const DomainConfig& domain) {
  const Vec3d n = plane.normal / norm(plane.normal);
  int along = -1;  // a coordinate axis within the plane, a periodic one if there is
  for (int k = 0; k < 3; ++k) {
    if (std::abs(n[k]) < 1e-12 && (along < 0 || domain.periodic[k])) along = k;
    if (domain.periodic[k] && std::abs(n[k]) > 1e-12)
      throw CaseError(
          fmt::format("wall.body \"{}\": a plane facing ({:g}, {:g}, {:g}) does not repeat with "
                      "the period along {}",
                      plane.name, n.x, n.y, n.z, "xyz"[k]));
  }
  Vec3d u{};
  if (along >= 0)
    u[along] = 1;
  else
    u = cross(n, Vec3d{0, 0, 1}) / norm(cross(n, Vec3d{0, 0, 1}));
  Vec3d v = cross(n, u);
  for (int k = 0; k < 3; ++k)
    if (std::abs(v[k]) > 1 - 1e-12) {  // a coordinate axis: exactly so, counted upwards
      v = {};
      v[k] = 1;
    }
  return {plane_direction(u, plane.point, spacing, depth, domain),
          plane_direction(v, plane.point, spacing, depth, domain)};
}

std::vector<Vec3d> sample_plane(const WallBody& plane, double spacing, double depth,
                                const DomainConfig& domain) {
  const Vec3d n = plane.normal / norm(plane.normal);
  const auto [a, b] = plane_lattice(plane, spacing, depth, domain);
  const double slack = kTie * spacing;
  std::vector<Vec3d> points;
  for (std::int64_t layer = 0; layer < layers(depth, spacing); ++layer)
    for (std::int64_t j = -b.extra; j < b.cells.count + b.extra; ++j)
      for (std::int64_t i = -a.extra; i < a.cells.count + a.extra; ++i) {
        const Vec3d x = plane.point + a.cells.centre(i) * a.unit + b.cells.centre(j) * b.unit -
                        (double(layer) + 0.5) * spacing * n;
        bool near = true;
        for (int k = 0; k < 3; ++k)
          near &= domain.periodic[k] ||
                  (x[k] > domain.min[k] - depth + slack && x[k] < domain.max[k] + depth - slack) ||
                  std::abs(n[k]) > 1 - 1e-12;  // may lie on the edge of the domain, all layers outside
        if (near) points.push_back(x);
      }
  return points;
}

double tank_distance(const WallBody& tank, const Vec3d& x, double thickness, const DomainConfig& domain) {
  const auto closed = closed_faces(tank, domain);
  std::array<double, 3> lo, hi;  // the tank with its walls
  for (int k = 0; k < 3; ++k) {
    lo[k] = tank.min[k] - (closed[2 * k] ? thickness : 0);
    hi[k] = tank.max[k] + (closed[2 * k + 1] ? thickness : 0);
  }
  double distance = kInfinity;
  for (int k = 0; k < 3; ++k) {
    bool opposite = true;
    for (int m = 0; m < 3; ++m)
      opposite &= m == k || spans_period(tank, domain, m) || (x[m] >= lo[m] && x[m] <= hi[m]);
    if (!opposite) continue;
    if (closed[2 * k] && x[k] > lo[k]) distance = std::min(distance, x[k] - tank.min[k]);
    if (closed[2 * k + 1] && x[k] < hi[k]) distance = std::min(distance, tank.max[k] - x[k]);
  }
  return distance;
}

double box_distance(const WallBody& box, const Vec3d& x, const DomainConfig& domain) {
  double inside = -kInfinity, outside2 = 0;
  for (int k = 0; k < 3; ++k) {
    if (spans_period(box, domain, k)) continue;
    const double beyond = std::max(box.min[k] - x[k], x[k] - box.max[k]);
    inside = std::max(inside, beyond);
    outside2 += std::max(beyond, 0.0) * std::max(beyond, 0.0);
  }
  return outside2 > 0 ? std::sqrt(outside2) : inside;
}

/// Points found again by place: is one of an earlier body nearer than `range`?
class PointFinder {
 public:
  explicit PointFinder(double range) : range_(range) {}

  void add(const Vec3d& x) { cells_[key(cell(x.x), cell(x.y), cell(x.z))].push_back(x); }

  bool has_near(const Vec3d& x) const {
    const std::int64_t i = cell(x.x), j = cell(x.y), k = cell(x.z);
    for (std::int64_t n = 0; n < 27; ++n) {
      const auto found = cells_.find(key(i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1));
      if (found == cells_.end()) continue;
      for (const Vec3d& y : found->second)
        if (norm2(x - y) < range_ * range_) return true;
    }
    return false;
  }

 private:
  std::int64_t cell(double x) const { return std::int64_t(std::floor(x / range_)); }
  static std::uint64_t key(std::int64_t i, std::int64_t j, std::int64_t k) {
    constexpr std::uint64_t mask = (1u << 21) - 1;
    return (std::uint64_t(i) & mask) << 42 | (std::uint64_t(j) & mask) << 21 | (std::uint64_t(k) & mask);
  }

  double range_;
  std::unordered_map<std::uint64_t, std::vector<Vec3d>> cells_;
};

/// Where fluid on two sides of a body meets through it.
void check_thickness(const Config& config, const WallBody& body, const std::vector<Vec3d>& points,
                     std::vector<std::string>& warnings) {
  const double reach = config.fluid.reach();
  const double thick = thickness(body, points, reach, config.domain);
  if (thick >= reach - 0.5 * config.wall.spacing(body)) return;
  const std::string what = fmt::format(
      "wall.body \"{}\": its shape \"{}\" is {:.3g} m thick, less than the "
      "kernel's reach of {:.3g} m, so fluid on its two sides ",
      body.name, body.shape.name(), thick, reach);
  warnings.push_back(what + (body.single_layer()
                                 ? "interacts through it; fluid_pairs_through_walls counts the pairs"
                                 : "would share wall particles; type = \"single_layer\" is meant for "
                                   "thin shells"));
}

/// Images of the particles of mdbc walls in the fluid.
void add_images(const Config& config, Setup::Walls& walls) {
  const auto mirrored = [](const WallBody& body) { return body.type->kind == WallKind::mirrored; };
  const auto& bodies = config.wall.bodies;
  if (std::none_of(bodies.begin(), bodies.end(), mirrored)) return;
  walls.mirror = walls.x;
  in_stretches(walls.x.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const WallBody& body = bodies[walls.body[w]];
      const Vec3d& x = walls.x[w];
      if (mirrored(body)) walls.mirror[w] = 2 * surface_point(body, x, config.domain) - x;
    }
  });
}

/// Whether two bodies stay as they are to each other.
bool move_together(const WallBody& a, const WallBody& b) {
  return !a.free.present && !b.free.present && a.motion == b.motion;
}

}  // namespace

std::vector<Vec3d> sample_body(const WallBody& body, double spacing, double depth,
                               const DomainConfig& domain) {
  if (body.solid.shape) return sample_solid(body.solid.shape, spacing, depth, domain);
  switch (body.shape.value()) {
    case WallShape::tank:
      return sample_tank(body, spacing, depth, domain);
    case WallShape::box:
      return sample_box(body, spacing, depth, domain);
    case WallShape::plane:
      return sample_plane(body, spacing, depth, domain);
  }
  return {};
}

double expected_places(const WallBody& body, double spacing, double depth, const DomainConfig& domain) {
  const double cell = domain.cell_volume(spacing);
  if (body.solid.shape) {
    const RoughSize size = rough_size(*body.solid.shape, domain);
    return std::min(size.area * depth, size.volume) / cell;
  }
  if (body.shape == WallShape::plane) {
    const auto [a, b] = plane_lattice(body, spacing, depth, domain);
    return double(a.cells.count + 2 * a.extra) * double(b.cells.count + 2 * b.extra) * depth / spacing;
  }
  const bool tank = body.shape == WallShape::tank;
  const auto closed = closed_faces(body, domain);
  // outer less inner volume, side by side: a thin shell is lost in the rounding of their difference
  double inner = 1, shell = 0;
  for (int k = 0; k < 3; ++k) {
    const double side = body.max[k] - body.min[k];
    const bool ends = !domain.flat(k) && !spans_period(body, domain, k);
    const double added = tank && ends ? (closed[2 * k] + closed[2 * k + 1]) * depth : 0;
    const double removed = !tank && ends ? std::min(side, 2 * depth) : 0;
    shell = shell * (side + added) + inner * (added + removed);
    inner *= side - removed;
  }
  return shell / cell;
}

double particle_volume(const WallBody& body, double spacing, const DomainConfig& domain) {
  if (body.solid.shape) return domain.cell_volume(spacing);
  if (body.shape == WallShape::plane) {
    const auto [a, b] = plane_lattice(body, spacing, 0, domain);
    return a.cells.step * b.cells.step * spacing;
  }
  double volume = 1;
  for (int k = 0; k < 3; ++k)
    volume *= fit_cells(body.min[k], body.max[k], domain.spacing_along(k, spacing)).step;
  return volume;
}

double wall_distance(const WallBody& body, const Vec3d& x, double thickness, const DomainConfig& domain) {
  if (body.solid.shape) return body.solid.shape->distance(x);
  if (body.shape == WallShape::tank) return tank_distance(body, x, thickness, domain);
  if (body.shape == WallShape::plane) return dot(x - body.point, body.normal) / norm(body.normal);
  return box_distance(body, x, domain);
}

double wall_clearance(const WallBody& body, const Vec3d& x, double thickness, const DomainConfig& domain) {
  if (body.solid.shape) return body.solid.shape->clearance(x);
  return wall_distance(body, x, thickness, domain);
}

namespace {

/// Places of the particles of a body.
std::vector<Vec3d> layers_of(const Config& config, std::size_t index) {
  const WallBody& body = config.wall.bodies[index];
  const double spacing = config.wall.spacing(body), reach = config.fluid.reach();
  try {
    return body.single_layer() ? sample_surface(body, spacing, config.domain)
                               : sample_body(body, spacing, reach, config.domain);
  } catch (const CaseError& error) {
    throw KeyError(fmt::format("wall.body.{}", index), error.what());
  }
}

/// Whether x lies beyond a periodic side of the domain, where the body has come round to what is there
/// already.
bool comes_round(const WallBody& body, const Vec3d& x, double reach, const DomainConfig& domain) {
  Vec3d within = x;
  for (int k = 0; k < 3; ++k)
    if (domain.periodic[k]) {
      const double period = domain.max[k] - domain.min[k];
      within[k] -= period * std::floor((x[k] - domain.min[k]) / period + 1e-9);
    }
  return norm(within - x) > 0 && wall_distance(body, within, reach, domain) < 0;
}

}  // namespace

void add_walls(const Config& config, Setup::Walls& walls, std::vector<std::string>& warnings) {
  const double reach = config.fluid.reach();
  const auto& bodies = config.wall.bodies;
  std::vector<PointFinder> placed;  // by body
  for (std::size_t index = 0; index < bodies.size(); ++index) {
    placed.emplace_back((0.3 + kTie) * config.wall.dx);
    const WallBody& body = bodies[index];
    if (!body.stops_fluid()) continue;
    const double spacing = config.wall.spacing(body);
    const std::vector<Vec3d> points = layers_of(config, index);
    check_thickness(config, body, points, warnings);
    // What an earlier body holds already need not be there twice, unless one of the two may leave.
    const auto share = [&](std::size_t one, std::size_t other) {
      return bodies[one].stops_fluid() && bodies[other].stops_fluid() &&
             move_together(bodies[one], bodies[other]);
    };
    const auto taken = [&](const Vec3d& x) {
      for (std::size_t other = 0; other < index; ++other) {
        if (!share(index, other)) continue;
        if (placed[other].has_near(x)) return true;
        if (wall_distance(bodies[other], x, reach, config.domain) < -1e-9 * spacing) return true;
      }
      return comes_round(body, x, reach, config.domain);
    };
    bool looked_up = false;  // by later bodies
    for (std::size_t other = index + 1; other < bodies.size(); ++other) looked_up |= share(index, other);
    enum : std::uint8_t { left_out, inner, outer };
    std::vector<std::uint8_t> kind(points.size(), left_out);
    in_stretches(points.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        if (taken(points[n])) continue;
        const bool behind = body.type->kind == WallKind::frozen &&
                            wall_distance(body, points[n], reach, config.domain) < -spacing;
        kind[n] = behind ? outer : inner;
      }
    });
    for (std::size_t n = 0; n < points.size(); ++n) {
      if (kind[n] == left_out) continue;
      if (looked_up) placed[index].add(points[n]);
      walls.x.push_back(points[n]);
      walls.body.push_back(std::uint32_t(index));
      walls.outer.push_back(kind[n] == outer);
    }
  }
  add_images(config, walls);
}

}  // namespace bedload
