#pragma once
// What diagnostics and probes read of one particle.

#include "bedload/parallel/reductions.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/grains.hpp"

namespace bedload::inline BL_VARIANT {

/// Fluid as it is.
struct FluidContents {
  Frame frame;
  Span<const FluidPosition> x;
  Span<const VelocityDensity<>> v_rho;
  Span<const EosState<>> state;
  Span<const Real> mass;

  FluidContents(const Frame& frame, const FluidStore& fluid)
      : frame(frame), x(fluid.x), v_rho(fluid.v_rho), state(fluid.eos_state), mass(fluid.mass) {}
  BL_HD Vec3d at(Index a) const { return coordinates(frame, x[a]); }
  BL_HD Vec3d velocity(Index a) const { return Vec3d(v_rho[a].v); }
};

/// Coordinate along a direction, m.
template <class P>
struct AlongBody {
  Frame frame;
  Span<const P> x;
  Vec3d direction;
  BL_HD double operator()(Index i) const { return dot(direction, coordinates(frame, x[i])); }
};

}  // namespace bedload::inline BL_VARIANT
