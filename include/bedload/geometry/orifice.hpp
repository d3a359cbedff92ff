#pragma once
// Orifices as lattices of fluid particles on their way in.

#include <string>
#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/fluid.hpp"
#include "bedload/case/config/openings.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

struct Config;

/// m2
double orifice_area(const InletConfig& inlet);

/// One layer of particles in an orifice. With this thickness each particle represents a cell of the lattice,
/// so that the inflow has the velocity rate over area.
struct OrificeLayer {
  std::vector<Vec3d> points;  ///< m, in the plane of the orifice
  double thickness = 0;       ///< m
};
/// About `dx` (m) apart and half of that from the rim: rows and columns in a rectangle, of which a plane flow
/// has one row, rings in a disc.
OrificeLayer orifice_layer(const InletConfig& inlet, double dx, const DomainConfig& domain);

/// Points of the lattice across the narrowest part of the orifice, and the spacing that would give four, m.
struct OrificeWidth {
  int points = 0;
  double spacing_for_four = 0;
};
OrificeWidth orifice_width(const InletConfig& inlet, double dx, const DomainConfig& domain);

/// Layers of that thickness (m) that wait upstream of an orifice: they fill the reach of the kernel however
/// far the foremost has come.
int buffer_layers(const FluidProperties& fluid, double thickness);

/// Adds the buffers of all inlets behind the wall particles, layer after layer from the orifice back; the
/// first lies half its thickness upstream of it. Their bodies follow those of the walls. Throws CaseError
/// where a buffer lies in a wall or in the initial fluid; warns of walls next to an orifice that end at its
/// plane.
void add_inlets(const Config& config, const Setup::Fluid& fluid, Setup::Walls& walls,
                std::vector<std::string>& warnings);

}  // namespace bedload
