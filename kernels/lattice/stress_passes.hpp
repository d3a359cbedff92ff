#pragma once
// Stress of fluid on nodes and of the grains in it, from the populations of the step to come once links have
// run. The moments of both add up to the momentum that crosses the suspension, node by node.

#include "kernels/lattice/grain_passes.hpp"
#include "kernels/stress/pair_moment.hpp"

namespace BL_SOLVER::lattice {

/// Sums over a row of nodes, units of the lattice. Second moments: xx, yy, zz, xy, xz, yz.
struct RowSums {
  static constexpr int kMoments = 6;
  double nodes = 0, fluid = 0;  ///< in no wall; of these, in no grain
  double excess = 0;            ///< of the mass
  Vec3d momentum;
  double flow[kMoments] = {};      ///< rho u u
  double friction[kMoments] = {};  ///< viscous flux of momentum
};

/// Flow and stress in rows of nodes along an axis. The flux of momentum is the mean before and after the
/// collision, less that by pressure and rho u u [guo02].
struct RowStressPass {
  Populations f;  ///< of the step to come
  Real3 force;    ///< per volume in it
  double even;    ///< rate of relaxation
  int axis;
  Span<const std::uint32_t> solid;
  Span<RowSums> out;

  BL_HD static Index rows(const NodeGrid& grid, int axis) { return grid.size() / grid.n[axis]; }
  BL_HD static NodeGrid::Place place(const NodeGrid& grid, int axis, Index row, Index along) {
    const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    NodeGrid::Place p;
    p.of[axis] = along, p.of[a] = row % grid.n[a], p.of[b] = row / grid.n[a];
    return p;
  }
  BL_HD void operator()(Index row) const {
    RowSums sum;
    for (Index k = 0; k < f.grid.n[axis]; ++k) add(f.grid.node(place(f.grid, axis, row, k)), sum);
    out[row] = sum;
  }

 private:
  BL_HD static int axis_of(int moment, bool second) {
    return moment < 3 ? moment : second ? (moment == 3 ? 1 : 2) : (moment == 5 ? 1 : 0);
  }
  BL_HD void add(Index node, RowSums& sum) const {
    if (mark::is_wall(solid[node])) return;
    sum.nodes += 1;
    if (solid[node] != 0) return;
    const Vec3d F(force);
    double excess = f.at(0, node), flux[RowSums::kMoments] = {};
    Vec3d momentum = 0.5 * F;
    for (int i = 1; i < kVelocities; ++i) {
      const double value = f.arriving(i, node);
      const Vec3d c = velocity_of<double>(i);
      excess += value;
      momentum += value * c;
      for (int m = 0; m < RowSums::kMoments; ++m)
        flux[m] += value * c[axis_of(m, false)] * c[axis_of(m, true)];
    }
    const Vec3d u = momentum / (1 + excess);
    sum.fluid += 1, sum.excess += excess, sum.momentum += momentum;
    for (int m = 0; m < RowSums::kMoments; ++m) {
      const int a = axis_of(m, false), b = axis_of(m, true);
      const double flow = momentum[a] * u[b], pressure = m < 3 ? excess / 3 : 0;
      sum.flow[m] += flow;
      sum.friction[m] += (1 - 0.5 * even) * (flux[m] - pressure - flow + 0.5 * (u[a] * F[b] + F[a] * u[b]));
    }
  }
};

/// Moment of the force that the fluid has on each grain, about its centre: what a rigid sphere carries of the
/// stress of a suspension [batchelor70]. The force of a link acts at its middle, up to which the stress of
/// the node counts. Leaves what comes back from the grain where the node takes it from.
struct StressletPass {
  struct Value {
    Vec3d row[3];  ///< component k of the force times the distance
  };
  Balls balls;
  Populations f;  ///< of the step to come
  GrainLinks links;
  double joule;            ///< SI of a unit of moment
  Span<PairMoment<>> out;  ///< minus the moment, as of pairs

  BL_HD Value identity() const { return {}; }
  BL_HD void combine(Value& into, const Value& from) const {
    for (int k = 0; k < 3; ++k) into.row[k] += from.row[k];
  }
  BL_HD LinksOf<StressletPass> group(Index i) const { return {*this, i}; }

  BL_HD Value at(const Ball& ball, const LinkMet& link) const {
    const Vec3d u = ball.velocity_at(link.arm()), middle = link.d + 0.5 * velocity_of<double>(link.direction);
    const Vec3d taken =
        reflect(f, link.node, link.beyond, link.direction, Real(link.fraction), u).taken(link.direction, u);
    Value sum;
    for (int a = 0; a < 3; ++a) sum.row[a] = taken[a] * middle;
    return sum;
  }
  BL_HD void finish(Index i, const Value& sum) const {
    for (int k = 0; k < 3; ++k) {
      const Real3 row(-joule * sum.row[k]);
      out[i].row[k] = balls.across ? out[i].row[k] + row : row;
    }
  }
};

}  // namespace BL_SOLVER::lattice
