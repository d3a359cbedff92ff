#pragma once
// The point of a triangle nearest to some place, the same on host and device.

#include "bedload/core/vec.hpp"

namespace bedload {

enum class Feature { face, edge, vertex };

/// Nearest point and the face, edge (from corner `index` to the next) or vertex `index` it lies on.
struct TrianglePoint {
  Vec3d point;
  double distance2 = 0;  ///< m2
  Feature feature = Feature::face;
  int index = 0;
};

/// t: the three corners.
BL_HD TrianglePoint nearest_on(const Vec3d (&t)[3], const Vec3d& x) {
  const Vec3d n = cross(t[1] - t[0], t[2] - t[0]);
  bool above_face = true;
  for (int k = 0; k < 3; ++k) above_face = above_face && dot(cross(t[(k + 1) % 3] - t[k], x - t[k]), n) > 0;
  TrianglePoint nearest;
  if (above_face) {
    const double height = dot(x - t[0], n) / norm2(n);
    nearest.point = x - height * n;
    nearest.distance2 = height * height * norm2(n);
    return nearest;
  }
  nearest.distance2 = 1e300;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const Vec3d along = t[next] - t[k];
    const double s = dot(x - t[k], along) / norm2(along);
    const Vec3d point = s <= 0 ? t[k] : (s >= 1 ? t[next] : t[k] + s * along);
    const double d2 = norm2(x - point);
    if (!(d2 < nearest.distance2)) continue;
    nearest.point = point;
    nearest.distance2 = d2;
    nearest.feature = s > 0 && s < 1 ? Feature::edge : Feature::vertex;
    nearest.index = s >= 1 ? next : k;
  }
  return nearest;
}

}  // namespace bedload
