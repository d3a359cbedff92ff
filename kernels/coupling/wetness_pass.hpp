#pragma once
#include "bedload/core/span.hpp"

namespace bedload::inline BL_VARIANT {

/// The wetted fraction of each grain, from 0 to 1, and so how much of its drag acts on it. Linear in the
/// fraction S / S_free of the kernel that fluid fills where walls leave it free. With S_dry + S_wet = 1 a
/// flat surface makes half a grain wet; and as wetness is nearly S itself, the drag of all grains around it
/// acts on fluid in a bed, however little fluid there is besides.
struct WetnessPass {
  Real S_dry, S_wet;
  Span<const Real> wall_free;
  Span<Real> inv_S;  ///< set to 0 where dry
  Span<Real> wetness;

  BL_HD void operator()(Index j) const {
    Real S = inv_S[j] > 0 ? 1 / inv_S[j] : 0;
    if (S > 0 && S < S_wet) S /= wall_free[j];
    const Real wet = clamp((S - S_dry) / (S_wet - S_dry), Real(0), Real(1));
    if (!(wet > 0)) inv_S[j] = 0;
    wetness[j] = wet;
  }
};

}  // namespace bedload::inline BL_VARIANT
