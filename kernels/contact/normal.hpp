#pragma once
// Forces along the normal of a contact. A law has its parameters from `of`, force, stiffness and damping from
// its operator, `dashpot`, the fraction of a substep in which damping acts, and `kEnergy`.

#include <cmath>
#include <string>

#include "bedload/core/error.hpp"
#include "bedload/core/types.hpp"
#include "kernels/contact/materials.hpp"

namespace bedload::inline BL_VARIANT {

/// One contact along its normal: force F_n = elastic - damping v_n, v_n > 0 when receding.
struct NormalState {
  Real elastic;    ///< N
  Real stiffness;  ///< tangent stiffness S_n, N/m
  Real damping;    ///< c_n, N s/m
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

/// Of `democritus`: the damping 2 sqrt(2 m* S_n) of [tsuzuki] Eq. 32, sqrt 2 times critical, S_n being the
/// tangent stiffness in place of the k_n of its linear spring.
constexpr double kDemocritus = 3.4641016151377544;  // 2 sqrt 3

/// F = k_H overlap^1.5, damping alpha sqrt(m* k_H) overlap^0.25: restitution does not depend on speed.
struct Hertz {
  static constexpr double kEnergy = 0.4;  ///< stored, over force times overlap
  Real E_star = 0;                        ///< Pa
  Real alpha = 0;

  static Hertz of(const ContactMaterials& m) {
    const bool paper = m.contact.he_damping;
    double alpha = paper ? std::sqrt(6.0) * damping_ratio(m.e) : hertz_damping(m.e, m.contact.clip_tension);
    if (m.contact.normal == NormalLaw::democritus) alpha = kDemocritus;
    return {Real(m.E_star()), Real(alpha)};
  }
  /// R_star, m_star: reduced radius and mass (m, kg); overlap > 0 (m).
  BL_HD NormalState operator()(Real R_star, Real m_star, Real overlap) const {
    const Real stiffness = 2 * E_star * std::sqrt(R_star * overlap);
    return {stiffness * overlap * Real(2.0 / 3.0), stiffness,
            alpha * std::sqrt(m_star * stiffness * Real(2.0 / 3.0))};
  }
  /// Of a substep, in which the dashpot acts: it grows from nothing at touch.
  BL_HD Real dashpot(double, Real, Real, Real, bool) const { return 1; }
};

/// F = k overlap, damping 2 beta sqrt(m* k).
struct LinearSpring {
  static constexpr double kEnergy = 0.5;
  Real k = 0;     ///< N/m
  Real beta = 0;  ///< damping ratio

  /// Throws KeyError without k, and where clipped damping cannot reach e.
  static LinearSpring of(const ContactMaterials& m) {
    const ContactConfig& c = m.contact;
    if (!(c.k > 0))
      throw KeyError("contact.k",
                     "contact.k = " + std::to_string(c.k) + ": must be > 0 N/m for a linear spring");
    if (c.clip_tension && m.e < std::exp(-2.0))
      throw KeyError("grain.e", "grain.e = " + std::to_string(m.e) +
                                    ": must be at least 0.136 for a linear spring that never pulls; "
                                    "set contact.clip_tension = false");
    return {Real(c.k), Real(c.clip_tension ? damping_ratio_clipped(m.e) : damping_ratio(m.e))};
  }
  BL_HD NormalState operator()(Real, Real m_star, Real overlap) const {
    return {k * overlap, k, 2 * beta * std::sqrt(m_star * k)};
  }
  BL_HD Real dashpot(double before, Real now, Real v_n, Real dt, bool may_pull) const {
    return dashpot_fraction(before, now, v_n, dt, may_pull);
  }
};

}  // namespace bedload::inline BL_VARIANT
