#pragma once
// Orifices as lattices of fluid particles on their way in.

#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

/// Points of a square lattice of spacing `dx` over the orifice, m, in its plane: those whose cells lie in a
/// rectangle, those that are dx/4 or more inside the rim of a disc.
std::vector<Vec3d> orifice_points(const InletConfig& inlet, double dx);

/// Points of the lattice across the narrowest part of the orifice, and the spacing that would give four, m.
struct OrificeWidth {
  int points = 0;
  double spacing_for_four = 0;
};
OrificeWidth orifice_width(const InletConfig& inlet, double dx);

/// Layers of fluid particles that wait upstream of an orifice: they fill the reach of the kernel however far
/// the foremost has come.
int buffer_layers(const FluidConfig& fluid);

/// Adds the buffers of all inlets behind the wall particles, layer after layer from the orifice back; the
/// first lies half a spacing upstream of it. Their bodies follow those of the walls. Throws CaseError where
/// a buffer lies in a wall or in the initial fluid; warns of walls beside an orifice that end at its plane.
void add_inlets(const Config& config, const Setup::Fluid& fluid, Setup::Walls& walls,
                std::vector<std::string>& warnings);

}  // namespace bedload
