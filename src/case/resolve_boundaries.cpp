// Openings: what follows from their keys.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bedload/case/grain_sizes.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/orifice.hpp"
#include "bedload/geometry/shape.hpp"
#include "resolve.hpp"

namespace bedload {
namespace {

std::string to_text(const Vec3d& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

void check_right_angles(const InletConfig& inlet, const Value& root, const std::string& path) {
  const double a = norm(inlet.half_a), b = norm(inlet.half_b);
  for (const auto& [key, side, length] : {std::tuple{"half_a", inlet.half_a, a}, {"half_b", inlet.half_b, b}})
    if (length == 0 || std::abs(dot(side, inlet.direction)) > 1e-6 * length)
      reject(root, path + key, to_text(side), "must be a side at right angles to the direction of the flow");
  if (std::abs(dot(inlet.half_a, inlet.half_b)) > 1e-6 * a * b)
    reject(root, path + "half_b", to_text(inlet.half_b), "must be at right angles to half_a");
}

void resolve_inlet(InletConfig& inlet, double dx, const DomainConfig& domain, double until, const Value& root,
                   const std::string& path) {
  inlet.direction = direction(inlet.direction, root, path + "direction");
  if (inlet.shape == OrificeShape::rectangle) check_right_angles(inlet, root, path);
  check_factor(inlet.factor, 0, until, root, path + "factor");
  if ((inlet.rate > 0) == (inlet.velocity > 0))
    throw CaseError(fmt::format("{}: inlet \"{}\" must have exactly one of rate and velocity",
                                nearest_value(root, path + "rate").place(), inlet.name));
  constexpr double most = 1e7;  // particles side by side
  if (const double over = orifice_area(inlet) * dx / domain.cell_volume(dx) / most; over > 1)
    reject(root, "fluid.dx", fmt::format("{}", dx),
           fmt::format("must be at least {:.4g} m for no more than ten million particles in inlet \"{}\"",
                       dx * std::pow(over, domain.two_d ? 1.0 : 0.5), inlet.name));
  const OrificeWidth width = orifice_width(inlet, dx, domain);
  if (width.points < 4)
    reject(root, "fluid.dx", fmt::format("{}", dx),
           fmt::format("must be at most {:.4g} m for four particles across inlet \"{}\"; it makes {}",
                       width.spacing_for_four, inlet.name, width.points));
}

/// Not every shape can be asked about on a device.
void check_parts(const OutletConfig& outlet, const Value& root, const std::string& path) {
  try {
    std::vector<SurfacePart> parts;
    outlet.solid.shape->add_parts(parts, {});
  } catch (const CaseError& error) {
    reject(root, path + "shape", fmt::format("\"{}\"", outlet.shape.name()),
           std::string("cannot be used: ") + error.what());
  }
}

}  // namespace

void resolve_openings(Config& c, const Value& root) {
  for (std::size_t i = 0; i < c.inlets.size(); ++i)
    resolve_inlet(c.inlets[i], c.fluid.dx, c.domain, c.time.end, root, fmt::format("inlet.{}.", i));
  for (std::size_t i = 0; i < c.outlets.size(); ++i) {
    OutletConfig& outlet = c.outlets[i];
    const std::string path = fmt::format("outlet.{}.", i);
    if (outlet.shape == OutletShape::plane) {
      outlet.normal = direction(outlet.normal, root, path + "normal");
    } else if (outlet.shape != OutletShape::box) {
      outlet.solid = shape_named(c, outlet.shape.name(), root, path + "shape",
                                 "must be box, plane or the name of a [[shape]]");
      const Bounds bounds = outlet.solid.shape->bounds();
      outlet.min = bounds.min, outlet.max = bounds.max;
      check_parts(outlet, root, path);
    }
  }
}

void resolve_grain_inlets(Config& c, const Value& root) {
  for (std::size_t i = 0; i < c.grain_inlets.size(); ++i) {
    GrainInletConfig& inlet = c.grain_inlets[i];
    const std::string path = fmt::format("grain_inlet.{}.", i);
    if (inlet.shape == GrainInletShape::disc)
      inlet.direction = direction(inlet.direction, root, path + "direction");
    default_sizes(c, inlet.sizes, root);
    resolve_sizes(c, inlet.sizes, root, path + "sizes", c.grain.clump_named(inlet.clump));
    if ((inlet.rate > 0) == (inlet.mass_rate > 0))
      throw CaseError(fmt::format("{}: grain_inlet \"{}\" must have exactly one of rate and mass_rate",
                                  nearest_value(root, path + "rate").place(), inlet.name));
    inlet.start = std::max(inlet.start, c.grain.release_time);
  }
}

}  // namespace bedload
