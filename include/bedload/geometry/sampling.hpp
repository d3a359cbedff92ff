#pragma once
// Wall bodies as solids and as layers of wall particles.

#include <string>
#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/walls.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

struct Config;

/// Wall particles of `body` at t = 0, m: the part of its solid that lies within `depth`
/// of its surface, on a lattice of about `spacing` that divides every side evenly, first
/// layer half a spacing behind the surface. Layers of a tank run on around edges and
/// corners where both faces are closed and end flush at an open face. Those of a plane
/// cover the domain and `depth` beyond, so that two planes close the corner between them.
std::vector<Vec3d> sample_body(const WallBody& body, double spacing, double depth,
                               const DomainConfig& domain);

/// About how many places sample_body finds, from lengths, areas and volumes alone: in no time, however many.
double expected_places(const WallBody& body, double spacing, double depth, const DomainConfig& domain);

/// Volume that one of those particles represents, m3: a cell of the lattice; spacing^3 for shapes, whose
/// layers are only about that far apart.
double particle_volume(const WallBody& body, double spacing, const DomainConfig& domain);

/// Distance of `x` from the surface of `body`, m; negative inside its solid, +infinity
/// where a tank has no wall opposite `x`. Tank walls are `thickness` thick.
double wall_distance(const WallBody& body, const Vec3d& x, double thickness, const DomainConfig& domain);

/// Clearance of a sphere about `x` before `body`, m: wall_distance, but see Shape::clearance.
double wall_clearance(const WallBody& body, const Vec3d& x, double thickness, const DomainConfig& domain);

/// Adds the particles of every wall body that stops fluid. Where bodies share space the
/// body listed first keeps it. Throws CaseError.
void add_walls(const Config& config, Setup::Walls& walls, std::vector<std::string>& warnings);

}  // namespace bedload
