#pragma once
// Rolling friction: a couple M on the first partner, -M on the second. Each law has its own header with
//   is           the name in a case file,
//   of           parameters from the materials,
//   operator()   M; may keep `couple` for the next substep if kRemembers,
//   stored       energy, J,
//   kActs        false: no rolling friction,
// and optionally `longest_step` (of a spring) and `describe` (its own keys), for the host.

#include "kernels/contact/history.hpp"
#include "kernels/contact/materials.hpp"

namespace BL_SOLVER {

/// omega is the relative spin without its part along the normal.
struct RollingInput {
  Real3 omega;            ///< rad/s
  Real normal_force;      ///< >= 0, N
  Real normal_stiffness;  ///< N/m
  Real stiffness_before;  ///< the same at the last evaluation, N/m
  Real R_star;            ///< m
  Real inverse_spin;      ///< sum of 1/I, 1/(kg m2)
  Real inverse_rolling;   ///< sum of 1/(I + m R2)
  Real dt;                ///< s
};

/// Free rolling.
struct NoRolling {
  static constexpr bool kActs = false, kRemembers = false;

  static constexpr bool is(RollingLaw law) { return law == RollingLaw::none; }
  static NoRolling of(const ContactMaterials&) { return {}; }
  template <class S>
  BL_HD Real3 operator()(const RollingInput&, Vec3<S>&) const {
    return {};
  }
  BL_HD double stored(Real, Real, const Vec3d&) const { return 0; }
};

}  // namespace BL_SOLVER
