#pragma once
// Fluid and grains in a box, without any dynamics of their own: what the coupling sees.

#include <algorithm>
#include <random>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/neighbours/for_each_pair.hpp"
#include "kernels/smoothing/registry.hpp"
#include "src/coupling/coupling.hpp"

namespace BL_SOLVER {

struct Cloud {
  std::vector<Vec3d> x, v;                 ///< m, m/s
  std::vector<double> mass, rho, eps;      ///< kg, kg/m3, -
  std::vector<Vec3d> stress_acceleration;  ///< m/s2
};
struct Pebbles {
  std::vector<Vec3d> x, v, omega;  ///< m, m/s, rad/s
  std::vector<double> radius;      ///< m
};

/// Random vectors with components that are multiples of 1/1024, so that adding small integers rounds nothing.
inline std::vector<Vec3d> random_vectors(std::size_t n, double size, std::mt19937_64& random) {
  std::uniform_int_distribution<int> component(-int(size * 1024), int(size * 1024));
  std::vector<Vec3d> all(n);
  for (auto& v : all)
    v = {component(random) / 1024.0, component(random) / 1024.0, component(random) / 1024.0};
  return all;
}
inline std::vector<Vec3d> random_points(std::size_t n, const Vec3d& min, const Vec3d& max,
                                        std::mt19937_64& random) {
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Vec3d> all(n);
  for (auto& x : all)
    x = {min.x + u(random) * (max.x - min.x), min.y + u(random) * (max.y - min.y),
         min.z + u(random) * (max.z - min.z)};
  return all;
}
/// Centres of the cells of edge dx that fill a box.
inline std::vector<Vec3d> lattice(const Vec3d& min, const Vec3d& max, double dx) {
  std::vector<Vec3d> all;
  const auto cells = [&](int k) { return int((max[k] - min[k]) / dx + 0.5); };
  for (int iz = 0; iz < cells(2); ++iz)
    for (int iy = 0; iy < cells(1); ++iy)
      for (int ix = 0; ix < cells(0); ++ix) all.push_back(min + Vec3d(ix + 0.5, iy + 0.5, iz + 0.5) * dx);
  return all;
}
/// Fluid at rest of density rho (kg/m3) and one porosity, a particle for each dx^3 of fluid and grains.
inline Cloud fluid_at(const std::vector<Vec3d>& x, double dx, double rho, double eps) {
  const std::size_t n = x.size();
  return {x,
          std::vector<Vec3d>(n),
          std::vector<double>(n, eps * rho * dx * dx * dx),
          std::vector<double>(n, rho),
          std::vector<double>(n, eps),
          std::vector<Vec3d>(n)};
}
/// Irregular fluid: masses, densities and porosities differ.
inline Cloud random_fluid(std::size_t n, const Vec3d& min, const Vec3d& max, double rho,
                          std::mt19937_64& random) {
  const double volume = (max.x - min.x) * (max.y - min.y) * (max.z - min.z) / n;
  std::uniform_real_distribution<double> porosity(0.4, 1.0), factor(0.7, 1.3);
  Cloud c{random_points(n, min, max, random), random_vectors(n, 1, random), {}, {}, {},
          random_vectors(n, 9, random)};
  for (std::size_t a = 0; a < n; ++a) {
    c.eps.push_back(porosity(random));
    c.rho.push_back(rho);
    c.mass.push_back(factor(random) * c.eps[a] * rho * volume);
  }
  return c;
}
inline Pebbles random_grains(std::size_t n, const Vec3d& min, const Vec3d& max, double d,
                             std::mt19937_64& random) {
  return {random_points(n, min, max, random), random_vectors(n, 1, random), random_vectors(n, 5, random),
          std::vector<double>(n, d / 2)};
}

template <class To, class From>
std::vector<To> converted(const std::vector<From>& from) {
  std::vector<To> to;
  for (const auto& f : from) to.push_back(To(f));
  return to;
}

/// Places as pair loops read them, with M.
struct PackFluid {
  Frame frame;
  Span<const FluidPosition> x;
  Span<const EosState<>> state;
  Span<PairPosition> xp;
  BL_HD void operator()(Index a) const {
    xp[a] = pair_position(frame, coordinates(frame, x[a]), state[a].mass_over_eps);
  }
};

/// Both stores, sorted into cells, with a coupling whose lists are built.
struct CoupledBox {
  Config config;
  Frame frame;
  FluidStore fluid;
  GrainStore grains;
  WallGeometry walls;
  Coupling coupling;

  static constexpr double kSkin = 0.1;  ///< of the range

  CoupledBox(const Config& c, const Cloud& cloud, const Pebbles& pebbles)
      : config(c),
        frame(c.domain.min, c.domain.max, c.domain.periodic[0], c.domain.periodic[1], c.domain.periodic[2]),
        walls(c.wall.bodies, c.domain),
        coupling(coupling_parameters(c), frame, walls) {
    fill(cloud);
    fill(pebbles);
    relist();
  }
  /// The same with grains in levels of size; how many there are.
  int relist_by_size() {
    SizeLevels levels(frame);
    const auto radius = grains.radius.values();
    levels.choose(radius, double(*std::max_element(radius.begin(), radius.end())), 1e-3);
    if (levels.count() > 1) relist(true, &levels);
    return levels.count();
  }
  /// Sorts both phases and renews the lists; or grains stay as they are stored. still: poses of walls that
  /// never move.
  void relist(bool sort_grains = true, SizeLevels* levels = nullptr, Span<const BodyPose> still = {}) {
    CellGrid fluid_grid(frame, config.domain.min, config.domain.max, coupling.range() / 2);
    CellGrid grain_grid(frame, config.domain.min, config.domain.max, coupling.range() / 2);
    Buffer<Index> order;
    fluid_grid.sort(frame, Span<const FluidPosition>(fluid.x), order);
    fluid.reorder(order);
    if (levels)
      levels->sort(Span<const Vec3d>(grains.x), grains.radius.span(), order);
    else
      grain_grid.sort(frame, Span<const Vec3d>(grains.x), order);
    if (sort_grains) grains.reorder(order);
    fluid.x_list.buffer().assign(fluid.x.values());
    grains.x_list.buffer().assign(grains.x.values());
    for_each(fluid.all(), PackFluid{frame, fluid.x, fluid.eos_state, fluid.xp});
    coupling.rebuild_lists(fluid, fluid_grid.view(), kSkin * coupling.range() / 2, grains,
                           {grain_grid.view(), sort_grains ? Span<const Index>() : order.span(), levels},
                           kSkin * coupling.range() / 2, still);
  }

  std::vector<Vec3d> fluid_places() const {
    std::vector<Vec3d> at;
    for (const auto& x : fluid.x.values()) at.push_back(coordinates(frame, x));
    return at;
  }

 private:
  void fill(const Cloud& c) {
    fluid.resize(Index(c.x.size()));
    std::vector<FluidPosition> x;
    std::vector<VelocityDensity<>> v_rho;
    std::vector<EosState<>> eos_state;
    for (std::size_t a = 0; a < c.x.size(); ++a) {
      x.push_back(as_position<FluidPosition>(frame, c.x[a]));
      v_rho.push_back({Real3(c.v[a]), Real(c.rho[a])});
      eos_state.push_back(
          {.mass_over_eps = Real(c.mass[a] / c.eps[a]), .rho = Real(c.rho[a]), .eps = Real(c.eps[a])});
    }
    fluid.x.assign(x);
    fluid.v_rho.assign(v_rho);
    fluid.eos_state.assign(eos_state);
    fluid.solid_factor.assign(std::vector<Real>(c.x.size(), Real(1)));
    fluid.mass.assign(converted<Real>(c.mass));
    fluid.eps.assign(converted<Real>(c.eps));
    fluid.stress_acceleration.assign(converted<Real3>(c.stress_acceleration));
  }
  void fill(const Pebbles& p) {
    grains.resize(Index(p.x.size()));
    grains.x.assign(p.x);
    grains.v.assign(converted<Real3>(p.v));
    grains.omega.assign(converted<Real3>(p.omega));
    grains.radius.assign(converted<Real>(p.radius));
  }
};

/// A box of unit size and everything at scale one; the fluid is as viscous as mu (Pa s) says.
inline Config unit_box(double hc, double mu) {
  Config c;
  c.domain.min = {0, 0, 0};
  c.domain.max = {1, 1, 1};
  c.fluid.present = c.grain.present = true;
  c.fluid.mu = mu;
  c.couple.hc = hc;
  return c;
}

}  // namespace BL_SOLVER
