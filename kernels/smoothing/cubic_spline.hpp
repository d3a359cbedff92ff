#pragma once
#include <numbers>

#include "bedload/core/pack.hpp"

namespace BL_SOLVER {

/// Cubic spline in three or two dimensions, support 2h [monaghan92].
/// The integral of W is 1, that of F r2 the number of dimensions; both vanish at and beyond the support.
struct CubicSpline {
  static constexpr double kappa = 2;  ///< support / h

  Real h, inv_h, norm_W, norm_F;
  Real thickness;  ///< of a plane flow, m; 0 in three dimensions

  /// h: smoothing length (m). In a plane flow of that `thickness` (m; 0: three dimensions) the function in
  /// two dimensions over the thickness, so that volumes are those of the slab.
  explicit CubicSpline(double h, double thickness = 0)
      : h(Real(h)),
        inv_h(Real(1 / h)),
        norm_W(Real(thickness > 0 ? 10.0 / 7 / (std::numbers::pi * h * h * thickness)
                                  : 1 / (std::numbers::pi * h * h * h))),
        norm_F(Real(thickness > 0 ? 10.0 / 7 / (std::numbers::pi * h * h * h * h * thickness)
                                  : 1 / (std::numbers::pi * h * h * h * h * h))),
        thickness(Real(thickness)) {}

  /// 1/m3, at distance r (m).
  template <class N>
  BL_HD N W(N r) const {
    const N q = r * inv_h;
    return select(q < 1, norm_W * (1 - q * q * (Real(1.5) - Real(0.75) * q)),
                  norm_W * Real(0.25) * cube(positive_part(2 - q)));
  }
  /// -W'/r, 1/m5.
  template <class N>
  BL_HD N F(N r) const {
    const N q = r * inv_h;
    return select(q < 1, norm_F * (3 - Real(2.25) * q),
                  norm_F * Real(0.75) * square(positive_part(2 - q)) / q);
  }
};

}  // namespace BL_SOLVER
