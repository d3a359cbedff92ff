#pragma once
// Fluid in a box, built in code: the start of most fluid tests.

#include <numeric>
#include <random>
#include <vector>

#include "bedload/case/config.hpp"
#include "src/fluid/fluid_solver.hpp"
#include "src/walls/wall_motion.hpp"

namespace BL_SOLVER {

/// A periodic cube of n^3 particles, water-like, no gravity.
inline Config periodic_box(int n, double dx = 0.01) {
  Config c;
  c.gravity = {0, 0, 0};
  c.domain.min = {0, 0, 0};
  c.domain.max = {n * dx, n * dx, n * dx};
  c.domain.periodic = {true, true, true};
  c.fluid.present = true;
  c.fluid.dx = dx;
  c.fluid.c = 20;
  c.fluid.vmax = 2;
  c.wall.dx = dx;
  c.wall.rep_D = 1;
  c.wall.rep_r0 = dx / 2;
  return c;
}

inline Frame frame_of(const Config& c) {
  return {c.domain.min, c.domain.max, c.domain.periodic[0], c.domain.periodic[1], c.domain.periodic[2]};
}

/// Fluid and its solver with lists ready; `jitter` displaces lattice points by up to that fraction of dx.
struct FluidBox {
  explicit FluidBox(const Config& config, double jitter = 0, bool random_mass = false)
      : config(config),
        frame(frame_of(config)),
        geometry(config.wall.bodies, config.domain),
        solver(FluidSolver::make(fluid_parameters(config), frame, geometry, fluid)) {
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> u(-1, 1);
    const double dx = config.fluid.dx;
    const Vec3d size = config.domain.max - config.domain.min;
    for (double z = dx / 2; z < size.z; z += dx)
      for (double y = dx / 2; y < size.y; y += dx)
        for (double x = dx / 2; x < size.x; x += dx)
          add(config.domain.min +
                  Vec3d{x + jitter * dx * u(rng), y + jitter * dx * u(rng), z + jitter * dx * u(rng)},
              {}, config.fluid.rho0 * dx * dx * dx * (random_mass ? 1 + 0.5 * u(rng) : 1));
  }
  void add(const Vec3d& x, const Vec3d& v, double m) {
    position.push_back(frame.wrap(x));
    velocity.push_back(v);
    mass.push_back(m);
    s.push_back(0);
  }
  /// Copies the host lists to the stores, sorts, lists.
  void upload() {
    const std::size_t n = position.size();
    fluid.resize(Index(n));
    std::vector<Id> id(n);
    std::iota(id.begin(), id.end(), Id(0));
    std::vector<FluidPosition> x;
    std::vector<VelocityDensity<>> v;
    std::vector<Real> m, c;
    for (std::size_t a = 0; a < n; ++a) {
      x.push_back(as_position<FluidPosition>(frame, position[a]));
      v.push_back({Real3(velocity[a]), Real(config.fluid.rho0 * (1 + s[a]))});
      m.push_back(Real(mass[a]));
      c.push_back(Real(s[a]));
    }
    fluid.id.assign(id);
    fluid.x.assign(x);
    fluid.v_rho.assign(v);
    fluid.mass.assign(m);
    fluid.compression.assign(c);
    fluid.eps.assign(std::vector<Real>(n, Real(1)));
    solver->refresh(fluid, walls, true, {});
    solver->state(fluid, 0, false);
    solver->pack(fluid);  // with the weights that follow from the state
  }
  /// With nothing that drives the fluid.
  StepTime moment(std::uint64_t step = 0) const { return {step, Real3(config.gravity), {}}; }
  std::vector<Vec3d> coordinates_now() const {
    std::vector<Vec3d> out;
    for (const auto& p : fluid.x.values()) out.push_back(coordinates(frame, p));
    return out;
  }

  Config config;
  Frame frame;
  WallGeometry geometry;
  FluidStore fluid;
  std::unique_ptr<FluidSolver> solver;
  WallStore walls;
  std::vector<Vec3d> position, velocity;
  std::vector<double> mass, s;
};

}  // namespace BL_SOLVER
