#pragma once
// Sliding friction: a tangential spring xi, damped, never above mu F_n. A law, which has a header of its own,
// has the names that a case gives it from `is`, its parameters from `of`, `stretch`, the spring after one
// more `step` (m), force and damping from its operator, `longest`, the stretch (m) whose force is the limit
// (N), and `stored`, J. `kActs`: false where there is none. Keys of its own, if it has any, by `describe`.
// No law gives energy: before the step, `stretch` leaves a spring whose stiffness has changed with the
// overlap no more energy than it had. Where it has become stiffer it keeps its force, not its length
// [thornton13].

#include "kernels/contact/history.hpp"
#include "kernels/contact/normal.hpp"

namespace bedload::inline BL_VARIANT {

/// What the tangential laws need to know of the normal direction.
struct SlidingInput {
  Real normal_force;           ///< total, >= 0, N
  NormalState normal, before;  ///< now and at the last evaluation, now at touch
  Real root;                   ///< sqrt(R* overlap), m
  Real m_star;                 ///< kg
  double overlap;              ///< m, to Real's digits
  double overlap_before;       ///< m, 0 at touch
};

/// Spring force and damping coefficient for one stretch.
struct SlidingState {
  Real3 elastic;  ///< N
  Real damping;   ///< N s/m
};

/// Frictionless.
struct NoSliding {
  static constexpr bool kActs = false;

  static constexpr bool is(SlidingLaw law) { return law == SlidingLaw::none; }
  static NoSliding of(const ContactMaterials&) { return {}; }
  BL_HD Vec3d stretch(const SlidingInput&, const Vec3d&, const Vec3d&) const { return {}; }
  BL_HD SlidingState operator()(const SlidingInput&, const Vec3d&) const { return {{}, 0}; }
  BL_HD Real longest(const SlidingInput&, Real) const { return 0; }
  BL_HD double stored(const SlidingInput&, const Vec3d&) const { return 0; }
};

}  // namespace bedload::inline BL_VARIANT
