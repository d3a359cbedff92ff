#pragma once
#include "bedload/core/span.hpp"
#include "kernels/coupling/wall_share.hpp"

namespace bedload::inline BL_VARIANT {

/// How wet each grain is, from 0 to 1, and what that leaves of the fluid's force on it. Linear in the share
/// S / S_free of the kernel that fluid fills where walls leave it free. With S_dry + S_wet = 1 a flat surface
/// makes half a grain wet, so that a bed which stands out of the water is lifted by what is under it; and as
/// wetness is nearly S itself, fluid in a bed feels the drag of all grains around it, however little fluid
/// there is besides.
struct WetnessPass {
  Real S_dry, S_wet;
  WallFreeShare wall_free;
  Span<const Vec3d> x;
  Span<Real> inv_S;  ///< set to 0 where dry
  Span<Real> wetness;
  Span<Real3> fluid_force;

  BL_HD void operator()(Index j) const {
    Real S = inv_S[j] > 0 ? 1 / inv_S[j] : 0;
    if (S > 0 && S < S_wet) S /= wall_free(x[j]);
    const Real wet = clamp((S - S_dry) / (S_wet - S_dry), Real(0), Real(1));
    if (!(wet > 0)) inv_S[j] = 0;
    wetness[j] = wet;
    fluid_force[j] *= wet;
  }
};

}  // namespace bedload::inline BL_VARIANT
