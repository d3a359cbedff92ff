#pragma once
// How large a solid is, about, before anything is placed in or on it.

#include "bedload/case/config/domain.hpp"
#include "bedload/geometry/shape.hpp"

namespace bedload {

struct RoughSize {
  double area = 0, volume = 0;  ///< m2, m3
};

/// On a raster of some ten thousand places, so that things smaller than 1/24 of the extents count by about
/// their size; of a plane flow, the slab that its slice makes.
RoughSize rough_size(const Shape& shape, const DomainConfig& domain);

}  // namespace bedload
