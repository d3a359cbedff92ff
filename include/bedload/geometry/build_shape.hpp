#pragma once
// Shapes as a case describes them.

#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/geometry/shape.hpp"

namespace bedload {

/// The solid that `config` describes; it may refer to those in `earlier`, which are built. A terrain without
/// thickness is solid down to `support` (m) below its lowest point. Sets the digest of a mesh. Throws
/// CaseError and FileError.
ShapePtr build_shape(ShapeConfig& config, const std::vector<ShapeConfig>& earlier, double support);

/// Volume of `shape` below `level` along the unit vector `up`, m3; found on a raster of `step` (m).
double volume_below(const Shape& shape, const Vec3d& up, double level, double step);

}  // namespace bedload
