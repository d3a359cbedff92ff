#include "bedload/geometry/nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bedload/case/lattice_step.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/sampling.hpp"
#include "bedload/geometry/wall_surface.hpp"
#include "bedload/lattice/velocities.hpp"
#include "bedload/motion/law.hpp"
#include "geometry/fill_region.hpp"
#include "geometry/fill_velocity.hpp"
#include "src/motion/survey.hpp"

namespace bedload {
namespace {

using d3q19::kVelocities;

std::string place_text(const Vec3d& x) { return fmt::format("({:.4g}, {:.4g}, {:.4g}) m", x.x, x.y, x.z); }

class NodeBuilder {
 public:
  explicit NodeBuilder(const Config& config) : c_(config), dx_(config.fluid.dx) {
    for (int k = 0; k < 3; ++k) {
      const bool more = has_outer_nodes(c_, k);
      nodes_.count[k] = std::uint32_t(cells_along(c_, k) + (more ? 2 : 0));
      nodes_.first[k] = c_.domain.min[k] + (more ? -0.5 : 0.5) * dx_;
    }
    size_ = std::size_t(nodes_.count[0]) * nodes_.count[1] * nodes_.count[2];
  }

  Setup::Nodes build() {
    find_solid();
    find_links();
    find_velocity();
    for (std::size_t b = 0; b < c_.wall.bodies.size(); ++b) check_motion(b);
    return std::move(nodes_);
  }

 private:
  using Place = std::array<std::int64_t, 3>;

  Place place(std::size_t node) const {
    const std::size_t row = node / nodes_.count[0];
    return {std::int64_t(node % nodes_.count[0]), std::int64_t(row % nodes_.count[1]),
            std::int64_t(row / nodes_.count[1])};
  }
  Vec3d at(const Place& p) const {
    return nodes_.first + dx_ * Vec3d{double(p[0]), double(p[1]), double(p[2])};
  }
  bool outside(const Place& p) const {
    for (int k = 0; k < 3; ++k)
      if (has_outer_nodes(c_, k) && (p[k] == 0 || p[k] + 1 == nodes_.count[k])) return true;
    return false;
  }
  double distance(std::size_t body, const Vec3d& x) const {
    const double all = norm(c_.domain.max - c_.domain.min);  // nothing is fluid beyond the sides of a tank
    return wall_distance(c_.wall.bodies[body], x, all, c_.domain);
  }

  void find_solid() {
    nodes_.solid.assign(size_, 0);
    if (c_.wall.bodies.empty()) return;
    for (std::size_t n = 0; n < size_; ++n) {
      const Vec3d x = at(place(n));
      for (std::size_t b = 0; b < c_.wall.bodies.size() && nodes_.solid[n] == 0; ++b)
        if (c_.wall.bodies[b].stops_fluid() && distance(b, x) < -1e-9 * dx_)
          nodes_.solid[n] = std::uint32_t(b) + 1;
    }
  }

  /// Fraction of a link on which it meets the surface of a body, from the fluid to a solid node at x.
  double fraction(std::size_t body, const Vec3d& solid, const Vec3d& link) const {
    double fluid_side = 0, solid_side = 1;
    if (distance(body, solid - link) <= 0) return 0.5;  // a shape that does not repeat, across a period
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (fluid_side + solid_side);
      (distance(body, solid - (1 - middle) * link) > 0 ? fluid_side : solid_side) = middle;
    }
    return std::abs(solid_side - 0.5) < 1e-9 ? 0.5 : solid_side;
  }

  /// The node that velocity i reaches, and whether the way leads out of the domain.
  Place reached(const Place& from, int i, int sign = 1) const {
    Place to = from;
    for (int k = 0; k < 3; ++k)
      to[k] = (from[k] + sign * d3q19::velocity(i, k) + nodes_.count[k]) % std::int64_t(nodes_.count[k]);
    return to;
  }
  std::size_t number(const Place& p) const {
    return (std::size_t(p[2]) * nodes_.count[1] + std::size_t(p[1])) * nodes_.count[0] + std::size_t(p[0]);
  }

  void find_links() {
    struct Found {
      std::uint32_t node, direction, body;
      double fraction;
    };
    std::vector<Found> all;
    std::vector<std::uint32_t> beside;
    for (std::size_t n = 0; n < size_; ++n) {
      const Place here = place(n);
      if (here[0] == 0) beside = look_beside(here);
      if (beside[std::size_t(here[0])] == 0 || nodes_.solid[n] != 0 || outside(here)) continue;
      for (int i = 1; i < kVelocities; ++i) {
        const Place there = reached(here, i);
        const std::uint32_t solid = nodes_.solid[number(there)];
        if (solid == 0 && outside(there) && !c_.domain.sheared()) open_side(there);
        if (solid == 0) continue;
        const bool behind = nodes_.solid[number(reached(here, i, -1))] != 0;
        all.push_back({std::uint32_t(n), std::uint32_t(i), solid - 1,
                       behind ? 0.5 : fraction(solid - 1, at(there), dx_ * d3q19::velocity_of<double>(i))});
      }
    }
    std::stable_sort(all.begin(), all.end(), [](const Found& a, const Found& b) { return a.body < b.body; });
    for (const Found& link : all) {
      nodes_.links.node.push_back(link.node);
      nodes_.links.direction.push_back(link.direction);
      nodes_.links.body.push_back(link.body);
      nodes_.links.fraction.push_back(link.fraction);
    }
    for (std::size_t n = 0; n < size_; ++n)  // beyond the sides, where no fluid comes
      if (nodes_.solid[n] == 0 && outside(place(n))) nodes_.solid[n] = Setup::Nodes::kOutside;
    if (std::none_of(nodes_.solid.begin(), nodes_.solid.end(), [](std::uint32_t s) { return s == 0; }))
      throw KeyError("wall.body", "wall.body: the walls leave no space for fluid in the domain");
  }

  /// Of each node of a row along x, from its first on: 0 where no link of it leads to a solid node or out of
  /// the domain.
  std::vector<std::uint32_t> look_beside(const Place& first) const {
    const std::size_t n = nodes_.count[0];
    std::vector<std::uint32_t> column(n, 0), beside(n);
    bool side = false;
    for (int row = 0; row < 9; ++row) {
      Place at = first;
      at[1] = (first[1] + row % 3 - 1 + nodes_.count[1]) % std::int64_t(nodes_.count[1]);
      at[2] = (first[2] + row / 3 - 1 + nodes_.count[2]) % std::int64_t(nodes_.count[2]);
      at[0] = std::int64_t(n / 2);
      side = side || outside(at);
      at[0] = 0;
      const std::uint32_t* solid = nodes_.solid.data() + number(at);
      for (std::size_t x = 0; x < n; ++x) column[x] |= solid[x];
    }
    if (!c_.domain.periodic[0]) column.front() = column.back() = 1;
    for (std::size_t x = 0; x < n; ++x)
      beside[x] = std::uint32_t(side) | column[x] | column[(x + 1) % n] | column[(x + n - 1) % n];
    return beside;
  }

  [[noreturn]] void open_side(const Place& p) const {
    int side = 0;
    for (int k = 0; k < 3; ++k)
      if (!c_.domain.periodic[k] && (p[k] == 0 || p[k] + 1 == nodes_.count[k])) side = 2 * k + (p[k] > 0);
    throw KeyError("domain.periodic",
                   fmt::format("domain.periodic: the side {} of the domain is open at {}; with fluid.model = "
                               "\"lattice\" it must be periodic or behind a wall.body",
                               kSides[side], place_text(at(p))));
  }

  void find_velocity() {
    const auto& fills = c_.fluid.fills;
    if (fills.empty()) return;
    nodes_.v.assign(size_, {});
    std::vector<FillVelocity> velocity;
    for (std::size_t k = 0; k < fills.size(); ++k) velocity.emplace_back(fills[k], k);
    for (std::size_t n = 0; n < size_; ++n) {
      if (nodes_.solid[n] != 0) continue;
      const Vec3d x = at(place(n));
      std::size_t k = 0;
      while (k < fills.size() && depth_in(fills[k], {0, 0, 1}, x) < -1e-6 * dx_) ++k;
      if (k == fills.size())
        throw KeyError("fluid.fill",
                       fmt::format("fluid.fill: no fill holds the place {}; with fluid.model = \"lattice\" "
                                   "there is no free surface, so that fills must hold all space between the "
                                   "walls, or be left out for fluid at rest",
                                   place_text(x)));
      nodes_.v[n] = velocity[k](x);
    }
  }

  /// A body may move along its own surface alone: a plate in its plane, a cylinder about its axis.
  void check_motion(std::size_t b) const {
    const WallBody& body = c_.wall.bodies[b];
    if (!body.motion.moves() && norm(body.surface_velocity) == 0) return;
    const MotionLaw law(body.motion, c_.time.end);
    std::vector<double> times = survey_times(body.motion, c_.time.end);
    const std::size_t stride = 1 + times.size() / 20;
    const auto& links = nodes_.links;
    for (std::size_t l = 0; l < links.node.size(); ++l) {
      if (links.body[l] != b) continue;
      const Vec3d x = at(place(links.node[l])) +
                      links.fraction[l] * dx_ * d3q19::velocity_of<double>(int(links.direction[l]));
      const Vec3d normal = nearest_surface(body, x, c_.domain).normal;
      const auto check = [&](const Vec3d& v, const char* key) {
        const double across = std::abs(dot(v, normal));
        if (across > 1e-4 * norm(v) && across > 1e-6 * c_.fluid.vmax)
          throw KeyError(fmt::format("wall.body.{}.{}", b, key),
                         fmt::format("wall.body.{}: the surface of \"{}\" must move along itself with "
                                     "fluid.model = \"lattice\", as a plate in its plane or a cylinder about "
                                     "its axis; at {} it moves at {:.3g} m/s across",
                                     key, body.name, place_text(x), across));
      };
      check(body.surface_velocity, "surface_velocity");
      for (std::size_t k = 0; k < times.size(); k += stride) check(law.at(times[k]).velocity(x), "motion");
    }
  }

  static constexpr std::array<const char*, 6> kSides{"x-", "x+", "y-", "y+", "z-", "z+"};

  const Config& c_;
  const double dx_;
  std::size_t size_ = 0;
  Setup::Nodes nodes_;
};

}  // namespace

Setup::Nodes place_nodes(const Config& config) { return NodeBuilder(config).build(); }

}  // namespace bedload
