#pragma once
#include <cstdint>

#include "bedload/core/span.hpp"
#include "bedload/lattice/populations.hpp"

namespace BL_SOLVER::lattice {

/// A link from a fluid node to a solid one.
struct Link {
  Index node;
  int direction;  ///< velocity towards the solid
  Real fraction;  ///< of the link to the surface, above 0 to 1
};
struct Links {
  Span<const Index> node;
  Span<const std::uint32_t> direction;
  Span<const Real> fraction;
  BL_HD Link operator[](Index l) const { return {node[l], int(direction[l]), fraction[l]}; }
};

/// Motion of a body about a point, in units of the lattice and counted from node 0.
struct SurfaceMotion {
  Vec3d v, omega, centre;
  BL_HD Vec3d at(const Vec3d& x) const { return v + cross(omega, x - centre); }
};

/// Where a link meets the surface, in nodes from node 0.
BL_HD Vec3d surface_point(const NodeGrid& grid, const Link& link) {
  const NodeGrid::Place here = grid.place(link.node);
  return Vec3d{double(here.of[0]), double(here.of[1]), double(here.of[2])} +
         double(link.fraction) * velocity_of<double>(link.direction);
}

/// What leaves a node along a link and comes back from the surface, less the weight.
struct Reflection {
  Real left, back;
  /// Momentum and mass that the fluid loses.
  BL_HD Vec3d lost(int k) const { return (double(left) + double(back)) * velocity_of<double>(k); }
  BL_HD double mass() const { return double(left) - double(back); }
  /// Momentum that a surface with the velocity u takes from it, which does not depend on the frame [wen14].
  BL_HD Vec3d taken(int k, const Vec3d& u) const { return lost(k) - mass() * u; }
};
/// By linear interpolation about the surface, at any fraction q of the link with the same formula
/// [ginzburg08]; half-way bounce-back at a fraction of 1/2. f: of the step to come; k: velocity towards the
/// solid; beyond: the node that the odd velocity of its pair reaches; u: of the surface there, in nodes a
/// step. Leaves what comes back where the node takes it from.
BL_HD Reflection reflect(const Populations& f, Index node, Index beyond, int k, Real q, const Vec3d& u) {
  Populations before = f;
  before.odd = !f.odd;
  const int pair = pair_of(k);
  const bool odd = is_odd(k);
  const Real left = odd ? before.far(pair, beyond) : before.near(pair, node);
  Real back = left - 12 / (1 + 2 * q) * Real(weight(k)) * Real(dot(velocity_of<double>(k), u));
  if (q != Real(0.5)) {
    const Real arriving = odd ? f.near(pair, node) : f.far(pair, beyond);
    const Real left_away = odd ? before.near(pair, node) : before.far(pair, beyond);
    back += (1 - 2 * q) / (1 + 2 * q) * (arriving - left_away);
  }
  (odd ? f.far(pair, beyond) : f.near(pair, node)) = back;
  return {left, back};
}

/// Populations that arrive from walls. The body takes up what the populations lose.
struct LinkPass {
  Populations f;  ///< of the step to come
  SurfaceMotion body;
  Links links;
  Span<const std::uint32_t> solid;
  Span<Real3> force;            ///< on the body in this step, per link; empty: nothing is summed
  Span<Vec4<double>> received;  ///< since the start: momentum 3, work

  BL_HD void operator()(Index l) const {
    const Link link = links[l];
    if (solid[link.node] != 0) {  // a grain is there
      if (force) force[l] = {};
      return;
    }
    const int k = link.direction;
    const bool narrow = solid[f.grid.neighbour_at(link.node, opposite(k))] != 0;
    const Vec3d u = body.at(surface_point(f.grid, link));
    const Index beyond = f.grid.neighbour(f.grid.place(link.node), pair_of(k));
    const Reflection r = reflect(f, link.node, beyond, k, narrow ? Real(0.5) : link.fraction, u);
    if (!force) return;
    const Vec3d taken = r.lost(k);
    force[l] = Real3(taken);
    Vec4<double>& sum = received[l];
    sum.x += taken.x, sum.y += taken.y, sum.z += taken.z;
    sum.w += dot(taken, u);
  }
};

/// Sums over links of a body: force 3 and torque about its centre 3 in the last step; momentum, its moment
/// about node 0 and work since the start: 3, 3, 1.
struct LinkTotals {
  NodeGrid grid;
  Vec3d centre;
  Links links;
  Span<const Real3> force;
  Span<const Vec4<double>> received;

  BL_HD void operator()(Index l, double* out) const {
    const Vec3d x = surface_point(grid, links[l]), now(force[l]), all = received[l].xyz();
    const Vec3d turn = cross(x - centre, now), turned = cross(x, all);
    for (int k = 0; k < 3; ++k)
      out[k] = now[k], out[3 + k] = turn[k], out[6 + k] = all[k], out[9 + k] = turned[k];
    out[12] = received[l].w;
  }
};

}  // namespace BL_SOLVER::lattice
