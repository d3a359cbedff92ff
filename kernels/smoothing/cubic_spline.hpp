#pragma once
#include "bedload/core/types.hpp"

namespace bedload::inline BL_VARIANT {

/// Cubic spline in three dimensions, support 2h [monaghan92].
/// The integral of W is 1, that of F r2 is 3; both vanish at and beyond the support.
struct CubicSpline {
  static constexpr const char* name = "cubic";
  static constexpr double kappa = 2;  ///< support / h

  Real h, inv_h, norm_W, norm_F;

  /// h: smoothing length (m).
  explicit CubicSpline(double h)
      : h(Real(h)),
        inv_h(Real(1 / h)),
        norm_W(Real(1 / (3.14159265358979323846 * h * h * h))),
        norm_F(Real(1 / (3.14159265358979323846 * h * h * h * h * h))) {}

  /// 1/m3, at distance r (m).
  BL_HD Real W(Real r) const {
    const Real q = r * inv_h;
    if (q < 1) return norm_W * (1 - q * q * (Real(1.5) - Real(0.75) * q));
    return norm_W * Real(0.25) * cube(max_of(Real(0), 2 - q));
  }
  /// -W'/r, 1/m5.
  BL_HD Real F(Real r) const {
    const Real q = r * inv_h;
    if (q < 1) return norm_F * (3 - Real(2.25) * q);
    return norm_F * Real(0.75) * square(max_of(Real(0), 2 - q)) / q;
  }
};

}  // namespace bedload::inline BL_VARIANT
