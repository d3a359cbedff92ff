#include "bedload/geometry/orifice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bedload/case/config.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/sampling.hpp"

namespace bedload {
namespace {

/// Unit vectors in the plane of the orifice: along the sides of a rectangle, along axes where a disc allows.
struct PlaneAxes {
  Vec3d a, b;
  explicit PlaneAxes(const InletConfig& inlet) {
    if (inlet.shape == OrificeShape::rectangle) {
      a = inlet.half_a / norm(inlet.half_a);
    } else {
      int least = 0;
      for (int k = 1; k < 3; ++k)
        if (std::abs(inlet.direction[k]) < std::abs(inlet.direction[least])) least = k;
      Vec3d axis;
      axis[least] = 1;
      a = axis - dot(axis, inlet.direction) * inlet.direction;
      a = a / norm(a);
    }
    b = cross(inlet.direction, a);
  }
};

struct HalfSides {
  double a, b;  // m
  explicit HalfSides(const InletConfig& inlet)
      : a(inlet.shape == OrificeShape::disc ? inlet.radius : norm(inlet.half_a)),
        b(inlet.shape == OrificeShape::disc ? inlet.radius : norm(inlet.half_b)) {}
};

int cells_along(double half_side, double dx) { return int(std::floor(2 * half_side / dx + 1e-6)); }
int nearest_cells(double half_side, double dx) { return std::max(1, int(std::lround(2 * half_side / dx))); }

[[noreturn]] void fail(const Config& config, const InletConfig& inlet, const std::string& why) {
  throw KeyError(fmt::format("inlet.{}", &inlet - config.inlets.data()),
                 fmt::format("inlet \"{}\": {}", inlet.name, why));
}

std::string place(const Vec3d& x) { return fmt::format("({:g}, {:g}, {:g}) m", x.x, x.y, x.z); }

/// A buffer belongs in an opening, such as the bore of a pipe or an open side of a tank.
void check_clear_of_walls(const Config& config, const InletConfig& inlet, const std::vector<Vec3d>& buffer,
                          double depth) {
  const double reach = config.fluid.reach(), slack = 1e-6 * config.fluid.dx;
  for (const WallBody& body : config.wall.bodies) {
    if (!body.stops_fluid()) continue;
    for (const Vec3d& x : buffer)
      if (wall_distance(body, x, reach, config.domain) < -slack)
        fail(config, inlet,
             fmt::format("the fluid upstream of it, at {}, must not lie inside wall.body \"{}\"; "
                         "leave an opening there, {:g} m deep",
                         place(x), body.name, depth));
  }
}

void check_clear_of_fluid(const Config& config, const InletConfig& inlet, const std::vector<Vec3d>& buffer,
                          double depth, const Setup::Fluid& fluid) {
  const double near = 0.7 * config.fluid.dx;
  const double wide = HalfSides(inlet).a + HalfSides(inlet).b + near;
  for (const Vec3d& x : fluid.x) {
    const Vec3d r = x - inlet.centre;
    const double along = dot(r, inlet.direction);
    if (along > near || along < -depth - near || norm2(r - along * inlet.direction) > wide * wide) continue;
    for (const Vec3d& y : buffer)
      if (norm2(x - y) < near * near)
        fail(config, inlet,
             fmt::format("the fluid upstream of it, at {}, must not overlap the initial fluid at {}",
                         place(y), place(x)));
  }
}

/// Next to fluid that comes in along a wall that begins at the orifice, half the kernel is empty upstream.
void check_walls_reach_upstream(const Config& config, const InletConfig& inlet,
                                const std::vector<Vec3d>& points, double depth,
                                std::vector<std::string>& warnings) {
  const double dx = config.fluid.dx;
  for (const WallBody& body : config.wall.bodies) {
    if (!body.stops_fluid() || body.moves()) continue;
    const auto beside = [&](const Vec3d& x) {
      return std::abs(wall_distance(body, x, depth, config.domain)) < 0.75 * dx;
    };
    const auto ends_here = [&](const Vec3d& x) {
      return beside(x + 0.5 * dx * inlet.direction) && !beside(x - 0.5 * depth * inlet.direction);
    };
    if (std::any_of(points.begin(), points.end(), ends_here))
      warnings.push_back(
          fmt::format("inlet \"{}\": wall.body \"{}\" next to it ends at its plane, so that fluid leaks "
                      "out along its edge; let it reach {:g} m upstream",
                      inlet.name, body.name, depth));
  }
}

}  // namespace

double orifice_area(const InletConfig& inlet) {
  const HalfSides half(inlet);
  return inlet.shape == OrificeShape::disc ? std::numbers::pi * half.a * half.a : 4 * half.a * half.b;
}

OrificeLayer orifice_layer(const InletConfig& inlet, double dx, const DomainConfig& domain) {
  const PlaneAxes axes(inlet);
  const HalfSides half(inlet);
  OrificeLayer layer;
  const auto add = [&](double a, double b) {
    layer.points.push_back(inlet.centre + a * axes.a + b * axes.b);
  };
  const int na = nearest_cells(half.a, dx), nb = domain.two_d ? 1 : nearest_cells(half.b, dx);
  const double sa = 2 * half.a / na, sb = 2 * half.b / nb;
  if (inlet.shape == OrificeShape::disc) {
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0));  // no ring lines up with another
    for (int ring = 0; ring < (na + 1) / 2; ++ring) {
      const double radius = (ring + (na % 2 ? 0 : 0.5)) * sa;
      const int count = std::max(1, int(std::lround(2 * std::numbers::pi * radius / sa)));
      for (int k = 0; k < count; ++k) {
        const double angle = ring * turn + 2 * std::numbers::pi * k / count;
        add(radius * std::cos(angle), radius * std::sin(angle));
      }
    }
  } else {
    for (int j = 0; j < nb; ++j)
      for (int i = 0; i < na; ++i) add((i - 0.5 * (na - 1)) * sa, (j - 0.5 * (nb - 1)) * sb);
  }
  layer.thickness = double(layer.points.size()) * domain.cell_volume(dx) / orifice_area(inlet);
  return layer;
}

OrificeWidth orifice_width(const InletConfig& inlet, double dx, const DomainConfig& domain) {
  const HalfSides half(inlet);
  const double narrow = domain.two_d ? half.a : std::min(half.a, half.b);
  return {cells_along(narrow, dx), narrow / 2};
}

int buffer_layers(const FluidProperties& fluid, double thickness) {
  return int(std::ceil(fluid.reach() / thickness - 1e-6)) + 1;
}

void add_inlets(const Config& config, const Setup::Fluid& fluid, Setup::Walls& walls,
                std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < config.inlets.size(); ++i) {
    const InletConfig& inlet = config.inlets[i];
    const OrificeLayer layer = orifice_layer(inlet, config.fluid.dx, config.domain);
    const int layers = buffer_layers(config.fluid, layer.thickness);
    std::vector<Vec3d> buffer;
    for (int k = 0; k < layers; ++k)
      for (const Vec3d& x : layer.points) buffer.push_back(x - (k + 0.5) * layer.thickness * inlet.direction);
    const double depth = layers * layer.thickness;
    check_clear_of_walls(config, inlet, buffer, depth);
    check_clear_of_fluid(config, inlet, buffer, depth, fluid);
    check_walls_reach_upstream(config, inlet, layer.points, depth, warnings);
    walls.x.insert(walls.x.end(), buffer.begin(), buffer.end());
    walls.body.insert(walls.body.end(), buffer.size(), std::uint32_t(config.wall.bodies.size() + i));
    walls.outer.insert(walls.outer.end(), buffer.size(), 0);
    if (!walls.mirror.empty()) walls.mirror.insert(walls.mirror.end(), buffer.begin(), buffer.end());
  }
}

}  // namespace bedload
