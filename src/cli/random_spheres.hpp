#pragma once
// Places of spheres for `bedload drag`.

#include <vector>

#include "bedload/core/vec.hpp"

namespace bedload {

/// Centres of spheres of diameter 1 in a periodic cube, in equilibrium as hard spheres, at most half of the
/// volume: a random start is pushed apart, then each takes random steps without overlap [metropolis53].
std::vector<Vec3d> random_spheres(int count, double side, int seed);

}  // namespace bedload
