#pragma once
#include "bedload/case/parameters.hpp"
#include "kernels/contact/rolling.hpp"

namespace BL_SOLVER {

/// Constant couple against the relative spin, He et al. (25); capped where it would reverse the spin.
struct ConstantRolling {
  static constexpr bool kActs = true, kRemembers = false;
  Real mu_r = 0;
  bool cap = true;

  static constexpr bool is(RollingLaw law) { return law == RollingLaw::cdt; }
  static ConstantRolling of(const ContactMaterials& m) { return {Real(m.mu_r), m.contact.cap_rolling}; }
  static void describe(Parameters& p, ContactConfig& c) {
    p("contact.cap_rolling", &c.cap_rolling,
      {.meaning = "cdt: the torque does not reverse the rotation within a substep; without it grains at rest "
                  "vibrate"});
  }
  BL_HD Real3 operator()(const RollingInput& in) const {
    const Real speed = norm(in.omega);
    if (speed == 0) return {};
    Real couple = mu_r * in.R_star * in.normal_force;
    if (cap && in.dt > 0) couple = min_of(couple, speed / (in.inverse_spin * in.dt));
    return in.omega * (-couple / speed);
  }
  template <class S>
  BL_HD Real3 operator()(const RollingInput& in, Vec3<S>&) const {
    return (*this)(in);
  }
  BL_HD double stored(Real, Real, const Vec3d&) const { return 0; }
};

}  // namespace BL_SOLVER
