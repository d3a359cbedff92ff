// Links of grains to the nodes around them, against a search over all nodes.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "kernels/lattice/grain_passes.hpp"

namespace BL_SOLVER::lattice {
namespace {

/// Grains in a box of nodes, periodic along x and y, between solid layers normal to z.
struct Cell {
  NodeGrid grid{{44, 40, 47}};
  std::vector<Vec3d> x{{3.2, 18.7, 22.4}, {30.1, 20.2, 23.3}};
  std::vector<Real> radius{Real(17.3), Real(9.1)};  // the first in several bricks; they overlap

  void find() {
    std::vector<std::uint32_t> nodes(grid.size());
    for (Index n = 0; n < grid.size(); ++n)
      nodes[n] = grid.place(n).of[2] == 0 || grid.place(n).of[2] == 46 ? 1 : 0;
    solid.assign(nodes);
    centre.assign(x), radii.assign(radius), id.assign({1, 0});
    none.resize(2), count.resize(2), covered.resize(2);
    for (const Real r : radius) begins.push_back(places), places += Index(GrainLink::most(double(r)));
    begin.assign(begins), link.resize(places);
    for_each_box(2, CoverPass{balls(), solid});
    list_boxes(2, GrainLinkSearch{balls(), solid, {begin, count, covered, link}});
  }
  Balls balls() { return {grid, {true, true, false}, {}, 1, 1, true, centre, none, none, radii, id}; }

  Buffer<std::uint32_t> solid;
  Buffer<Vec3d> centre;
  Buffer<Real3> none;
  Buffer<Real> radii;
  Buffer<Id> id;
  Buffer<Index> begin, count, covered;
  Buffer<std::uint64_t> link;
  std::vector<Index> begins;
  Index places = 0;
};

TEST(LatticeGrainLinks, AreAllThatLeadToTheGrain) {
  Cell cell;
  cell.find();
  const auto solid = cell.solid.to_host();
  const auto count = cell.count.to_host(), covered = cell.covered.to_host();
  const auto link = cell.link.to_host();
  for (Index i = 0; i < 2; ++i) {
    const std::uint32_t own = mark::grain(i == 0 ? 1 : 0);
    std::vector<std::vector<Index>> expected, found;  // node, direction, narrow
    for (Index n = 0; n < cell.grid.size(); ++n)
      for (int k = 1; k < kVelocities && solid[n] == 0; ++k)
        if (solid[cell.grid.neighbour_at(n, k)] == own)
          expected.push_back({n, Index(k), Index(solid[cell.grid.neighbour_at(n, opposite(k))] != 0)});
    ASSERT_LE(double(count[i]), GrainLink::most(cell.radius[i]));
    EXPECT_GT(double(count[i]), 0.5 * GrainLink::most(cell.radius[i])) << "memory";
    for (Index l = 0; l < count[i]; ++l) {
      const GrainLink g = GrainLink::of(link[cell.begins[i] + l]);
      const double reach = cell.radius[i] + 1;
      NodeGrid::Place at;
      const int cells[3] = {g.x, g.y, g.z};
      for (int a = 0; a < 3; ++a) {
        const int n = int(cell.grid.n[a]);
        at.of[a] = Index((int(std::ceil(cell.x[i][a] - reach)) + cells[a] + n) % n);
      }
      found.push_back({cell.grid.node(at), Index(g.direction), Index(g.narrow)});
    }
    std::sort(expected.begin(), expected.end()), std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected) << i;
    EXPECT_EQ(covered[i], Index(std::count(solid.begin(), solid.end(), own)));
  }
}

}  // namespace
}  // namespace BL_SOLVER::lattice
