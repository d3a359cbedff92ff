#pragma once
#include "bedload/core/frame.hpp"
#include "bedload/particles/fluid.hpp"

namespace BL_SOLVER {

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

}  // namespace BL_SOLVER
