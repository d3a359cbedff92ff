#pragma once
// A closed surface of triangles as kernels see it: its own tree of boxes, closest points by local minima.

#include <cmath>
#include <cstdint>

#include "bedload/core/types.hpp"
#include "bedload/geometry/mesh_layout.hpp"
#include "bedload/geometry/triangle_point.hpp"

namespace BL_SOLVER {

/// How closest points of a mesh are sought.
struct MeshSearch {
  double merge;  ///< points of neighbouring triangles closer than this (m) count as one: a closest point that
                 ///< lies on an edge by round-off
  double hides = -1;  ///< from 0 on: without those that the nearest one hides, behind the plane through it,
                      ///< square to the way there, or before it by this share of that way
  std::uint32_t near = kNone;  ///< a triangle that is likely to be near

  BL_HD MeshSearch(double merge) : merge(merge) {}
};

struct MeshView {
  const MeshNode* nodes = nullptr;
  const Vec3d* vertices = nullptr;            ///< from the mesh's centre, m
  const MeshTriangle* triangles = nullptr;    ///< in the order of the tree's leaves
  const std::uint32_t* ring_start = nullptr;  ///< [vertices + 1]
  const std::uint32_t* ring = nullptr;        ///< triangles around each vertex, ascending
  std::uint32_t count = 0;                    ///< of triangles
  double edge = 0;                            ///< mean length, m

  /// Of a feature: a triangle to which it belongs.
  BL_HD static std::uint32_t triangle_of(std::uint32_t feature) { return feature / 7; }

  /// Whether it pays to find the nearest point first.
  BL_HD bool fine(double reach) const { return reach > 5 * edge; }

  /// f(normal, signed distance, feature) for every closest point no farther than `reach` (m) from x. Behind
  /// the surface nothing is hidden.
  template <class F>
  BL_HD void each_closest_point(const Vec3d& x, double reach, const MeshSearch& search, F&& f) const {
    Front front;
    if (search.hides >= 0) {
      const Nearest first = nearest_within(x, reach, search.near);
      if (first.triangle == kNone) return;
      if (dot(x - first.at.point, outward(first.triangle, first.at)) > 0)
        front = before(first, x, search.hides * std::sqrt(first.at.distance2));
    }
    each_closest_point(front, x, reach, search.merge, f);
  }
  /// As each_closest_point, on both sides of the surface, but for what the nearest point hides: all behind
  /// the plane through it, square to the way there, or before that plane by less than `flat` (m). Other
  /// triangles of a wide wall cost nothing.
  template <class F>
  BL_HD void each_exposed_point(const Vec3d& x, double reach, double merge, double flat, F&& f) const {
    const Nearest first = nearest_within(x, reach, kNone);
    if (first.triangle != kNone) each_closest_point(before(first, x, flat), x, reach, merge, f);
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
  struct Nearest {
    TrianglePoint at;
    std::uint32_t triangle = kNone;
  };
  /// The nearest point of all, if closer than `reach` (m). likely: a triangle near it, or kNone.
  BL_HD Nearest nearest_within(const Vec3d& x, double reach, std::uint32_t likely) const {
    Nearest first;
    first.at.distance2 = reach * reach;
    const auto meet = [&](std::uint32_t t) {
      const TrianglePoint at = nearest(t, x);
      if (at.distance2 < first.at.distance2) first = {at, t};
    };
    if (likely < count) meet(likely);
    walk([&](const MeshNode& node) { return node.distance2(x) < first.at.distance2; }, meet);
    return first;
  }
  /// What the nearest point does not hide: boxes that hold it, or reach before a plane.
  struct Front {
    bool all = true;
    double distance2 = 0;  ///< of the nearest point, m2
    Vec3d towards;         ///< unit normal of the plane
    double plane = 0;      ///< its place along that, m
    BL_HD bool shows(const MeshNode& node, double d2) const {
      return all || d2 <= distance2 || node.extent(towards) > plane;
    }
  };
  /// flat: how far before the nearest point, m.
  BL_HD Front before(const Nearest& first, const Vec3d& x, double flat) const {
    const double d2 = first.at.distance2;
    Front front;
    front.all = false;
    front.distance2 = (1 + 1e-9) * d2;  // round-off must not lose it
    front.towards = d2 > 0 ? (x - first.at.point) * (1 / std::sqrt(d2)) : unit_normal(first.triangle);
    front.plane = dot(first.at.point, front.towards) + flat;
    return front;
  }
  template <class F>
  BL_HD void each_closest_point(const Front& front, const Vec3d& x, double reach, double merge, F& f) const {
    walk(
        [&](const MeshNode& node) {
          const double d2 = node.distance2(x);
          return d2 <= reach * reach && front.shows(node, d2);
        },
        [&](std::uint32_t t) { closest(t, x, reach, merge, f); });
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
    if (at.feature == Feature::face) {
      const Vec3d n = unit_normal(t);
      return f(n, dot(x - at.point, n), key);
    }
    if (at.feature == Feature::edge) {
      const std::uint32_t other = triangles[t].across[at.index];
      if (other < t || !shares(other, x, at.point, merge)) return;
    } else {
      const std::uint32_t v = triangles[t].corner[at.index];
      if (ring[ring_start[v]] != t) return;
      for (std::uint32_t k = ring_start[v]; k < ring_start[v + 1]; ++k)
        if (!shares(ring[k], x, at.point, merge)) return;
    }
    const Vec3d away = x - at.point, out = outward(t, at);
    const double distance = norm(away), front = dot(away, out) >= 0 ? 1.0 : -1.0;
    if (distance > 1e-9 * reach) return f(away * (front / distance), front * distance, key);
    f(out * (1 / norm(out)), 0.0, key);  // too close to have a direction
  }
  /// Out of the solid at a point of triangle t: its normal, or the sum of those that meet there, at a corner
  /// by their angles. Not a unit vector.
  BL_HD Vec3d outward(std::uint32_t t, const TrianglePoint& at) const {
    if (at.feature == Feature::face) return unit_normal(t);
    if (at.feature == Feature::edge) return unit_normal(t) + unit_normal(triangles[t].across[at.index]);
    const std::uint32_t v = triangles[t].corner[at.index];
    Vec3d sum;
    for (std::uint32_t k = ring_start[v]; k < ring_start[v + 1]; ++k)
      sum += angle_at(ring[k], v) * unit_normal(ring[k]);
    return sum;
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
