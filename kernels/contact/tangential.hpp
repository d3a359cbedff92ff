#pragma once
// Sliding friction: a damped tangential spring xi, limited by mu F_n. Each law has its own header with
//   is           the name in a case file,
//   of           parameters from the materials,
//   stretch      how much the spring changes with one more `step` (m): a small difference, found as such,
//                since springs are sums in fp64,
//   operator()   force and damping,
//   longest      the stretch (m) at which the force reaches the limit (N),
//   stored       energy, J,
//   kActs        false: frictionless,
// and optionally `describe` (its own keys). No law creates energy: when the stiffness has changed with the
// overlap, `stretch` first adjusts the spring so that its energy does not grow. A spring that has become
// stiffer keeps its force, not its length [thornton13].

#include "kernels/contact/history.hpp"
#include "kernels/contact/normal.hpp"

namespace BL_SOLVER {

/// What the tangential laws need to know of the normal direction.
struct SlidingInput {
  Real normal_force;           ///< total, >= 0, N
  NormalState normal, before;  ///< now and at the last evaluation; equal in a new contact
  Real root;                   ///< sqrt(R* overlap), m
  Real m_star;                 ///< kg
  Real overlap;                ///< m
  Real overlap_before;         ///< m, 0 in a new contact
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
  BL_HD Real3 stretch(const SlidingInput&, const Real3&, const Real3&) const { return {}; }
  BL_HD SlidingState operator()(const SlidingInput&, const Real3&) const { return {{}, 0}; }
  BL_HD Real longest(const SlidingInput&, Real) const { return 0; }
  BL_HD double stored(const SlidingInput&, const Vec3d&) const { return 0; }
};

}  // namespace BL_SOLVER
