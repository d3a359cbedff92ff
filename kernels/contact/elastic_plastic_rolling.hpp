#pragma once
#include <limits>

#include "bedload/case/parameters.hpp"
#include "kernels/contact/rolling.hpp"

namespace BL_SOLVER {

/// Elastic-plastic spring-dashpot, type C of [ai11]: holds slopes below mu_r.
struct ElasticPlasticRolling {
  static constexpr bool kActs = true, kRemembers = true;
  Real mu_r = 0;
  Real eta = Real(0.3);

  static constexpr bool is(RollingLaw law) { return law == RollingLaw::epsd; }
  static ElasticPlasticRolling of(const ContactMaterials& m) { return {Real(m.mu_r), Real(m.contact.eta_r)}; }
  static void describe(Parameters& p, ContactConfig& c) {
    p("contact.eta_r", &c.eta_r,
      {.meaning = "epsd: damping ratio of the rolling spring", .range = within(0, 1)});
  }
  /// Infinite without friction; as rolling_limit.
  static double longest_step(double normal_stiffness, double mu_r, double R_star, double inertia) {
    const double k_r = 2.25 * normal_stiffness * mu_r * mu_r * R_star * R_star;
    return k_r > 0 ? 0.2 * std::sqrt(inertia / k_r) : std::numeric_limits<double>::infinity();
  }
  BL_HD Real stiffness(Real normal_stiffness, Real R_star) const {
    return Real(2.25) * normal_stiffness * square(mu_r * R_star);
  }
  /// `couple` is the elastic part, already rotated with the contact. A softening spring keeps its angle, a
  /// stiffening one its couple, so neither gains energy.
  template <class S>
  BL_HD Real3 operator()(const RollingInput& in, Vec3<S>& couple) const {
    const Real limit = mu_r * in.R_star * in.normal_force;
    const Real k_r = stiffness(in.normal_stiffness, in.R_star);
    const Real softer =
        quotient(max_of(Real(0), in.stiffness_before - in.normal_stiffness), in.stiffness_before);
    couple -= Vec3<S>(softer * Real3(couple) + (k_r * in.dt) * in.omega);
    if (const Real size = length_of(Real3(couple)); size > limit) {
      couple *= S(limit / size);
      return Real3(couple);
    }
    // sqrt(I_r) sqrt(k_r): the product is too small for fp32 where grains are tiny
    Real3 total = Real3(couple) - in.omega * (2 * eta * std::sqrt(k_r) / std::sqrt(in.inverse_rolling));
    const Real damped = norm(total);
    if (damped > limit) total *= limit / damped;
    return total;
  }
  BL_HD double stored(Real normal_stiffness, Real R_star, const Vec3d& couple) const {
    return mu_r > 0 ? 0.5 * norm2(couple) / double(stiffness(normal_stiffness, R_star)) : 0;
  }
};

}  // namespace BL_SOLVER
