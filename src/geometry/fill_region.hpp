#pragma once
// What a fluid.fill occupies.

#include <algorithm>
#include <limits>

#include "bedload/case/config.hpp"
#include "bedload/geometry/shape.hpp"

namespace bedload {

/// Depth of x in the box or shape of `fill`, up to its level, m; negative outside. Particles of a file occupy
/// none.
inline double depth_in(const FluidFill& fill, const Vec3d& up, const Vec3d& x) {
  if (!fill.file.empty()) return -std::numeric_limits<double>::infinity();
  if (fill.solid.shape) return std::min(-fill.solid.shape->distance(x), fill.level - dot(up, x));
  double depth = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) depth = std::min({depth, x[k] - fill.min[k], fill.max[k] - x[k]});
  return depth;
}

}  // namespace bedload
