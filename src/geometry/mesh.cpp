#include "bedload/geometry/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "bedload/core/error.hpp"
#include "bedload/geometry/mesh_layout.hpp"
#include "geometry/aabb_tree.hpp"
#include "geometry/decimals.hpp"
#include "geometry/mesh_topology.hpp"
#include "geometry/surface_point.hpp"
#include "geometry/triangle.hpp"

namespace bedload {
namespace {

using detail::corners_of;

constexpr double kTolerance = 1e-9;  // of degenerate triangles and of intersections, per diagonal
constexpr double kWeld = 1e-6;       // of repair, per diagonal

void place(TriangleSoup& soup, const Placement& placement, const std::string& name) {
  for (std::size_t n = 0; n < soup.vertices.size(); ++n) {
    Vec3d& x = soup.vertices[n];
    if (!(norm2(x) < 1e200))  // volumes and distances stay finite
      throw CaseError(fmt::format("{}: vertex {} = ({:g}, {:g}, {:g}) must be within 1e100 of the origin",
                                  name, n + 1, x.x, x.y, x.z));
    x = placement.apply(x);
  }
}

void check_indices(const TriangleSoup& soup, const std::string& name) {
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    for (const std::uint32_t corner : soup.triangles[t])
      if (corner >= soup.vertices.size())
        throw CaseError(fmt::format("{}: triangle {} names vertex {}, there are only {}", name, t + 1,
                                    corner + 1, soup.vertices.size()));
}

Bounds bounds_of(const TriangleSoup& soup) {
  Bounds bounds;
  for (const Vec3d& x : soup.vertices) bounds.add(x);
  return bounds;
}

std::unique_ptr<const detail::AabbTree> make_tree(const TriangleSoup& soup) {
  std::vector<Bounds> boxes(soup.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t)
    for (const Vec3d& corner : corners_of(soup, t)) boxes[t].add(corner);
  return std::make_unique<const detail::AabbTree>(boxes);
}

void check_intersections(const TriangleSoup& soup, const detail::AabbTree& tree, double depth,
                         const std::string& name) {
  std::size_t count = 0;
  std::pair<std::uint32_t, std::uint32_t> first{~0u, ~0u};
  tree.visit_pairs([&](std::uint32_t i, std::uint32_t j) {
    if (!intersect(corners_of(soup, i), corners_of(soup, j), depth)) return;
    ++count;
    first = std::min(first, {std::min(i, j), std::max(i, j)});
  });
  if (count == 0) return;
  Vec3d centre;
  for (const std::uint32_t t : {first.first, first.second})
    for (const Vec3d& corner : corners_of(soup, t)) centre += corner / 6;
  throw CaseError(
      fmt::format("{}: {} pairs of triangles intersect, the first at ({:g}, {:g}, {:g}) m: the surface must "
                  "not pass through itself",
                  name, count, centre.x, centre.y, centre.z));
}

/// Sums of the normals around each vertex, each weighted by its triangle's angle there.
std::vector<Vec3d> angle_weighted_normals(const TriangleSoup& soup) {
  std::vector<Vec3d> normals(soup.vertices.size());
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const Corners c = corners_of(soup, t);
    const Vec3d n = unit_normal(c);
    for (int k = 0; k < 3; ++k) {
      const Vec3d u = c[(k + 1) % 3] - c[k], v = c[(k + 2) % 3] - c[k];
      normals[soup.triangles[t][k]] += std::atan2(norm(cross(u, v)), dot(u, v)) * n;
    }
  }
  return normals;
}

/// Triangles around each vertex.
void add_rings(MeshLayout& layout) {
  layout.ring_start.assign(layout.vertices.size() + 1, 0);
  for (const MeshTriangle& t : layout.triangles)
    for (const std::uint32_t v : t.corner) ++layout.ring_start[v + 1];
  std::partial_sum(layout.ring_start.begin(), layout.ring_start.end(), layout.ring_start.begin());
  layout.ring.resize(layout.ring_start.back());
  std::vector<std::uint32_t> next(layout.ring_start.begin(), layout.ring_start.end() - 1);
  for (std::uint32_t t = 0; t < layout.triangles.size(); ++t)
    for (const std::uint32_t v : layout.triangles[t].corner) layout.ring[next[v]++] = t;
}

double mean_edge(const MeshLayout& layout) {
  double sum = 0;
  for (const MeshTriangle& t : layout.triangles)
    for (int k = 0; k < 3; ++k)
      sum += norm(layout.vertices[t.corner[(k + 1) % 3]] - layout.vertices[t.corner[k]]);
  return sum / (3 * double(layout.triangles.size()));
}

/// The tree, with the boxes of its triangles as they have been placed.
void add_nodes(MeshLayout& layout, const detail::AabbTree& tree) {
  layout.nodes.resize(tree.nodes().size());
  for (std::size_t n = layout.nodes.size(); n-- > 0;) {  // children come after their parent
    const auto& from = tree.nodes()[n];
    MeshNode& node = layout.nodes[n];
    node.next = from.right != 0 ? from.right : from.begin;
    node.count = from.right != 0 ? 0 : from.end - from.begin;
    Bounds box;
    for (std::uint32_t t = from.begin; t < from.end; ++t)
      for (const std::uint32_t v : layout.triangles[t].corner) box.add(layout.vertices[v]);
    for (int k = 0; k < 3; ++k) {
      node.lo[k] = std::nextafter(float(box.min[k]), -INFINITY);
      node.hi[k] = std::nextafter(float(box.max[k]), INFINITY);
      if (node.count > 0) continue;
      const MeshNode &a = layout.nodes[n + 1], &b = layout.nodes[node.next];
      node.lo[k] = std::min(a.lo[k], b.lo[k]);
      node.hi[k] = std::max(a.hi[k], b.hi[k]);
    }
  }
}

}  // namespace

struct TriangleMesh::Hit {
  TrianglePoint at;
  std::uint32_t triangle = 0;
};

TriangleMesh::TriangleMesh(TriangleSoup soup, const std::string& name, const MeshOptions& options)
    : soup_(std::move(soup)) {
  check_indices(soup_, name);
  place(soup_, options.placement, name);
  double diagonal = norm(bounds_of(soup_).max - bounds_of(soup_).min);
  detail::weld(soup_, !options.repair ? 0 : options.weld > 0 ? options.weld : kWeld * diagonal);
  bounds_ = bounds_of(soup_);
  diagonal = norm(bounds_.max - bounds_.min);
  detail::drop_degenerate(soup_, kTolerance * diagonal, options.repair, name);
  if (soup_.triangles.empty()) throw CaseError(name + ": holds no triangles");

  across_ = detail::match_edges(soup_, name);
  const auto surface = detail::orient_alike(soup_, across_, options.repair, name);
  detail::check_vertices(soup_, across_, name);
  tree_ = make_tree(soup_);
  check_intersections(soup_, *tree_, kTolerance * diagonal, name);
  if (detail::orient_outward(soup_, surface, options.repair, name))
    across_ = detail::match_edges(soup_, name);
  vertex_normals_ = angle_weighted_normals(soup_);
}

TriangleMesh::~TriangleMesh() = default;

TriangleMesh::Hit TriangleMesh::find_nearest(const Vec3d& x) const {
  Hit hit;
  hit.at.distance2 = Bounds::kInfinity;
  tree_->visit_near(x, hit.at.distance2, [&](std::uint32_t t) {
    const TrianglePoint p = nearest_on(corners_of(soup_, t), x);
    if (p.distance2 < hit.at.distance2 || (p.distance2 == hit.at.distance2 && t < hit.triangle)) hit = {p, t};
  });
  return hit;
}

Vec3d TriangleMesh::pseudonormal(const Hit& hit) const {
  if (hit.at.feature == Feature::vertex) return vertex_normals_[soup_.triangles[hit.triangle][hit.at.index]];
  const Vec3d n = unit_normal(corners_of(soup_, hit.triangle));
  if (hit.at.feature == Feature::face) return n;
  return n + unit_normal(corners_of(soup_, across_[3 * hit.triangle + hit.at.index] / 3));
}

SurfacePoint TriangleMesh::nearest(const Vec3d& x) const {
  const Hit hit = find_nearest(x);
  const Vec3d n = pseudonormal(hit);
  return seen_from(x, hit.at.point, dot(x - hit.at.point, n) < 0, n / norm(n));
}

ShapePtr TriangleMesh::in_frame(const Vec3d& origin, double spacing) const {
  Placement placement;
  placement.translation = Decimals(spacing)(-1.0 * origin);
  return make_placed(ShapePtr(ShapePtr(), this), placement);
}

std::uint32_t TriangleMesh::nearest_triangle(const Vec3d& x) const { return find_nearest(x).triangle; }

void TriangleMesh::add_parts(std::vector<SurfacePart>& parts, const Placement& placement) const {
  Bounds placed;
  for (const Vec3d& x : soup_.vertices) placed.add(placement.apply(x));
  SurfacePart part{.kind = SurfacePart::Kind::mesh, .centre = (placed.min + placed.max) / 2};
  part.half = (placed.max - placed.min) / 2;
  auto layout = std::make_shared<MeshLayout>();
  for (const Vec3d& x : soup_.vertices) layout->vertices.push_back(placement.apply(x) - part.centre);
  layout->triangles.resize(soup_.triangles.size());

  const std::vector<std::uint32_t>& order = tree_->items();  // triangles as they lie in the layout
  std::vector<std::uint32_t> place(order.size());
  for (std::uint32_t n = 0; n < order.size(); ++n) place[order[n]] = n;
  for (std::uint32_t t = 0; t < order.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      layout->triangles[place[t]].corner[k] = soup_.triangles[t][k];
      layout->triangles[place[t]].across[k] = place[across_[3 * t + k] / 3];
    }
  add_rings(*layout);
  add_nodes(*layout, *tree_);
  layout->edge = mean_edge(*layout);
  part.mesh = layout;
  parts.push_back(part);
}

double TriangleMesh::volume() const {
  const Vec3d from = bounds_.min;
  double sum = 0;
  for (std::size_t t = 0; t < soup_.triangles.size(); ++t) {
    const Corners c = corners_of(soup_, t);
    sum += dot(c[0] - from, cross(c[1] - from, c[2] - from)) / 6;
  }
  return sum;
}

}  // namespace bedload
