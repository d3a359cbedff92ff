#pragma once
#include "bedload/core/pack.hpp"

namespace bedload::inline BL_VARIANT {

/// Lucy's function in three dimensions; h is its support [lucy77].
/// The integral of W is 1, that of F r2 is 3; both vanish at and beyond the support.
struct Lucy {
  static constexpr const char* name = "lucy";
  static constexpr double kappa = 1;  ///< support / h

  Real h, inv_h, norm_W, norm_F;

  /// h: smoothing length (m).
  explicit Lucy(double h)
      : h(Real(h)),
        inv_h(Real(1 / h)),
        norm_W(Real(105 / (16 * 3.14159265358979323846 * h * h * h))),
        norm_F(Real(315 / (4 * 3.14159265358979323846 * h * h * h * h * h))) {}

  /// 1/m3, at distance r (m).
  template <class N>
  BL_HD N W(N r) const {
    const N q = r * inv_h;
    return norm_W * (1 + 3 * q) * cube(max_of(N(0), 1 - q));
  }
  /// -W'/r, 1/m5.
  template <class N>
  BL_HD N F(N r) const {
    return norm_F * square(max_of(N(0), 1 - r * inv_h));
  }
};

}  // namespace bedload::inline BL_VARIANT
