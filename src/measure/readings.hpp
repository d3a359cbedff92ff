#pragma once
// What diagnostics and probes read of one particle.

#include "bedload/parallel/reductions.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/grains.hpp"

namespace bedload::inline BL_VARIANT {

/// Pressure from the pair-loop record of fluid or walls, Pa.
BL_HD Real pressure_of(const Real4& m_state) { return m_state.y * square(m_state.z); }

/// Coordinate along a direction, m.
template <class P>
struct AlongBody {
  Frame frame;
  Span<const P> x;
  Vec3d direction;
  BL_HD double operator()(Index i) const { return dot(direction, coordinates(frame, x[i])); }
};

}  // namespace bedload::inline BL_VARIANT
