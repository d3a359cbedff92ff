#pragma once
// Fluid on nodes, set up in units of the lattice or as a case.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "src/lattice/lattice_solver.hpp"

namespace BL_SOLVER {

/// Of a lattice without walls, in its own units.
inline LatticeParameters lattice_units(double tau, double magic = 3.0 / 16) {
  LatticeParameters p;
  p.units = {1, 1, 1};
  p.tau = tau;
  p.magic = magic;
  return p;
}

/// A periodic box of fluid at rest.
inline Setup::Nodes periodic_nodes(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
  Setup::Nodes nodes;
  nodes.count = {nx, ny, nz};
  nodes.solid.assign(std::size_t(nx) * ny * nz, 0);
  return nodes;
}

/// Between two plates normal to z, which lie `fraction` of a link outside the first and last of n nodes:
/// bodies 0 below and 1 above. Node k of the fluid is number k, from 1.
inline Setup::Nodes channel_nodes(std::uint32_t n, double fraction = 0.5) {
  Setup::Nodes nodes = periodic_nodes(1, 1, n + 2);
  nodes.solid.front() = 1, nodes.solid.back() = 2;
  for (std::uint32_t body : {0u, 1u})
    for (int i = 1; i < d3q19::kVelocities; ++i) {
      if (d3q19::velocity(i, 2) != (body == 0 ? -1 : 1)) continue;
      nodes.links.node.push_back(body == 0 ? 1 : n);
      nodes.links.direction.push_back(std::uint32_t(i));
      nodes.links.body.push_back(body);
      nodes.links.fraction.push_back(fraction);
    }
  return nodes;
}

/// Of a case: a box of water, periodic along x, with a ball in it and a lid that slides; the table [drive]
/// comes last.
inline const std::string kLidAndBall = R"case([domain]
min = [0, 0, 0]
max = [0.016, 0.012, 0.012]
periodic = [true, false, false]
[fluid]
model = "lattice"
dx = 0.001
mu = 0.001
[lattice]
mass_every = 40
[time]
end = 10
[out]
every = 1
[[shape]]
name = "ball"
kind = "sphere"
centre = [0.0083, 0.0061, 0.0057]
radius = 0.0028
[[wall.body]]
name = "box"
shape = "tank"
min = [0, 0, 0]
max = [0.016, 0.012, 0.012]
faces = ["y-", "y+", "z-"]
[[wall.body]]
name = "lid"
shape = "plane"
point = [0, 0, 0.012]
normal = [0, 0, -1]
surface_velocity = [0.01, 0, 0]
[[wall.body]]
name = "ball"
shape = "ball"
[drive]
f = [0, 0.2, 0]
)case";

/// Sum of a part of the stress over a store, J.
inline double total(const HostStore& store, const std::string& part, int component) {
  const HostArray* a = store.find("stress_" + part);
  if (!a) return 0;
  double sum = 0;
  for (std::size_t k = 0; k < store.count; ++k)
    sum += a->type == Scalar::f64 ? a->as<double>()[9 * k + component]
                                  : double(a->as<float>()[9 * k + component]);
  return sum;
}

class LatticeFlow {
 public:
  LatticeFlow(const LatticeParameters& parameters, const Setup::Nodes& nodes) : solver_(parameters) {
    solver_.fill(nodes);
    solver_.begin();
  }
  void run(std::int64_t steps) {
    for (std::int64_t k = 0; k < steps; ++k, ++done_) solver_.step(double(done_), done_ + 1);
  }
  double time() const { return double(done_); }
  std::vector<Vec3d> velocity() const {
    std::vector<Vec3d> v;
    for (const Real4& s : solver_.states()) v.push_back(Vec3d(s.xyz()));
    return v;
  }
  const LatticeSolver& solver() const { return solver_; }

 private:
  LatticeSolver solver_;
  std::int64_t done_ = 0;
};

}  // namespace BL_SOLVER
