#pragma once
// Filters: walls that stop grains and let fluid pass.

#include <functional>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/geometry/shape.hpp"

namespace bedload {

/// Ways through or between solids for a sphere.
struct Passages {
  int count = 0;  ///< independent ones
  double width =
      0;  ///< diameter of the largest sphere that finds one, m; up to a tenth and a cell below that
  bool seen = false;  ///< false: the box is too large to be looked at finely enough
};

/// The ways of a sphere of `diameter` through the solids of signed distance `distance`, m, inside `box`,
/// whose surroundings count as open. They are the tunnels of the solids grown by its radius (their first
/// Betti number) on a raster of a quarter of that, so that those wider than the sphere by less may be missed.
Passages find_passages(const std::function<double(const Vec3d&)>& distance, const Bounds& box,
                       double diameter);

/// Warns of each wall body of a named shape and of type grains_only that the smallest grains can pass, at t =
/// 0, through its holes or between it and the other walls around it.
void check_filters(const Config& config, std::vector<std::string>& warnings);

}  // namespace bedload
