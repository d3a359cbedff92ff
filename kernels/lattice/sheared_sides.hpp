#pragma once
// Lees-Edwards boundaries of a lattice [lees72]: the images of the box across z move along x. Beyond either
// side is a layer of nodes that are no fluid; what leaves them is what leaves the nodes of the image there.

#include "kernels/lattice/grain_passes.hpp"

namespace BL_SOLVER::lattice {

/// Node in a layer beyond the sides, the lower ones first.
struct LayerNode {
  NodeGrid::Place place;
  int side;  ///< -1: below, 1: above

  BL_HD static Index count(const NodeGrid& grid) { return 2 * grid.n[0] * grid.n[1]; }
  BL_HD LayerNode(const NodeGrid& grid, Index k) {
    const Index layer = grid.n[0] * grid.n[1], of = k % layer;
    side = k < layer ? -1 : 1;
    place = {{of % grid.n[0], of / grid.n[0], side < 0 ? 0 : grid.n[2] - 1}};
  }
};

/// Before grains cover them.
struct ClearLayersPass {
  NodeGrid grid;
  Span<std::uint32_t> solid;
  BL_HD void operator()(Index k) const { solid[grid.node(LayerNode(grid, k).place)] = mark::kBeyond; }
};

/// Populations that come in from the images: linear between two nodes of the image, with the equilibrium of
/// its velocity instead of that of the nodes' [wagner02]. Mass is conserved where no grain lies across the
/// side.
struct ImagePass {
  NodeMoments before;  ///< of the last step
  SideImages images;   ///< half a step after it
  Span<const std::uint32_t> solid;
  Span<Vec4<double>>
      received;  ///< momentum that images have from the fluid since the start; empty: not summed

  BL_HD void operator()(Index k) const {
    const NodeGrid& grid = before.f.grid;
    const LayerNode here(grid, k);
    const Index node = grid.node(here.place);
    if (solid[node] != mark::kBeyond) return;  // in a grain, which has links
    NodeGrid::Place of[2];
    double share[2];
    sources(here, of, share);
    Vec3d out;
    for (int i = 1; i < kVelocities; ++i) {
      if (velocity(i, 2) == -here.side) {
        const Real value = incoming(i, here, of, share);
        before.f.leaving(i, node) = value;
        if (solid[grid.neighbour_at(node, i)] == 0) out -= double(value) * velocity_of<double>(i);
      } else if (velocity(i, 2) == here.side) {
        const Index from = grid.neighbour_at(node, opposite(i));
        if (solid[from] == 0) out += double(before.f.leaving(i, from)) * velocity_of<double>(i);
      }
    }
    if (received) received[k].x += out.x, received[k].y += out.y, received[k].z += out.z;
  }

 private:
  /// Nodes of the image on either side, and their shares; 0: solid.
  BL_HD void sources(const LayerNode& here, NodeGrid::Place (&of)[2], double (&share)[2]) const {
    const NodeGrid& grid = before.f.grid;
    const double n = grid.n[0], at = here.place.of[0] - here.side * images.offset, below = std::floor(at);
    for (int s = 0; s < 2; ++s) {
      const double x = below + s - n * std::floor((below + s) / n);
      of[s] = {{min_of(Index(x), grid.n[0] - 1), here.place.of[1], here.side < 0 ? grid.n[2] - 2 : 1}};
      share[s] = solid[grid.node(of[s])] == 0 ? (s == 0 ? 1 - (at - below) : at - below) : 0;
    }
  }
  BL_HD Real incoming(int i, const LayerNode& here, const NodeGrid::Place (&of)[2],
                      const double (&share)[2]) const {
    const double whole = share[0] + share[1];
    if (!(whole > 0)) return left_in_equilibrium(i, {0, mean_flow(here)}, before.force);
    double sum = 0;
    for (int s = 0; s < 2; ++s) {
      if (share[s] == 0) continue;
      const Index node = before.f.grid.node(of[s]);
      const NodeState still = before(node);
      NodeState moved = still;
      moved.u.x += Real(here.side * images.speed);
      sum += share[s] *
             (double(before.f.leaving(i, node)) + double(left_in_equilibrium(i, moved, before.force)) -
              double(left_in_equilibrium(i, still, before.force)));
    }
    return Real(sum / whole);
  }
  BL_HD Real3 mean_flow(const LayerNode& here) const {
    return {Real(here.side * 0.5 * images.speed * (1 + 1.0 / (before.f.grid.n[2] - 2))), 0, 0};
  }
};

/// Momentum that images have from the fluid since the start.
struct ImageTotals {
  Span<const Vec4<double>> received;
  BL_HD void operator()(Index k, double* out) const {
    out[0] = received[k].x, out[1] = received[k].y, out[2] = received[k].z;
  }
};

}  // namespace BL_SOLVER::lattice
