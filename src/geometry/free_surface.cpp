#include <algorithm>
#include <cmath>

#include "bedload/geometry/setup.hpp"
#include "first_where.hpp"
#include "place_cells.hpp"

namespace bedload {
namespace {

/// Beyond a reflecting side of the domain, where no wall supports the fluid.
bool behind_mirror(const DomainConfig& domain, const Vec3d& x) {
  const ReflectConfig& r = domain.reflect;
  for (int k = 0; k < 3; ++k)
    if (!domain.periodic[k] && ((x[k] < domain.min[k] && (r.slip[2 * k] || r.no_slip[2 * k])) ||
                                (x[k] > domain.max[k] && (r.slip[2 * k + 1] || r.no_slip[2 * k + 1]))))
      return true;
  return false;
}

double spacing_of(const Config& config, double mass) {
  const DomainConfig& domain = config.domain;
  const double volume = mass / config.fluid.rho0;
  return domain.two_d ? std::sqrt(volume / (domain.max.y - domain.min.y)) : std::cbrt(volume);
}

/// empty(place, reach) for places beside particle a until it is true of one: a spacing and a quarter away, no
/// farther from something than next to a curved wall. Whether it was.
template <class Empty>
bool empty_beside(const Config& config, const Setup::Fluid& fluid, std::size_t a, const Empty& empty) {
  const double spacing = spacing_of(config, fluid.mass[a]);
  for (int side = 5; side >= 0; --side) {
    const int k = side / 2;
    if (config.domain.flat(k)) continue;
    Vec3d x = fluid.x[a];
    x[k] += (side % 2 ? 1.25 : -1.25) * spacing;
    if (!behind_mirror(config.domain, x) && empty(x, spacing)) return true;
  }
  return false;
}

/// Whether none of `places` is within `reach` of x, m: without cells, which take long where there are many.
bool all_beyond(const DomainConfig& domain, const std::vector<Vec3d>& places, const Vec3d& x, double reach) {
  const auto near = [&](std::size_t n) {
    Vec3d r = places[n] - x;
    for (int k = 0; k < 3; ++k)
      if (const double period = domain.max[k] - domain.min[k]; domain.periodic[k])
        r[k] -= period * std::round(r[k] / period);
    return norm2(r) <= reach * reach;
  };
  return first_where(0, places.size(), near) == places.size();
}

}  // namespace

bool has_free_surface(const Config& config, const Setup& setup) {
  const Setup::Fluid& fluid = setup.fluid;
  const DomainConfig& domain = config.domain;
  const std::size_t n = fluid.x.size();
  const auto nothing_at = [&](const Vec3d& x, double reach) {
    return all_beyond(domain, setup.walls.x, x, reach) && all_beyond(domain, fluid.x, x, reach);
  };
  // lattices end at their top
  if (n > 100000 && empty_beside(config, fluid, n - 1, nothing_at)) return true;
  double widest = config.fluid.dx;
  for (const double mass : fluid.mass) widest = std::max(widest, spacing_of(config, mass));
  std::vector<Vec3d> all = fluid.x;
  all.insert(all.end(), setup.walls.x.begin(), setup.walls.x.end());
  const PlaceCells cells(domain, widest, all);
  const auto no_other = [&](const Vec3d& x, double reach) {
    return !cells.any(x, reach, [](std::size_t, double) { return true; });
  };
  return first_where(0, n, [&](std::size_t a) { return empty_beside(config, fluid, n - 1 - a, no_other); }) <
         n;
}

}  // namespace bedload
