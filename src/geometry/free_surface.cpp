#include <cmath>

#include "bedload/geometry/setup.hpp"
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

}  // namespace

bool has_free_surface(const Config& config, const Setup& setup) {
  const Setup::Fluid& fluid = setup.fluid;
  const DomainConfig& domain = config.domain;
  std::vector<double> spacing(fluid.x.size());
  double widest = config.fluid.dx;
  for (std::size_t a = 0; a < fluid.x.size(); ++a) {
    const double volume = fluid.mass[a] / config.fluid.rho0;
    spacing[a] = domain.two_d ? std::sqrt(volume / (domain.max.y - domain.min.y)) : std::cbrt(volume);
    widest = std::max(widest, spacing[a]);
  }
  std::vector<Vec3d> all = fluid.x;
  all.insert(all.end(), setup.walls.x.begin(), setup.walls.x.end());
  const PlaceCells cells(domain, widest, all);
  // a spacing and a quarter away, no farther from something than next to a curved wall
  for (std::size_t a = fluid.x.size(); a-- > 0;)  // lattices end at their top
    for (int side = 5; side >= 0; --side) {
      const int k = side / 2;
      if (domain.flat(k)) continue;
      Vec3d x = fluid.x[a];
      x[k] += (side % 2 ? 1.25 : -1.25) * spacing[a];
      if (!cells.any(x, spacing[a], [](std::size_t, double) { return true; }) && !behind_mirror(domain, x))
        return true;
    }
  return false;
}

}  // namespace bedload
