#include "bedload/geometry/filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "bedload/geometry/sampling.hpp"
#include "bedload/parallel/host_loop.hpp"

namespace bedload {
namespace {

constexpr double kMostCells = 8e6;

/// Cells of a raster, with one layer around it that is always open.
class Raster {
 public:
  Raster(const std::function<double(const Vec3d&)>& distance, const Bounds& box, double step) {
    std::array<double, 3> start;
    for (int k = 0; k < 3; ++k) {
      const double length = box.max[k] - box.min[k];
      n_[k] = std::int64_t(std::ceil(length / step - 1e-6)) + 2;
      start[k] = 0.5 * (box.min[k] + box.max[k]) - 0.5 * double(n_[k]) * step;
    }
    distance_.assign(std::size_t(n_[0] * n_[1] * n_[2]), float(INFINITY));
    host_for_each(std::size_t(n_[2] - 2), [&](std::size_t slab) {
      const std::int64_t k = std::int64_t(slab) + 1;
      for (std::int64_t j = 1; j < n_[1] - 1; ++j)
        for (std::int64_t i = 1; i < n_[0] - 1; ++i)
          distance_[at(i, j, k)] =
              float(distance({start[0] + step * (double(i) + 0.5), start[1] + step * (double(j) + 0.5),
                              start[2] + step * (double(k) + 0.5)}));
    });
  }

  /// Tunnels of the cells nearer to the solids than `radius`, as closed cubes: pieces + cavities - Euler
  /// number.
  int tunnels(double radius) const {
    std::vector<std::uint8_t> solid(distance_.size());
    for (std::size_t c = 0; c < solid.size(); ++c) solid[c] = distance_[c] < radius;
    // cubes touch by their corners, the open between them by its faces; all around is no cavity
    return pieces(solid, 1, 3) + (pieces(solid, 0, 1) - 1) - euler_number(solid);
  }

 private:
  std::size_t at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return std::size_t((k * n_[1] + j) * n_[0] + i);
  }

  /// Connected pieces of the cells that are `kind`; neighbours differ along up to `axes` axes.
  int pieces(const std::vector<std::uint8_t>& solid, std::uint8_t kind, int axes) const {
    std::vector<std::uint8_t> seen(solid.size(), 0);
    std::vector<std::size_t> due;
    int count = 0;
    for (std::size_t seed = 0; seed < solid.size(); ++seed) {
      if (solid[seed] != kind || seen[seed]) continue;
      ++count;
      seen[seed] = 1;
      due.assign(1, seed);
      while (!due.empty()) {
        const std::int64_t c = std::int64_t(due.back());
        due.pop_back();
        const std::int64_t i = c % n_[0], j = c / n_[0] % n_[1], k = c / (n_[0] * n_[1]);
        for (int step = 0; step < 27; ++step) {
          const int di = step % 3 - 1, dj = step / 3 % 3 - 1, dk = step / 9 - 1;
          if (std::abs(di) + std::abs(dj) + std::abs(dk) > axes) continue;
          const std::int64_t x = i + di, y = j + dj, z = k + dk;
          if (x < 0 || y < 0 || z < 0 || x >= n_[0] || y >= n_[1] || z >= n_[2]) continue;
          const std::size_t other = at(x, y, z);
          if (solid[other] != kind || seen[other]) continue;
          seen[other] = 1;
          due.push_back(other);
        }
      }
    }
    return count;
  }

  /// Corners - edges + faces - cubes. Each corner between eight cells answers for what lies on its upper
  /// side.
  int euler_number(const std::vector<std::uint8_t>& solid) const {
    std::vector<int> slabs(std::size_t(n_[2] - 1));
    host_for_each(slabs.size(), [&](std::size_t slab) {
      const std::int64_t k = std::int64_t(slab);
      int sum = 0;
      for (std::int64_t j = 0; j + 1 < n_[1]; ++j)
        for (std::int64_t i = 0; i + 1 < n_[0]; ++i) {
          bool s[2][2][2];
          bool any = false;
          for (int c = 0; c < 8; ++c) {
            const bool on = solid[at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))] != 0;
            s[c & 1][c >> 1 & 1][c >> 2] = on;
            any |= on;
          }
          if (!any) continue;
          const int edges = (s[1][0][0] || s[1][1][0] || s[1][0][1] || s[1][1][1]) +
                            (s[0][1][0] || s[1][1][0] || s[0][1][1] || s[1][1][1]) +
                            (s[0][0][1] || s[1][0][1] || s[0][1][1] || s[1][1][1]);
          const int faces =
              (s[1][1][0] || s[1][1][1]) + (s[1][0][1] || s[1][1][1]) + (s[0][1][1] || s[1][1][1]);
          sum += 1 - edges + faces - s[1][1][1];
        }
      slabs[slab] = sum;
    });
    int sum = 0;
    for (const int slab : slabs) sum += slab;
    return sum;
  }

  std::array<std::int64_t, 3> n_;
  std::vector<float> distance_;  // m
};

}  // namespace

Passages find_passages(const std::function<double(const Vec3d&)>& distance, const Bounds& box,
                       double diameter) {
  const Vec3d side = box.max - box.min;
  const double radius = diameter / 2, step = radius / 4;
  if (side.x * side.y * side.z > kMostCells * step * step * step) return {};
  const Raster raster(distance, box, step);
  Passages found{raster.tunnels(radius), diameter, true};
  if (found.count <= 0) return {0, 0, true};
  double wide = radius, closed = radius;
  while (wide == closed && closed < norm(side)) {
    closed *= 1.5;
    if (raster.tunnels(closed) > 0) wide = closed;
  }
  while (closed > 1.1 * wide) {
    const double middle = std::sqrt(wide * closed);
    (raster.tunnels(middle) > 0 ? wide : closed) = middle;
  }
  found.width = 2 * wide;
  return found;
}

void check_filters(const Config& config, std::vector<std::string>& warnings) {
  const double d = config.grain.d_min;
  for (const WallBody& filter : config.wall.bodies) {
    if (filter.stops_fluid() || !filter.solid.shape) continue;
    const Bounds box = filter.solid.shape->bounds().grown(2 * d);
    const auto distance = [&](const Vec3d& x) {
      double least = INFINITY;
      for (const WallBody& body : config.wall.bodies)
        if (body.stops_grains()) least = std::min(least, wall_clearance(body, x, d, config.domain));
      return least;
    };
    const Passages ways = find_passages(distance, box, d);
    if (!ways.seen)
      warnings.push_back(
          fmt::format("wall.body \"{}\": not searched for openings that grains pass; it is too large against "
                      "grains of {:g} m",
                      filter.name, d));
    if (ways.count > 0)
      warnings.push_back(
          fmt::format("wall.body \"{}\": grains of {:g} m pass through it or past it, by {} opening{} up "
                      "to {:.2g} m wide",
                      filter.name, d, ways.count, ways.count > 1 ? "s" : "", ways.width));
  }
}

}  // namespace bedload
