#pragma once
#include "kernels/lattice/collide_pass.hpp"

namespace BL_SOLVER::lattice {

/// State of a node after a step, from what the step has left.
struct NodeMoments {
  Populations f;  ///< as that step
  Real3 force;    ///< in that step

  /// Density less 1, and momentum with half a step of the force.
  BL_HD void sums(Index node, double& excess, Vec3d& momentum) const {
    excess = f.at(0, node);
    momentum = {};
    for (int i = 1; i < kVelocities; ++i) {
      const double value = f.leaving(i, node);
      excess += value;
      momentum += value * velocity_of<double>(i);
    }
  }
  BL_HD NodeState operator()(Index node) const {
    double excess;
    Vec3d momentum;
    sums(node, excess, momentum);
    return {Real(excess), Real3((momentum - 0.5 * Vec3d(force)) / (1 + excess))};
  }
};

/// What a step leaves of velocity i where it has come to equilibrium, less the weight, under a force per
/// volume.
BL_HD Real left_in_equilibrium(int i, const NodeState& s, const Real3& force) {
  const Real3 c = velocity_of<Real>(i);
  const Real w = Real(weight(i)), cu = dot(c, s.u);
  return even_equilibrium(w, s, cu) + 3 * w * (s.rho() * cu + Real(0.5) * dot(c, force));
}

/// Leaves the equilibrium of a density and velocity, as if after a step.
struct BeginPass {
  Populations f;
  Real3 force;
  Vec3d slope;  ///< of the density, per node: hydrostatic
  Span<const std::uint32_t> solid;
  Span<const Real3> velocity;  ///< in units of the lattice; empty: at rest

  BL_HD void operator()(Index node) const {
    if (solid[node] != 0) return;
    const NodeGrid::Place here = f.grid.place(node);
    double excess = 0;
    for (int k = 0; k < 3; ++k) excess += slope[k] * (here.of[k] - 0.5 * (f.grid.n[k] - 1.0));
    const NodeState s{Real(excess), velocity ? velocity[node] : Real3{}};
    f.at(0, node) = left_in_equilibrium(0, s, force);
    for (int i = 1; i < kVelocities; ++i) f.leaving(i, node) = left_in_equilibrium(i, s, force);
  }
};

/// Adds mass to all fluid nodes alike, without momentum.
struct AddMassPass {
  Populations f;
  double each;  ///< on a node
  Span<const std::uint32_t> solid;

  BL_HD void operator()(Index node) const {
    if (solid[node] != 0) return;
    f.at(0, node) += Real(weight(0) * each);
    for (int i = 1; i < kVelocities; ++i) f.leaving(i, node) += Real(weight(i) * each);
  }
};

/// Fluid nodes 1, density less 1, momentum with half a step of the force 3, its moment about node 0 3,
/// kinetic energy.
struct NodeTotals {
  NodeMoments moments;
  Span<const std::uint32_t> solid;

  BL_HD void operator()(Index node, double* out) const {
    if (solid[node] != 0) return;
    Vec3d momentum;
    moments.sums(node, out[1], momentum);
    const NodeGrid::Place here = moments.f.grid.place(node);
    const Vec3d at{double(here.of[0]), double(here.of[1]), double(here.of[2])},
        true_momentum = momentum - 0.5 * Vec3d(moments.force), turn = cross(at, true_momentum);
    out[0] = 1;
    for (int k = 0; k < 3; ++k) out[2 + k] = momentum[k], out[5 + k] = turn[k];
    out[8] = 0.5 * norm2(true_momentum) / (1 + out[1]);
  }
};

/// Largest speed and range of density, in units of the lattice.
struct NodeExtremes {
  double speed2 = 0, least = 1e300, most = -1e300;  ///< density less 1
  Index fastest = kNone;
};
struct ExtremesReduction {
  using Value = NodeExtremes;
  NodeMoments moments;
  Span<const std::uint32_t> solid;

  BL_HD Value identity() const { return {}; }
  BL_HD Value operator()(Index node) const {
    if (solid[node] != 0) return {};
    const NodeState s = moments(node);
    const double u2 = norm2(Vec3d(s.u));
    if (!(u2 < 1e30)) return {1e300, 0, 0, node};  // not a number
    return {u2, double(s.excess), double(s.excess), node};
  }
  BL_HD void combine(Value& into, const Value& from) const {
    if (from.speed2 > into.speed2 || into.fastest == kNone)
      into.speed2 = from.speed2, into.fastest = from.fastest;
    into.least = min_of(into.least, from.least);
    into.most = max_of(into.most, from.most);
  }
};

/// Velocity and density less 1, for outputs; a density of 0 in solids.
struct NodeStatePass {
  NodeMoments moments;
  Span<const std::uint32_t> solid;
  Span<const Index> nodes;  ///< empty: all
  Span<Real4> out;

  BL_HD void operator()(Index k) const {
    const Index node = nodes ? nodes[k] : k;
    if (solid[node] != 0) {
      out[k] = {0, 0, 0, -1};
      return;
    }
    const NodeState s = moments(node);
    out[k] = {s.u, s.excess};
  }
};

}  // namespace BL_SOLVER::lattice
