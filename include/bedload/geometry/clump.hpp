#pragma once
// Shapes of clumps: what the union of their spheres weighs, where its centre is.

#include <filesystem>
#include <utility>
#include <vector>

#include "bedload/case/config/grains.hpp"
#include "bedload/core/random.hpp"

namespace bedload {

/// Of spheres in any unit. Volume, centre and inertia of one sphere, and of spheres that do not overlap, are
/// exact; else sums over some 500 x 500 lines along z, on which the union is exact: the volume of two spheres
/// one radius apart is then right to 1e-5.
ClumpShape clump_shape(const std::vector<ClumpSphere>& spheres);

/// From the axes of its spheres: by that vector, deg, or if it has no entries at random, uniform over all
/// rotations [shoemake92].
Quat<double> clump_rotation(const std::vector<double>& vector, CounterRandom random);
/// Places from its centre, and radii, of the spheres of a clump. d: of the sphere of its volume, m.
std::vector<std::pair<Vec3d, double>> turned_spheres(const ClumpShape& shape, double d,
                                                     const Quat<double>& turn);

class Shape;

/// Spheres within a solid, `count` at most: each where the largest fits into what those before leave, less
/// half of their radii, and as large as the solid allows, after [angelidakis21]. Fewer if no place is left.
std::vector<ClumpSphere> inner_spheres(const Shape& shape, std::size_t count);

/// Spheres of a text file: x, y, z, r in each line, with blanks or commas between them; what follows a #
/// is skipped. Throws CaseError.
std::vector<ClumpSphere> read_spheres(const std::filesystem::path& file);

}  // namespace bedload
