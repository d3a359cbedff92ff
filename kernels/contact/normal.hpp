#pragma once
// Forces along the normal of a contact. Each law has its own header with
//   is           the name in a case file,
//   of           parameters from the materials,
//   operator()   force, stiffness and damping,
//   dashpot      the fraction of a substep in which damping acts,
//   kEnergy      stored energy over force times overlap,
// optionally a member
//   range        how far apart, over R*, spheres that have touched still act on each other; overlaps are then
//                negative, and so is the force that holds them,
// for the host (contact_laws.hpp) `kLeastRestitution` without tension, `kTakesModuli`, `impact` and
// `overlap_under`, and optionally `describe` (its own keys).

#include <cmath>
#include <string>

#include "bedload/case/contact_laws.hpp"
#include "bedload/core/error.hpp"
#include "bedload/core/types.hpp"
#include "kernels/contact/materials.hpp"
#include "kernels/contact/one_of.hpp"

namespace BL_SOLVER {

/// Whether a law, or one of several, reaches beyond touch.
template <class Law>
constexpr bool kReaches = requires(const Law& law) {
  law.range;
};
template <class... Laws>
constexpr bool kReaches<OneOf<Laws...>> = (kReaches<Laws> || ...);

/// One contact along its normal: force F_n = elastic - damping v_n, v_n > 0 when receding.
struct NormalState {
  Real elastic;    ///< N
  Real stiffness;  ///< tangent stiffness S_n, N/m
  Real damping;    ///< c_n, N s/m
};

/// Fraction of a substep in which a dashpot of constant strength acts. Its force jumps when a contact begins
/// and ends; a kick covers the half steps before and after it and is scaled to the time in contact. before,
/// now: overlaps (m), 0: apart; v_n > 0 when receding (m/s).
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

}  // namespace BL_SOLVER
