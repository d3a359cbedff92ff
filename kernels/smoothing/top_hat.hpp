#pragma once
#include "bedload/core/pack.hpp"

namespace BL_SOLVER {

/// The same everywhere within h, nothing beyond it. Of the coupling alone: it has no derivative.
struct TopHat {
  static constexpr double kappa = 1;  ///< support / h

  Real h, level;
  Real thickness = 0;  ///< three dimensions

  /// h: m
  explicit TopHat(double h) : h(Real(h)), level(Real(3 / (4 * M_PI * h * h * h))) {}
  /// 1/m3, at distance r (m).
  template <class N>
  BL_HD N W(N r) const {
    return select(r < N(h), N(level), N(0));
  }
};

}  // namespace BL_SOLVER
