#pragma once
// What is kept of a fluid on nodes.

#include "bedload/lattice/populations.hpp"
#include "bedload/particles/store.hpp"
#include "kernels/lattice/link_pass.hpp"

namespace BL_SOLVER {

struct NodeStore : Store {
  NodeStore() : Store("fluid") {}
  Field<std::uint32_t> solid{*this, "solid", "-", Lifetime::kept};  ///< as in Setup::Nodes
};

/// Where fluid meets walls, in the order of bodies; of a sheared box, which has none, an entry for each node
/// beyond its sides, of which only `received` is used.
struct LinkStore : Store {
  LinkStore() : Store("links") {}
  Field<Index> node{*this, "node", "-", Lifetime::kept};
  Field<std::uint32_t> direction{*this, "direction", "-", Lifetime::kept};
  Field<std::uint32_t> body{*this, "body", "-", Lifetime::kept};
  Field<Real> fraction{*this, "fraction", "-", Lifetime::kept};
  Field<Real3> force{*this, "force", "-", Lifetime::kept};               ///< in the last step
  Field<Vec4<double>> received{*this, "received", "-", Lifetime::kept};  ///< since the start: momentum, work

  lattice::Links links(Range r) const {
    return {{node.span().data + r.begin, r.size()},
            {direction.span().data + r.begin, r.size()},
            {fraction.span().data + r.begin, r.size()}};
  }
};

}  // namespace BL_SOLVER
