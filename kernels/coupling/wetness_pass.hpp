#pragma once
#include "bedload/core/span.hpp"

namespace BL_SOLVER {

/// Wetness of each grain, from 0 to 1, by which its drag is scaled. Linear in S / S_free, the fraction of the
/// part of the kernel not cut off by walls that fluid fills. With S_dry + S_wet = 1 a grain at a flat surface
/// is half wet. As wetness is close to S, the drag of all grains around it acts on fluid in a bed, however
/// little fluid there is.
struct WetnessPass {
  Real S_dry, S_wet;
  Span<const Real> wall_free;
  Span<Real> inv_S;  ///< set to 0 for dry grains
  Span<Real> wetness;

  BL_HD void operator()(Index j) const {
    Real S = inv_S[j] > 0 ? 1 / inv_S[j] : 0;
    if (S > 0 && S < S_wet) S /= wall_free[j];
    const Real wet = clamp((S - S_dry) / (S_wet - S_dry), Real(0), Real(1));
    if (!(wet > 0)) inv_S[j] = 0;
    wetness[j] = wet;
  }
};

}  // namespace BL_SOLVER
