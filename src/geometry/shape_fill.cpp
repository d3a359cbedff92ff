#include "geometry/shape_fill.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "bedload/geometry/build_shape.hpp"
#include "bedload/geometry/lattice.hpp"
#include "bedload/parallel/host_loop.hpp"

namespace bedload {
namespace {

/// What is filled: the shape up to its level.
struct Region {
  const Shape& shape;
  Vec3d up;
  double level;

  /// Seen from within: distance to the boundary, m, and the way out.
  SurfacePoint nearest(const Vec3d& x) const {
    const SurfacePoint wall = shape.nearest(x);
    const double above = dot(up, x) - level;
    return above > wall.distance ? SurfacePoint{above, x - above * up, up} : wall;
  }
  Bounds bounds() const {
    Bounds b = shape.bounds();
    if (std::isinf(level)) return b;
    for (int k = 0; k < 3; ++k)  // exact where `up` is an axis
      if (std::abs(up[k]) > 1 - 1e-12) (up[k] > 0 ? b.max : b.min)[k] = up[k] * level;
    return b;
  }
};

/// The lattice places that lie deepest, as many as the volume holds.
std::vector<Vec3d> deepest_places(const Region& region, double spacing, double volume) {
  const Bounds bounds = region.bounds();
  std::array<Cells, 3> cells;
  double cell = 1;
  for (int k = 0; k < 3; ++k) {
    cells[k] = fit_cells(bounds.min[k], bounds.max[k], spacing);
    cell *= cells[k].step;
  }
  struct Place {
    double depth;
    Vec3d x;
  };
  std::vector<std::vector<Place>> slabs(cells[2].count);
  host_for_each(slabs.size(), [&](std::size_t l) {
    for (std::int64_t j = 0; j < cells[1].count; ++j)
      for (std::int64_t i = 0; i < cells[0].count; ++i) {
        const Vec3d x{cells[0].centre(i), cells[1].centre(j), cells[2].centre(std::int64_t(l))};
        const double depth = -region.nearest(x).distance;
        if (depth > -spacing) slabs[l].push_back({depth, x});
      }
  });
  std::vector<double> depths;
  for (const auto& slab : slabs)
    for (const Place& p : slab) depths.push_back(p.depth);
  const std::size_t wanted = std::min(depths.size(), std::size_t(std::llround(volume / cell)));
  // what is thinner than its raster has a volume by that, but no place
  if (wanted == 0 || *std::max_element(depths.begin(), depths.end()) < 1e-9 * spacing) return {};
  const auto last = depths.end() - std::ptrdiff_t(wanted);
  std::nth_element(depths.begin(), last, depths.end());
  const double least = *last - 1e-9 * spacing;  // places alike stay together
  std::vector<Vec3d> places;
  for (const auto& slab : slabs)
    for (const Place& p : slab)
      if (p.depth >= least) places.push_back(p.x);
  return places;
}

/// Points in cells as wide as they act on each other.
class Neighbours {
 public:
  Neighbours(const std::vector<Vec3d>& points, double width) : points_(points), width_(width) {
    for (const Vec3d& x : points) bounds_.add(x);
    std::int64_t cells = 1;
    for (int k = 0; k < 3; ++k) {
      count_[k] = 1 + std::int64_t((bounds_.max[k] - bounds_.min[k]) / width);
      cells *= count_[k];
    }
    start_.assign(std::size_t(cells) + 1, 0);
    for (const Vec3d& x : points) ++start_[index(cell(x)) + 1];
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    order_.resize(points.size());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::uint32_t n = 0; n < points.size(); ++n) order_[next[index(cell(points[n]))]++] = n;
  }
  template <class F>
  void each(const Vec3d& x, const F& f) const {
    const auto at = cell(x);
    for (std::int64_t l = std::max<std::int64_t>(0, at[2] - 1); l <= std::min(at[2] + 1, count_[2] - 1); ++l)
      for (std::int64_t j = std::max<std::int64_t>(0, at[1] - 1); j <= std::min(at[1] + 1, count_[1] - 1);
           ++j)
        for (std::int64_t i = std::max<std::int64_t>(0, at[0] - 1); i <= std::min(at[0] + 1, count_[0] - 1);
             ++i) {
          const std::size_t c = index({i, j, l});
          for (std::uint32_t n = start_[c]; n < start_[c + 1]; ++n) f(order_[n]);
        }
  }

 private:
  std::array<std::int64_t, 3> cell(const Vec3d& x) const {
    std::array<std::int64_t, 3> c;
    for (int k = 0; k < 3; ++k)
      c[k] = std::clamp<std::int64_t>(std::int64_t((x[k] - bounds_.min[k]) / width_), 0, count_[k] - 1);
    return c;
  }
  std::size_t index(const std::array<std::int64_t, 3>& c) const {
    return std::size_t((c[2] * count_[1] + c[1]) * count_[0] + c[0]);
  }

  const std::vector<Vec3d>& points_;
  double width_;
  Bounds bounds_;
  std::array<std::int64_t, 3> count_;
  std::vector<std::uint32_t> start_, order_;
};

/// Lets places near the boundary push each other apart, none nearer to it than half a spacing.
void relax(const Region& region, double spacing, std::vector<Vec3d>& places) {
  constexpr int kSweeps = 80;
  const double reach = 1.6 * spacing, layer = 4 * spacing;
  std::vector<std::uint8_t> free(places.size());
  std::vector<double> clear(places.size());  // least depth of each place, m
  host_for_each(places.size(), [&](std::size_t n) {
    clear[n] = -region.nearest(places[n]).distance;
    free[n] = clear[n] < layer;
  });
  std::vector<Vec3d> next = places;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const Neighbours neighbours(places, reach);
    host_for_each(places.size(), [&](std::size_t n) {
      if (!free[n]) return;
      Vec3d push;
      neighbours.each(places[n], [&](std::uint32_t m) {
        const Vec3d apart = places[n] - places[m];
        const double r2 = norm2(apart);
        if (m == n || r2 >= reach * reach) return;
        const double r = std::sqrt(r2), closeness = 1 - r / reach;
        push += (0.3 * spacing * closeness * closeness / (r + 1e-6 * spacing)) * apart;
      });
      const double length = norm(push);
      Vec3d x = places[n] + (length > 0.1 * spacing ? 0.1 * spacing / length : 1) * push;
      clear[n] -= std::min(length, 0.1 * spacing);
      for (int side = 0; side < 6 && clear[n] < 0.501 * spacing; ++side) {  // in a corner one after the other
        const SurfacePoint at = region.nearest(x);
        clear[n] = -at.distance;
        if (at.distance <= -0.5 * spacing) break;
        x -= (at.distance + 0.5 * spacing) * at.normal;
        clear[n] = 0;
      }
      next[n] = x;
    });
    places = next;
  }
}

}  // namespace

std::vector<Vec3d> fill_shape(const Shape& shape, const Vec3d& up, double level, double spacing,
                              double& volume) {
  const Region region{shape, up, level};
  volume = volume_below(shape, up, level, spacing / 4);
  std::vector<Vec3d> places = deepest_places(region, spacing, volume);
  if (!places.empty()) relax(region, std::cbrt(volume / double(places.size())), places);
  return places;
}

}  // namespace bedload
