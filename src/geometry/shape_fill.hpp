#pragma once
#include <vector>

#include "bedload/geometry/shape.hpp"

namespace bedload {

/// Places for fluid in `shape` below `level` along the unit vector `up`, m: as many as its volume holds at
/// `spacing`, which is returned in `volume` (m3). A cubic lattice within; towards walls and level the places
/// give way, so that none lies nearer than half a spacing and the first layer follows them. The same
/// arguments give the same places on any number of threads.
std::vector<Vec3d> fill_shape(const Shape& shape, const Vec3d& up, double level, double spacing,
                              double& volume);

}  // namespace bedload
