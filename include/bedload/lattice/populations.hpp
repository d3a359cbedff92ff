#pragma once
// Populations and where they are kept. There is one copy of them: a step takes each from its place and leaves
// another there, so that what leaves a node lies where its neighbour looks for it in the next step
// [lehmann22].

#include <cstddef>

#include "bedload/core/types.hpp"
#include "bedload/lattice/velocities.hpp"

namespace BL_SOLVER::lattice {

using namespace d3q19;

/// Nodes of a box, x fastest. Its sides are periodic; where the domain is not, the outermost nodes are solid.
struct NodeGrid {
  Index n[3] = {0, 0, 0};

  BL_HD Index size() const { return n[0] * n[1] * n[2]; }
  struct Place {
    Index of[3];
  };
  BL_HD Place place(Index node) const {
    const Index row = node / n[0];
    return {{node % n[0], row % n[1], row / n[1]}};
  }
  BL_HD Index node(const Place& p) const { return (p.of[2] * n[1] + p.of[1]) * n[0] + p.of[0]; }
  /// One velocity on from there; `sign` -1: back.
  BL_HD Index neighbour(const Place& from, int pair, int sign = 1) const {
    Place to = from;
    for (int k = 0; k < 3; ++k) {
      const int by = sign * step(pair, k);
      if (by > 0) to.of[k] = from.of[k] + 1 == n[k] ? 0 : from.of[k] + 1;
      if (by < 0) to.of[k] = from.of[k] == 0 ? n[k] - 1 : from.of[k] - 1;
    }
    return node(to);
  }
  /// The node that velocity i reaches; i is not 0.
  BL_HD Index neighbour_at(Index from, int i) const {
    return neighbour(place(from), pair_of(i), is_odd(i) ? 1 : -1);
  }
};

/// Populations less their weights, f_i - w_i, as a step of the given parity takes them.
struct Populations {
  Real* f = nullptr;  ///< population i of a node is at i * nodes + node
  NodeGrid grid;
  bool odd = false;  ///< the number of the step is

  BL_HD Real& at(int i, Index node) const { return f[std::size_t(i) * grid.size() + node]; }
  /// Of a pair, the place that lies with the node itself: its odd velocity arrives here and its even one
  /// leaves.
  BL_HD Real& near(int pair, Index node) const { return at(2 * pair + (odd ? 1 : 2), node); }
  /// And the one that lies with the neighbour that the odd velocity reaches: the even one arrives here.
  BL_HD Real& far(int pair, Index neighbour) const { return at(2 * pair + (odd ? 2 : 1), neighbour); }

  /// Where those of node 0 lie.
  struct Arrays {
    Real *rest, *near[kPairs], *far[kPairs];
  };
  BL_HD Arrays arrays() const {
    Arrays a{};
    a.rest = f;
    for (int p = 0; p < kPairs; ++p) a.near[p] = &near(p, 0), a.far[p] = &far(p, 0);
    return a;
  }

  /// What arrives at a node with velocity i, and what the step leaves for it; i is not 0.
  BL_HD Real& arriving(int i, Index node) const { return place(i, node, true); }
  BL_HD Real& leaving(int i, Index node) const { return place(i, node, false); }

 private:
  BL_HD Real& place(int i, Index node, bool arrives) const {
    const int pair = pair_of(i);
    return is_odd(i) == arrives ? near(pair, node) : far(pair, grid.neighbour(grid.place(node), pair));
  }
};

}  // namespace BL_SOLVER::lattice
