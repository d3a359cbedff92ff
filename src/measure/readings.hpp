#pragma once
// What diagnostics and probes read of one particle.

#include "bedload/parallel/reductions.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/grains.hpp"

namespace bedload::inline BL_VARIANT {

/// Coordinate along a direction, m.
template <class P>
struct AlongBody {
  Frame frame;
  Span<const P> x;
  Vec3d direction;
  BL_HD double operator()(Index i) const { return dot(direction, coordinates(frame, x[i])); }
};

}  // namespace bedload::inline BL_VARIANT
