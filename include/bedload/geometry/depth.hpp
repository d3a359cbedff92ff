#pragma once
// Columns along the vertical, and how deep particles lie below the surface they make
// up.

#include <vector>

#include "bedload/core/vec.hpp"

namespace bedload {

/// Unit vector against gravity; z where there is none.
Vec3d upwards(const Vec3d& gravity);

/// The part within a box of the line through x along the unit vector `up`, m from x upwards; from > to where
/// it misses the box.
struct LinePart {
  double from, to;
};
LinePart line_in_box(const Vec3d& x, const Vec3d& up, const Vec3d& min, const Vec3d& max);

/// Depth of each particle below the topmost of those above it, m, in columns two spacings wide along the unit
/// vector `up`; the surface lies half a spacing above the topmost, or half of that particle's `size` (m)
/// where sizes are given. A gap of more than three spacings ends a column, so drops do not weigh on the fluid
/// below them.
std::vector<double> depth_in_columns(const std::vector<Vec3d>& x, const Vec3d& up, double spacing,
                                     const std::vector<double>& size = {});

}  // namespace bedload
