#pragma once
// A closed surface of triangles as kernels see it: its own tree of boxes, closest points by local minima.

#include <cmath>
#include <cstdint>

#include "bedload/core/types.hpp"
#include "bedload/geometry/mesh_layout.hpp"
#include "bedload/geometry/triangle_point.hpp"

namespace BL_SOLVER {

struct MeshView {
  const MeshNode* nodes = nullptr;
  const Vec3d* vertices = nullptr;            ///< from the mesh's centre, m
  const MeshTriangle* triangles = nullptr;    ///< in the order of the tree's leaves
  const std::uint32_t* ring_start = nullptr;  ///< [vertices + 1]
  const std::uint32_t* ring = nullptr;        ///< triangles around each vertex, ascending

  /// f(normal, signed distance, feature) for every closest point no farther than `reach` (m) from x. Points
  /// of neighbouring triangles closer than `merge` (m) count as one: a closest point that lies on an edge by
  /// round-off.
  template <class F>
  BL_HD void each_closest_point(const Vec3d& x, double reach, double merge, F&& f) const {
    walk([&](const MeshNode& node) { return node.distance2(x) <= reach * reach; },
         [&](std::uint32_t t) { closest(t, x, reach, merge, f); });
  }
  /// As each_closest_point, but for what the nearest point of the surface hides: all behind the plane through
  /// it, square to the way there, or before that plane by less than `flat` (m). Other triangles of a wide
  /// wall cost nothing.
  template <class F>
  BL_HD void each_exposed_point(const Vec3d& x, double reach, double merge, double flat, F&& f) const {
    TrianglePoint first;
    std::uint32_t of = 0;
    first.distance2 = reach * reach;
    walk([&](const MeshNode& node) { return node.distance2(x) < first.distance2; },
         [&](std::uint32_t t) {
           const TrianglePoint at = nearest(t, x);
           if (at.distance2 < first.distance2) first = at, of = t;
         });
    if (!(first.distance2 < reach * reach)) return;
    const double distance = std::sqrt(first.distance2);
    const Vec3d towards = distance > 0 ? (x - first.point) * (1 / distance) : unit_normal(of);
    walk(
        [&](const MeshNode& node) {
          const double d2 = node.distance2(x);
          return d2 <= first.distance2 ||
                 (d2 <= reach * reach && node.extent(towards) > dot(first.point, towards) + flat);
        },
        [&](std::uint32_t t) { closest(t, x, reach, merge, f); });
  }
  /// Whether any of it is within `reach` (m) of x.
  BL_HD bool within(const Vec3d& x, double reach) const {
    bool found = false;
    walk([&](const MeshNode& node) { return !found && node.distance2(x) <= reach * reach; },
         [&](std::uint32_t t) { found = found || nearest(t, x).distance2 <= reach * reach; });
    return found;
  }

 private:
  /// visit(triangle) for those in leaves into which and above which enter(node) lets.
  template <class E, class V>
  BL_HD void walk(E&& enter, V&& visit) const {
    std::uint32_t stack[kMeshDepth];
    int due = 0;
    stack[due++] = 0;
    while (due > 0) {
      const std::uint32_t index = stack[--due];
      const MeshNode node = nodes[index];
      if (!enter(node)) continue;
      if (node.count == 0) {
        stack[due++] = node.next;
        stack[due++] = index + 1;
      }
      for (std::uint32_t t = node.next; t < node.next + node.count; ++t) visit(t);
    }
  }
  BL_HD TrianglePoint nearest(std::uint32_t t, const Vec3d& x) const {
    const Vec3d corners[3] = {corner(t, 0), corner(t, 1), corner(t, 2)};
    return nearest_on(corners, x);
  }
  BL_HD Vec3d corner(std::uint32_t t, int k) const { return vertices[triangles[t].corner[k]]; }
  BL_HD Vec3d unit_normal(std::uint32_t t) const {
    const Vec3d n = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    return n * (1 / norm(n));
  }

  /// The closest point that triangle t answers for: on its face, on an edge or at a corner of which it is the
  /// first.
  template <class F>
  BL_HD void closest(std::uint32_t t, const Vec3d& x, double reach, double merge, F& f) const {
    const TrianglePoint at = nearest(t, x);
    if (at.distance2 > reach * reach) return;
    const std::uint32_t key = 7 * t +
                              (at.feature == Feature::face ? 0 : (at.feature == Feature::edge ? 1 : 4)) +
                              std::uint32_t(at.index);
    Vec3d outward;
    if (at.feature == Feature::face) {
      outward = unit_normal(t);
      return f(outward, dot(x - at.point, outward), key);
    }
    if (at.feature == Feature::edge) {
      const std::uint32_t other = triangles[t].across[at.index];
      if (other < t || !shares(other, x, at.point, merge)) return;
      outward = unit_normal(t) + unit_normal(other);
    } else {
      const std::uint32_t v = triangles[t].corner[at.index];
      if (ring[ring_start[v]] != t) return;
      for (std::uint32_t k = ring_start[v]; k < ring_start[v + 1]; ++k) {
        if (!shares(ring[k], x, at.point, merge)) return;
        outward += angle_at(ring[k], v) * unit_normal(ring[k]);
      }
    }
    const Vec3d away = x - at.point;
    const double distance = norm(away), front = dot(away, outward) >= 0 ? 1.0 : -1.0;
    if (distance > 1e-9 * reach) return f(away * (front / distance), front * distance, key);
    f(outward * (1 / norm(outward)), 0.0, key);  // too close to have a direction
  }
  /// Whether a neighbour, too, is nearest to x at `point`.
  BL_HD bool shares(std::uint32_t t, const Vec3d& x, const Vec3d& point, double merge) const {
    return norm2(nearest(t, x).point - point) <= merge * merge;
  }
  BL_HD double angle_at(std::uint32_t t, std::uint32_t v) const {
    const MeshTriangle& c = triangles[t];
    const int k = c.corner[0] == v ? 0 : (c.corner[1] == v ? 1 : 2);
    const Vec3d a = corner(t, (k + 1) % 3) - corner(t, k), b = corner(t, (k + 2) % 3) - corner(t, k);
    return std::atan2(norm(cross(a, b)), dot(a, b));
  }
};

}  // namespace BL_SOLVER
