// Velocities of the lattice, and where populations are kept from step to step.

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "bedload/lattice/populations.hpp"

namespace BL_SOLVER::lattice {
namespace {

TEST(LatticeVelocities, AreThoseOfD3Q19) {
  std::set<std::vector<int>> all;
  double sum = 0, second[3][3] = {};
  for (int i = 0; i < kVelocities; ++i) {
    all.insert({velocity(i, 0), velocity(i, 1), velocity(i, 2)});
    sum += weight(i);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) second[a][b] += weight(i) * velocity(i, a) * velocity(i, b);
    if (i == 0) continue;
    EXPECT_EQ(opposite(opposite(i)), i);
    for (int a = 0; a < 3; ++a) EXPECT_EQ(velocity(opposite(i), a), -velocity(i, a));
  }
  EXPECT_EQ(all.size(), std::size_t(kVelocities));
  EXPECT_NEAR(sum, 1, 1e-15);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(second[a][b], a == b ? 1.0 / 3 : 0, 1e-15);
}

/// Also where a period is one node.
TEST(LatticePlaces, HoldEachPopulationOnceInBothKindsOfSteps) {
  for (const NodeGrid grid : {NodeGrid{{5, 4, 3}}, NodeGrid{{1, 2, 3}}, NodeGrid{{1, 1, 1}}}) {
    std::vector<Real> store(std::size_t(kVelocities) * grid.size());
    for (const bool odd : {false, true}) {
      const Populations f{store.data(), grid, odd};
      std::set<const Real*> arriving, leaving;
      for (Index n = 0; n < grid.size(); ++n)
        for (int i = 1; i < kVelocities; ++i) {
          EXPECT_TRUE(arriving.insert(&f.arriving(i, n)).second);
          EXPECT_TRUE(leaving.insert(&f.leaving(i, n)).second);
          EXPECT_EQ(&f.leaving(i, n), &f.arriving(opposite(i), n)) << "a step overwrites what it has taken";
        }
      EXPECT_EQ(arriving.size(), std::size_t(kVelocities - 1) * grid.size());
    }
  }
}

TEST(LatticePlaces, WhatLeavesANodeArrivesAtItsNeighbour) {
  const NodeGrid grid{{5, 4, 3}};
  std::vector<Real> store(std::size_t(kVelocities) * grid.size());
  for (const bool odd : {false, true}) {
    const Populations before{store.data(), grid, odd}, after{store.data(), grid, !odd};
    for (Index n = 0; n < grid.size(); ++n)
      for (int i = 1; i < kVelocities; ++i) {
        const Index there = grid.neighbour(grid.place(n), pair_of(i), is_odd(i) ? 1 : -1);
        EXPECT_EQ(&before.leaving(i, n), &after.arriving(i, there));
        const NodeGrid::Place from = grid.place(n), to = grid.place(there);
        for (int k = 0; k < 3; ++k)
          EXPECT_EQ((from.of[k] + grid.n[k] + Index(velocity(i, k))) % grid.n[k], to.of[k]);
      }
  }
}

}  // namespace
}  // namespace BL_SOLVER::lattice
