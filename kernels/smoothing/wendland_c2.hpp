#pragma once
#include <numbers>

#include "bedload/core/pack.hpp"

namespace BL_SOLVER {

/// Wendland's C2 function in three or two dimensions, support 2h [wendland95].
/// The integral of W is 1, that of F r2 the number of dimensions; both vanish at and beyond the support.
struct WendlandC2 {
  static constexpr double kappa = 2;  ///< support / h

  Real h, inv_support, norm_W, norm_F;  ///< inv_support: 1 / (2 h)
  Real thickness;                       ///< of a plane flow, m; 0 in three dimensions

  /// h: smoothing length (m). In a plane flow of that `thickness` (m; 0: three dimensions) the function in
  /// two dimensions over the thickness, so that volumes are those of the slab.
  explicit WendlandC2(double h, double thickness = 0)
      : h(Real(h)),
        inv_support(Real(0.5 / h)),
        norm_W(Real(thickness > 0 ? 7.0 / 4 / (std::numbers::pi * h * h * thickness)
                                  : 21.0 / 16 / (std::numbers::pi * h * h * h))),
        norm_F(Real(thickness > 0 ? 35.0 / 4 / (std::numbers::pi * h * h * h * h * thickness)
                                  : 105.0 / 16 / (std::numbers::pi * h * h * h * h * h))),
        thickness(Real(thickness)) {}

  /// 1/m3, at distance r (m).
  template <class N>
  BL_HD N W(N r) const {
    const N q = r * inv_support, t = positive_part(1 - q);
    return norm_W * square(square(t)) * (1 + 4 * q);
  }
  /// -W'/r, 1/m5.
  template <class N>
  BL_HD N F(N r) const {
    return norm_F * cube(positive_part(1 - r * inv_support));
  }
};

}  // namespace BL_SOLVER
