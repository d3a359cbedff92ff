#pragma once
// Wall particles of any solid.

#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/geometry/shape.hpp"

namespace bedload {

/// Particles that fill the solid down to `depth` below its surface (m), 1 / spacing^3 of them per volume.
/// They lie in layers `spacing` apart, the first half a spacing below the surface, spread evenly over each;
/// the last layer is the one that reaches `depth`. Where the solid is too thin for its innermost layer, that
/// lies midway. The same arguments give the same particles, bit by bit, on any number of threads, and
/// the same solid elsewhere the same seen from itself, but for the rounding of places. Throws CaseError.
std::vector<Vec3d> sample_shape(const Shape& shape, double spacing, double depth);

/// The same, or of its slice in the middle of the domain of a plane flow.
std::vector<Vec3d> sample_solid(const ShapePtr& shape, double spacing, double depth,
                                const DomainConfig& domain);

}  // namespace bedload
