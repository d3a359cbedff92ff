#pragma once
// Sliding friction: a tangential spring xi, damped, never above mu F_n. A law, which has a header of its own,
// has the names that a case gives it from `is`, its parameters from `of`, `stretch`, the spring after one
// more `step` (m), force and damping from its operator, `stored`, J, and `kPartialSlip`: whether it slips by
// itself, so that Coulomb's limit leaves xi as it is. `kActs`: false where there is none. Keys of its own, if
// it has any, by `describe`.

#include "kernels/contact/history.hpp"
#include "kernels/contact/normal.hpp"

namespace bedload::inline BL_VARIANT {

/// What the tangential laws need to know of the normal direction.
struct SlidingInput {
  Real normal_force;  ///< total, >= 0, N
  Real normal_stiffness, normal_damping;
  Real root;       ///< sqrt(R* overlap), m
  Real m_star;     ///< kg
  double overlap;  ///< m
};

/// Spring force and damping coefficient for one stretch.
struct SlidingState {
  Real3 elastic;   ///< N
  Real stiffness;  ///< of the spring, N/m
  Real damping;    ///< N s/m
};

/// Frictionless.
struct NoSliding {
  static constexpr bool kActs = false, kPartialSlip = false;

  static constexpr bool is(SlidingLaw law) { return law == SlidingLaw::none; }
  static NoSliding of(const ContactMaterials&) { return {}; }
  BL_HD Vec3d stretch(const Vec3d&, const Vec3d&, double, double) const { return {}; }
  BL_HD SlidingState operator()(const SlidingInput&, const Vec3d&) const { return {{}, 0, 0}; }
  BL_HD double stored(const SlidingInput&, const Vec3d&) const { return 0; }
};

}  // namespace bedload::inline BL_VARIANT
