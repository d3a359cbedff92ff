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

/// Populations that arrive from walls: linear interpolation about the surface, at any fraction of the link
/// with the same formula [ginzburg08]; half-way bounce-back at a fraction of 1/2. The body takes up what the
/// populations lose.
struct LinkPass {
  Populations f;  ///< of the step to come
  SurfaceMotion body;
  Links links;
  Span<Real3> force;            ///< on the body in this step, per link
  Span<Vec4<double>> received;  ///< since the start: momentum 3, work

  BL_HD void operator()(Index l) const {
    const Link link = links[l];
    Populations before = f;
    before.odd = !f.odd;
    const int k = link.direction, i = opposite(k);
    const Real q = link.fraction, left = before.leaving(k, link.node);
    const Vec3d u = body.at(surface_point(f.grid, link));
    const Vec3d c = velocity_of<double>(k);
    Real back = left - 12 / (1 + 2 * q) * Real(weight(k)) * Real(dot(c, u));
    if (q != Real(0.5))
      back += (1 - 2 * q) / (1 + 2 * q) * (f.arriving(k, link.node) - before.leaving(i, link.node));
    f.arriving(i, link.node) = back;

    const Vec3d taken = (double(left) + double(back)) * c;
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
