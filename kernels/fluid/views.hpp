#pragma once
// What passes read together of fluid and of walls.

#include "bedload/core/mean_shear.hpp"
#include "bedload/particles/walls.hpp"

namespace BL_SOLVER {

/// Fluid as pair loops read it.
struct FluidView {
  Span<const VelocityDensity<>> flux;  ///< velocity; among grains volume flux, of sheared fluid peculiar
  Span<const EosState<>> state;
};

/// Fluid as it moves.
struct FluidMotion {
  Frame frame;
  MeanShear shear;
  Span<FluidPosition> x;
  Span<VelocityDensity<>> v_rho;
  BL_HD Vec3d at(Index a) const { return coordinates(frame, x[a]); }
};

/// Copies of fluid for pair loops.
struct PairCopies {
  Span<PairPosition> xp, xp_mid;  ///< xp_mid: in the middle of the step; empty where no loop runs there
  Span<VelocityDensity<>> flux;   ///< of sheared fluid, else empty
};

/// Accelerations of fluid, m/s2: by the stress of the mixture, and by everything.
struct FluidAccelerations {
  Span<Real3> stress, whole;
  BL_HD void set(Index a, const Real3& by_stress, const Real3& by_all) const {
    stress[a] = by_stress;
    whole[a] = by_all;
  }
  BL_HD void add(Index a, const Real3& more) const {
    stress[a] += more;
    whole[a] += more;
  }
};

/// Wall particles as fluid meets them.
struct WallView {
  Span<const VelocityDensity<>> v_rho;
  Span<const WallState<>> state;
  Span<const NoSlip<>> no_slip;
};

/// The bodies of wall particles.
struct WallBodies {
  Span<const std::uint32_t> of;  ///< each particle
  Span<const BodyPose> pose;     ///< one a body
  BL_HD const BodyPose& operator[](Index w) const { return pose[of[w]]; }
};

}  // namespace BL_SOLVER
