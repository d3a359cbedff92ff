#pragma once
// Rolling friction: a couple M on the first partner, -M on the second. A law has its parameters from `of`, M
// from its operator, which may keep `couple` for the next substep, and `stored`, J.

#include "kernels/contact/history.hpp"
#include "kernels/contact/materials.hpp"

namespace bedload::inline BL_VARIANT {

/// omega is the relative spin without its part along the normal.
struct RollingInput {
  Real3 omega;            ///< rad/s
  Real normal_force;      ///< >= 0, N
  Real normal_stiffness;  ///< N/m
  Real R_star;            ///< m
  Real inverse_spin;      ///< sum of 1/I, 1/(kg m2)
  Real inverse_rolling;   ///< sum of 1/(I + m R2)
  Real dt;                ///< s
};

/// Elastic-plastic spring-dashpot, type C of [ai11]: holds slopes below mu_r.
struct ElasticPlasticRolling {
  Real mu_r = 0;
  Real eta = Real(0.3);

  static ElasticPlasticRolling of(const ContactMaterials& m) { return {Real(m.mu_r), Real(m.contact.eta_r)}; }
  BL_HD Real stiffness(Real normal_stiffness, Real R_star) const {
    return Real(2.25) * normal_stiffness * square(mu_r * R_star);
  }
  /// `couple` is the elastic part, already turned with the contact.
  BL_HD Real3 operator()(const RollingInput& in, Vec3d& couple) const {
    const Real limit = mu_r * in.R_star * in.normal_force;
    const Real k_r = stiffness(in.normal_stiffness, in.R_star);
    couple -= double(k_r * in.dt) * Vec3d(in.omega);
    const double size = norm(couple);
    if (size > limit) {
      couple *= limit / size;
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

/// Constant couple against the relative spin, He et al. (25); capped where it would turn the spin round.
struct ConstantRolling {
  Real mu_r = 0;
  bool cap = true;

  static ConstantRolling of(const ContactMaterials& m) { return {Real(m.mu_r), m.contact.cap_rolling}; }
  BL_HD Real3 operator()(const RollingInput& in) const {
    const Real speed = norm(in.omega);
    if (speed == 0) return {};
    Real couple = mu_r * in.R_star * in.normal_force;
    if (cap && in.dt > 0) couple = min_of(couple, speed / (in.inverse_spin * in.dt));
    return in.omega * (-couple / speed);
  }
  BL_HD Real3 operator()(const RollingInput& in, Vec3d&) const { return (*this)(in); }
  BL_HD double stored(Real, Real, const Vec3d&) const { return 0; }
};

}  // namespace bedload::inline BL_VARIANT
