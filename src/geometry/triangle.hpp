#pragma once
// One triangle: its nearest point, whether it meets another.

#include <algorithm>
#include <array>
#include <cmath>

#include "bedload/geometry/triangle_point.hpp"

namespace bedload {

using Corners = std::array<Vec3d, 3>;

/// Twice the area, along the normal.
inline Vec3d area_vector(const Corners& t) { return cross(t[1] - t[0], t[2] - t[0]); }

inline Vec3d unit_normal(const Corners& t) {
  const Vec3d n = area_vector(t);
  return n / norm(n);
}

/// The least of its three heights, m; 0 for three corners on a line.
inline double least_height(const Corners& t) {
  const double longest2 = std::max({norm2(t[1] - t[0]), norm2(t[2] - t[1]), norm2(t[0] - t[2])});
  return longest2 > 0 ? norm(area_vector(t)) / std::sqrt(longest2) : 0;
}

inline TrianglePoint nearest_on(const Corners& t, const Vec3d& x) {
  const Vec3d corners[3] = {t[0], t[1], t[2]};
  return nearest_on(corners, x);
}

/// Whether two triangles pass through each other, or cover each other in one plane, by more than `depth`, m;
/// mere contact at corners, edges or sides does not count. By separating axes: of the difference of the two
/// as point sets, which holds the origin inside if they meet, these are the normals of all sides.
inline bool intersect(const Corners& a, const Corners& b, double depth) {
  const auto separated = [&](Vec3d axis) {
    const double length2 = norm2(axis);
    if (length2 == 0) return false;
    const Vec3d from = a[0];  // near both, for the sake of round-off
    double a_min = INFINITY, a_max = -INFINITY, b_min = INFINITY, b_max = -INFINITY;
    for (int k = 0; k < 3; ++k) {
      const double pa = dot(a[k] - from, axis), pb = dot(b[k] - from, axis);
      a_min = std::min(a_min, pa), a_max = std::max(a_max, pa);
      b_min = std::min(b_min, pb), b_max = std::max(b_max, pb);
    }
    return std::min(a_max - b_min, b_max - a_min) <= depth * std::sqrt(length2);
  };
  const auto height_over = [](const Corners& plane, const Vec3d& n, const Corners& t) {
    double h = 0;
    for (const Vec3d& corner : t) h = std::max(h, std::abs(dot(corner - plane[0], n)));
    return h;
  };
  const Vec3d na = unit_normal(a), nb = unit_normal(b);
  if (height_over(a, na, b) <= depth || height_over(b, nb, a) <= depth) {
    for (int k = 0; k < 3; ++k)
      if (separated(cross(na, a[(k + 1) % 3] - a[k])) || separated(cross(nb, b[(k + 1) % 3] - b[k])))
        return false;
    return true;
  }
  if (separated(na) || separated(nb)) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vec3d ea = a[(i + 1) % 3] - a[i], eb = b[(j + 1) % 3] - b[j], axis = cross(ea, eb);
      const bool parallel = norm2(axis) <= 1e-20 * norm2(ea) * norm2(eb);  // no direction beyond round-off
      if (!parallel && separated(axis)) return false;
    }
  return true;
}

}  // namespace bedload
