#pragma once
// Forces along the normal of a contact.

#include "bedload/core/types.hpp"

namespace bedload::inline BL_VARIANT {

/// One contact along its normal: force F_n = elastic - damping v_n, v_n > 0 when receding.
struct NormalState {
  Real elastic;    ///< N
  Real stiffness;  ///< tangent stiffness S_n, N/m
  Real damping;    ///< c_n, N s/m
};

/// F = k_H overlap^1.5, damping alpha sqrt(m* k_H) overlap^0.25: restitution does not depend on speed.
struct Hertz {
  Real E_star = 0;  ///< Pa
  Real alpha = 0;

  /// R_star, m_star: reduced radius and mass (m, kg); overlap > 0 (m).
  BL_HD NormalState operator()(Real R_star, Real m_star, Real overlap) const {
    const Real stiffness = 2 * E_star * std::sqrt(R_star * overlap);
    return {stiffness * overlap * Real(2.0 / 3.0), stiffness,
            alpha * std::sqrt(m_star * stiffness * Real(2.0 / 3.0))};
  }
};

/// F = k overlap, damping 2 beta sqrt(m* k).
struct LinearSpring {
  Real k = 0;     ///< N/m
  Real beta = 0;  ///< damping ratio

  BL_HD NormalState operator()(Real, Real m_star, Real overlap) const {
    return {k * overlap, k, 2 * beta * std::sqrt(m_star * k)};
  }
};

/// Fraction of a substep in which a dashpot of constant strength acts: its force jumps at touch and at leave,
/// and a kick, which stands for the half steps before and after it, is cut or drawn out to the time of
/// contact. before, now: overlaps (m), 0: apart; v_n > 0 when receding (m/s).
BL_HD Real dashpot_fraction(double before, Real now, Real v_n, Real dt, bool may_pull) {
  const Real way = std::abs(v_n) * dt;
  if (way == 0) return 1;
  if (v_n < 0 && before == 0) return Real(0.5) + min_of(Real(1), now / way);
  if (v_n > 0 && may_pull && now < way) return Real(0.5) + now / way;
  return 1;
}

/// Damping ratio of the linear oscillator that rebounds with e when the spring may pull.
inline double damping_ratio(double e) {
  const double x = -std::log(e);
  return x / std::sqrt(9.86960440108935862 + x * x);
}

/// As damping_ratio, for a spring that never pulls; e in [exp(-2), 1].
inline double damping_ratio_clipped(double e) {
  double lo = 0, hi = 1;
  for (int k = 0; k < 100; ++k) {
    const double b = 0.5 * (lo + hi), root = std::sqrt(1 - b * b);
    const double rebound = std::exp(-b / root * std::atan2(2 * b * root, 2 * b * b - 1));
    (rebound > e ? lo : hi) = b;
  }
  return 0.5 * (lo + hi);
}

/// Prefactor alpha of Hertz damping: sqrt 5 damping_ratio(e) where the spring may pull, else a fit
/// (error in e below 7e-5 on [0.05, 1]).
inline double hertz_damping(double e, bool clip) {
  if (!clip) return std::sqrt(5.0) * damping_ratio(e);
  const double x = -std::log(e);
  return x * (0.71149 + x * (0.14661 + x * (0.018182 + x * 0.0051058)));
}

}  // namespace bedload::inline BL_VARIANT
