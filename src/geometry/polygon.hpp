#pragma once
// Plane polygons cut into triangles.

#include <algorithm>
#include <vector>

#include "bedload/geometry/mesh.hpp"

namespace bedload {

constexpr std::size_t kMostCorners = 4096;  ///< of one polygon

/// Adds the triangles of a polygon, convex or not, by cutting off ears [meisters75]. `corners`: places of its
/// vertices in `soup`, in order; fewer than three are no polygon. One that lies on a line or crosses itself
/// is cut as a fan, for the checks of the mesh to report.
inline void add_polygon(TriangleSoup& soup, std::vector<std::uint32_t> corners) {
  if (corners.size() < 3) return;
  const auto at = [&](std::size_t k) { return soup.vertices[corners[k % corners.size()]]; };
  Vec3d area;  // twice, by Newell
  for (std::size_t k = 0; k < corners.size(); ++k) area += cross(at(k) - at(0), at(k + 1) - at(0));
  // positive where b -> c turns the way the polygon turns
  const auto turn = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return dot(cross(b - a, c - b), area);
  };
  const auto is_ear = [&](std::size_t k) {
    const std::size_t n = corners.size();
    const Vec3d a = at(k + n - 1), b = at(k), c = at(k + 1);
    if (!(turn(a, b, c) > 0)) return false;
    for (std::size_t l = k + 2; l < k + n - 1; ++l) {
      const Vec3d p = at(l);
      if (turn(at(l + n - 1), p, at(l + 1)) <= 0 && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
          turn(c, a, p) >= 0 && p != a && p != b && p != c)
        return false;
    }
    return true;
  };
  const auto cut = [&](std::size_t k) {
    const std::size_t n = corners.size();
    soup.triangles.push_back({corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]});
    corners.erase(corners.begin() + std::ptrdiff_t(k));
  };
  while (corners.size() > 3) {
    std::size_t ear = 0;
    while (ear < corners.size() && !is_ear(ear)) ++ear;
    if (ear == corners.size()) {  // a fan
      while (corners.size() > 3) cut(1);
      break;
    }
    cut(ear);
  }
  cut(1);
}

}  // namespace bedload
