#pragma once
#include "bedload/core/pack.hpp"

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
  template <class N>
  BL_HD N W(N r) const {
    const N q = r * inv_h;
    return select(q < 1, norm_W * (1 - q * q * (Real(1.5) - Real(0.75) * q)),
                  norm_W * Real(0.25) * cube(max_of(N(0), 2 - q)));
  }
  /// -W'/r, 1/m5.
  template <class N>
  BL_HD N F(N r) const {
    const N q = r * inv_h;
    return select(q < 1, norm_F * (3 - Real(2.25) * q),
                  norm_F * Real(0.75) * square(max_of(N(0), 2 - q)) / q);
  }
};

}  // namespace bedload::inline BL_VARIANT
