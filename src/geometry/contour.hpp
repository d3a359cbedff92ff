#pragma once
// Triangles on the surface of any solid.

#include "bedload/geometry/mesh.hpp"
#include "bedload/geometry/shape.hpp"

namespace bedload {

/// Triangles up to `size` m wide on the surface of a solid, whose edges and corners they keep: in each cell
/// of a raster a fan around the point where the planes through the surface's crossings meet [ju02], with its
/// rim on the sides of the cell, so that those of two cells cannot cross. Where several sheets of the surface
/// pass one cell, its edges there are cut off by up to half of `size`. They face any way. Throws CaseError
/// where the raster has more than 5e7 cells.
TriangleSoup contour(const Shape& shape, double size);

}  // namespace bedload
