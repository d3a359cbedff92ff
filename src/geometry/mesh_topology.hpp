#pragma once
// From loose triangles to closed, outward surfaces. Errors are CaseErrors that begin with `name`.

#include <cstdint>
#include <string>
#include <vector>

#include "bedload/geometry/mesh.hpp"
#include "geometry/triangle.hpp"

namespace bedload::detail {

Corners corners_of(const TriangleSoup& soup, std::size_t triangle);

/// Makes vertices no farther apart than `distance` one, the first of them, and leaves out those no triangle
/// uses.
void weld(TriangleSoup& soup, double distance);

/// Removes triangles no higher than `height`; without `repair` they are an error.
void drop_degenerate(TriangleSoup& soup, double height, bool repair, const std::string& name);

/// The edge beyond each edge (3 * triangle + edge); errors are edges of one triangle or of more than two.
std::vector<std::uint32_t> match_edges(const TriangleSoup& soup, const std::string& name);

/// The connected surface each triangle belongs to, numbered from 0. Neighbours that run along their edge in
/// the same direction are turned if `repair` holds, an error otherwise.
std::vector<std::uint32_t> orient_alike(TriangleSoup& soup, std::vector<std::uint32_t>& across, bool repair,
                                        const std::string& name);

/// Errors are vertices that hold together triangles with no common edge in between.
void check_vertices(const TriangleSoup& soup, const std::vector<std::uint32_t>& across,
                    const std::string& name);

/// Solids face outward, cavities inward: each surface within an even number of others must have a positive
/// volume, the others a negative one. Those that do not are turned if `repair` holds, an error otherwise;
/// returns whether any was.
bool orient_outward(TriangleSoup& soup, const std::vector<std::uint32_t>& surface, bool repair,
                    const std::string& name);

}  // namespace bedload::detail
