#pragma once
// Nodes of a lattice between walls.

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

/// Places the nodes of a case with fluid.model = "lattice": which of them are solid, the links on which fluid
/// meets walls, the velocity at the start. Throws KeyError where fluid could leave through a side of the
/// domain, where fills leave some without fluid, and for walls that move through nodes.
Setup::Nodes place_nodes(const Config& config);

}  // namespace bedload
