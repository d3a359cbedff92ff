#include "bedload/geometry/depth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "geometry/surface_point.hpp"

namespace bedload {

Vec3d upwards(const Vec3d& gravity) {
  const double g = norm(gravity);
  return g > 0 ? gravity * (-1 / g) : Vec3d{0, 0, 1};
}

LinePart line_in_box(const Vec3d& x, const Vec3d& up, const Vec3d& min, const Vec3d& max) {
  LinePart part{-1e300, 1e300};
  for (int k = 0; k < 3; ++k) {
    const double slack = 1e-9 * (max[k] - min[k]), lo = min[k] - slack - x[k], hi = max[k] + slack - x[k];
    if (up[k] == 0) {
      if (lo > 0 || hi < 0) return {1, -1};
      continue;
    }
    part.from = std::max(part.from, std::min(lo / up[k], hi / up[k]));
    part.to = std::min(part.to, std::max(lo / up[k], hi / up[k]));
  }
  return part;
}

std::vector<double> depth_in_columns(const std::vector<Vec3d>& x, const Vec3d& up, double spacing,
                                     const std::vector<double>& size) {
  const Vec3d along = perpendicular(up), across = cross(up, along);
  using Column = std::pair<std::int64_t, std::int64_t>;
  std::vector<Column> column;
  std::vector<double> height;
  for (const Vec3d& at : x) {
    column.emplace_back(std::floor(dot(along, at) / (2 * spacing)),
                        std::floor(dot(across, at) / (2 * spacing)));
    height.push_back(dot(up, at));
  }
  const auto size_of = [&](std::size_t a) { return size.empty() ? spacing : size[a]; };
  std::vector<std::size_t> order(x.size());  // column by column, from the top; of equals the largest is first
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(column[a], -height[a], -size_of(a), a) <
           std::tuple(column[b], -height[b], -size_of(b), b);
  });
  std::vector<double> depth(x.size());
  double top = 0;
  for (std::size_t n = 0; n < order.size(); ++n) {
    const std::size_t a = order[n];
    const bool connected =
        n > 0 && column[order[n - 1]] == column[a] && height[order[n - 1]] - height[a] <= 3 * spacing;
    if (!connected) top = height[a] + size_of(a) / 2;
    depth[a] = top - height[a];
  }
  return depth;
}

}  // namespace bedload
