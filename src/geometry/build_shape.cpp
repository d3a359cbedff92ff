#include "bedload/geometry/build_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <numeric>

#include "bedload/core/error.hpp"
#include "bedload/core/fingerprint.hpp"
#include "bedload/geometry/mesh.hpp"
#include "bedload/parallel/host_loop.hpp"

namespace bedload {
namespace {

const ShapeConfig& find(const std::string& name, const std::vector<ShapeConfig>& earlier) {
  std::string names;
  for (const ShapeConfig& shape : earlier) {
    if (shape.name == name) return shape;
    names += (names.empty() ? "" : ", ") + shape.name;
  }
  throw CaseError(fmt::format("of = \"{}\" must name a shape listed before it{}", name,
                              names.empty() ? "; there is none" : ": " + names));
}

std::string digest_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw FileError(path + ": cannot read this mesh");
  Fingerprint print;
  print.add(text);
  return fmt::format("{:016x}", print.value());
}

/// Of kind mesh or terrain.
ShapePtr build_mesh(ShapeConfig& c, double support) {
  MeshOptions options;
  options.repair = c.repair;
  const auto mesh = c.kind == ShapeKind::mesh
                        ? read_mesh(c.file, options)
                        : read_terrain(c.file, {c.thickness, support / c.scale}, options);
  const std::string digest = digest_of(c.file);
  if (!c.digest.empty() && c.digest != digest)
    throw CaseError(fmt::format("digest = \"{}\" must be that of {}, which is \"{}\": the file has changed",
                                c.digest, c.file, digest));
  c.digest = digest;
  return mesh;
}

void check_pieces(std::int64_t pieces) {
  constexpr std::int64_t most = 10000;
  if (pieces > most)
    throw CaseError(fmt::format("is made of {} pieces, must be of at most {}", pieces, most));
}

/// A turn by an angle (deg) about an axis through the origin.
Quat<double> turn_of(const Vec3d& axis, double angle) {
  return Quat<double>::from_rotation(angle * std::numbers::pi / 180 / norm(axis) * axis);
}

ShapePtr copied(const ShapePtr& shape, const CopiesConfig& c) {
  std::vector<ShapePtr> all{shape};
  for (std::int64_t k = 1; k < c.count; ++k) {
    Placement placement;
    if (c.angle != 0) placement.rotation = turn_of(c.about, double(k) * c.angle);
    placement.translation = c.centre - placement.rotation.rotate(c.centre) + double(k) * c.along;
    all.push_back(make_placed(shape, placement));
  }
  return make_union(std::move(all));
}

/// The shapes that another is made of; counts their pieces.
std::vector<ShapePtr> parts_of(ShapeConfig& c, const std::vector<ShapeConfig>& earlier) {
  std::vector<ShapePtr> of;
  c.pieces = 0;
  for (const std::string& name : c.of) {
    const ShapeConfig& part = find(name, earlier);
    of.push_back(part.solid.shape);
    c.pieces += part.pieces;
  }
  check_pieces(c.pieces);
  return of;
}

ShapePtr hollowed(const std::vector<ShapePtr>& of, double thickness) {
  if (of.size() != 1) throw CaseError(fmt::format("of holds {} names, must hold one", of.size()));
  return make_hollow(of[0], thickness);
}

ShapePtr without_others(const std::vector<ShapePtr>& of, double facet) {
  if (of.size() < 2) throw CaseError("of holds one name, must hold at least two");
  ShapePtr shape = of[0];
  for (std::size_t n = 1; n < of.size(); ++n) shape = make_difference(shape, of[n], facet);
  return shape;
}

ShapePtr build_unplaced(ShapeConfig& c, const std::vector<ShapeConfig>& earlier, double support) {
  switch (c.kind) {
    case ShapeKind::box:
      return make_box(c.min, c.max);
    case ShapeKind::sphere:
      return make_sphere(c.centre, c.radius);
    case ShapeKind::capsule:
      return make_capsule(c.a, c.b, c.radius);
    case ShapeKind::cylinder:
      return make_cylinder(c.a, c.b, c.radius);
    case ShapeKind::cone:
      return make_cone(c.a, c.b, c.radius_a, c.radius_b);
    case ShapeKind::pipe:
      return make_pipe(c.a, c.b, c.radius, c.radius + c.thickness, c.ends);
    case ShapeKind::mesh:
    case ShapeKind::terrain:
      return build_mesh(c, support);
    case ShapeKind::union_:
      return make_union(parts_of(c, earlier));
    case ShapeKind::hollow:
      return hollowed(parts_of(c, earlier), c.thickness);
    case ShapeKind::difference:
      return without_others(parts_of(c, earlier), c.facet);
  }
  return nullptr;
}

}  // namespace

ShapePtr build_shape(ShapeConfig& c, const std::vector<ShapeConfig>& earlier, double support) {
  const ShapePtr shape = build_unplaced(c, earlier, support);
  Placement placement;
  placement.scale = c.scale;
  if (norm(c.turn_axis) == 0) throw CaseError("turn_axis must not be zero");
  placement.rotation = turn_of(c.turn_axis, c.turn_angle);
  placement.translation = c.translate;
  const bool placed = c.scale != 1 || c.turn_angle != 0 || norm2(c.translate) > 0;
  const ShapePtr one = placed ? make_placed(shape, placement) : shape;
  if (!c.copies.present) return one;
  check_pieces(c.pieces *= c.copies.count);
  return copied(one, c.copies);
}

namespace {

/// A raster over what is in a shape and below a level.
struct Raster {
  const Shape& shape;
  Vec3d up;
  double level;  ///< m, along up
  Vec3d corner;
  double step;  ///< m

  /// How many of the size^3 cells from `low` on are inside, each by the depth of its centre: a plane anywhere
  /// in it divides it by half on average. A distance changes no faster than the place: blocks far inside or
  /// outside are not looked into. `size` is a power of two.
  double cells(const Vec3d& low, int size) const {
    const Vec3d x = corner + step * (low + Vec3d(0.5, 0.5, 0.5) * double(size));
    const double distance = std::max(shape.distance(x), dot(up, x) - level);
    const double farthest =
        0.5 * std::numbers::sqrt3 * (size - 1);  // centre of a cell from the block's, in steps
    const double inside = 0.5 - distance / step;
    if (inside <= -farthest) return 0;
    if (inside >= 1 + farthest) return double(size) * size * size;
    if (size == 1) return inside;
    double sum = 0;
    const int half = size / 2;
    for (int part = 0; part < 8; ++part)
      sum += cells(low + double(half) * Vec3d(part & 1, part >> 1 & 1, part >> 2), half);
    return sum;
  }
};

}  // namespace

double volume_below(const Shape& shape, const Vec3d& up, double level, double step) {
  constexpr int block = 16;  // cells
  const Bounds bounds = shape.bounds();
  std::array<std::int64_t, 3> n;
  for (int k = 0; k < 3; ++k)
    n[k] =
        std::max<std::int64_t>(1, std::int64_t(std::ceil((bounds.max[k] - bounds.min[k]) / (block * step))));
  const Raster raster{shape, up, level, bounds.min, step};
  std::vector<double> blocks(n[0] * n[1] * n[2]);
  host_for_each(blocks.size(), [&](std::size_t q) {
    const std::int64_t row = std::int64_t(q) / n[0];
    blocks[q] = raster.cells(
        double(block) * Vec3d(double(q - row * n[0]), double(row % n[1]), double(row / n[1])), block);
  });
  return std::accumulate(blocks.begin(), blocks.end(), 0.0) * step * step * step;
}

}  // namespace bedload
