#pragma once
#include <algorithm>
#include <numbers>

#include "bedload/case/parameters.hpp"
#include "kernels/contact/normal.hpp"

namespace BL_SOLVER {

/// F = k overlap, damping 2 beta sqrt(m* k).
struct LinearSpring {
  static constexpr double kEnergy = 0.5;
  Real k = 0;     ///< N/m
  Real beta = 0;  ///< damping ratio

  static constexpr bool is(NormalLaw law) { return law == NormalLaw::linear; }
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
  static void describe(Parameters& p, ContactConfig& c) {
    p("contact.k", &c.k,
      {.unit = "N/m",
       .meaning = "linear: normal stiffness",
       .range = above(0),
       .fallback = "required if linear",
       .presence = Presence::optional});
  }
  static constexpr double kLeastRestitution = 0.136;  // exp(-2)
  static constexpr bool kTakesModuli = false;
  static Impact impact(const ContactConfig& c, double m, double, double, double, double e) {
    using std::numbers::pi;
    const double damping = std::log(e) / std::hypot(pi, std::log(e));
    return {pi * std::sqrt(m / c.k) / std::sqrt(1 - damping * damping), c.k};
  }
  static double overlap_under(const ContactConfig& c, double force, double, double) {
    return force / std::max(c.k, 1e-300);
  }
  BL_HD NormalState operator()(Real, Real m_star, Real overlap) const {
    return {k * overlap, k, 2 * beta * std::sqrt(m_star * k)};
  }
  BL_HD Real dashpot(double before, Real now, Real v_n, Real dt, bool may_pull) const {
    return dashpot_fraction(before, now, v_n, dt, may_pull);
  }
};

}  // namespace BL_SOLVER
