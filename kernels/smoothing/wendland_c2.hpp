#pragma once
#include "bedload/core/pack.hpp"

namespace bedload::inline BL_VARIANT {

/// Wendland's C2 function in three dimensions, support 2h [wendland95].
/// The integral of W is 1, that of F r2 is 3; both vanish at and beyond the support.
struct WendlandC2 {
  static constexpr const char* name = "wendland_c2";
  static constexpr double kappa = 2;  ///< support / h

  Real h, inv_h, norm_W, norm_F;

  /// h: smoothing length (m).
  explicit WendlandC2(double h)
      : h(Real(h)),
        inv_h(Real(1 / h)),
        norm_W(Real(21 / (16 * 3.14159265358979323846 * h * h * h))),
        norm_F(Real(105 / (16 * 3.14159265358979323846 * h * h * h * h * h))) {}

  /// 1/m3, at distance r (m).
  template <class N>
  BL_HD N W(N r) const {
    const N q = r * inv_h;
    const N t = max_of(N(0), 1 - Real(0.5) * q);
    return norm_W * square(square(t)) * (1 + 2 * q);
  }
  /// -W'/r, 1/m5.
  template <class N>
  BL_HD N F(N r) const {
    return norm_F * cube(max_of(N(0), 1 - Real(0.5) * r * inv_h));
  }
};

}  // namespace bedload::inline BL_VARIANT
