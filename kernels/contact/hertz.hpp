#pragma once
#include "kernels/contact/normal.hpp"

namespace BL_SOLVER {

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

  static constexpr bool is(NormalLaw law) { return law == NormalLaw::hertz || law == NormalLaw::democritus; }
  static Hertz of(const ContactMaterials& m) {
    const bool paper = m.contact.he_damping;
    double alpha = paper ? std::sqrt(6.0) * damping_ratio(m.e) : hertz_damping(m.e, m.contact.clip_tension);
    if (m.contact.normal == NormalLaw::democritus) alpha = kDemocritus;
    return {Real(m.E_star()), Real(alpha)};
  }
  static constexpr double kLeastRestitution = 0.05;  // of the fit
  static constexpr bool kTakesModuli = true;
  static Impact impact(const ContactConfig&, double m, double R, double E, double v, double) {
    if (!(v > 0)) return {};
    const double overlap = std::pow(15 * m * v * v / (16 * E * std::sqrt(R)), 0.4);
    return {2.8683 * std::pow(m * m / (R * E * E * v), 0.2), 2 * E * std::sqrt(R * overlap)};
  }
  static double overlap_under(const ContactConfig&, double force, double R, double E) {
    return std::pow(force / (4.0 / 3 * E * std::sqrt(R)), 2.0 / 3);
  }
  /// R_star, m_star: reduced radius and mass (m, kg); overlap > 0 (m).
  BL_HD NormalState operator()(Real R_star, Real m_star, Real overlap) const {
    const Real stiffness = 2 * E_star * std::sqrt(R_star * overlap);
    return {stiffness * overlap * Real(2.0 / 3.0), stiffness,
            alpha * std::sqrt(m_star * stiffness * Real(2.0 / 3.0))};
  }
  /// The dashpot acts in the whole substep: its strength grows from zero with the overlap.
  BL_HD Real dashpot(double, Real, Real, Real, bool) const { return 1; }
};

}  // namespace BL_SOLVER
