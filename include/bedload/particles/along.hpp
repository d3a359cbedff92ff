#pragma once
#include "bedload/core/frame.hpp"
#include "bedload/core/span.hpp"

namespace BL_SOLVER {

/// Coordinate of fluid particles or grains along a direction, m.
template <class P>
struct AlongBody {
  Frame frame;
  Span<const P> x;
  Vec3d direction;
  BL_HD double operator()(Index i) const { return dot(direction, coordinates(frame, x[i])); }
};

}  // namespace BL_SOLVER
