#pragma once
// How deep particles lie below the surface that they make up.

#include <vector>

#include "bedload/core/vec.hpp"

namespace bedload {

/// Depth of each particle below the topmost of those above it, m, in columns two spacings wide along the unit
/// vector `up`; the surface lies half a spacing above the topmost. A gap of more than three spacings ends a
/// column, so drops do not weigh on the fluid below them.
std::vector<double> depth_in_columns(const std::vector<Vec3d>& x, const Vec3d& up, double spacing);

}  // namespace bedload
