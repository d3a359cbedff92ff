#pragma once
#include "kernels/contact/tangential.hpp"

namespace BL_SOLVER {

/// Mindlin-Deresiewicz curve of He et al. (19), (22): slip spreads from the rim until the stretch
/// reaches `slip * overlap`. F_n is that of the normal spring: with damping the curve would not depend on
/// positions alone, and would create energy.
struct MindlinDeresiewicz {
  static constexpr bool kActs = true;
  Real mu = 0;
  Real slip = 0;  ///< mu E* / (4 G*), of one material mu (2 - nu) / (2 - 2 nu)
  Real beta = 0;  ///< damping ratio for the given restitution

  static constexpr bool is(SlidingLaw law) { return law == SlidingLaw::mindlin_deresiewicz; }
  static MindlinDeresiewicz of(const ContactMaterials& m) {
    return {Real(m.mu), Real(m.mu * m.tangential / (4 * m.normal)), Real(damping_ratio(m.e))};
  }
  /// Stretch at which the whole contact slips, m.
  BL_HD Real slipping(Real overlap) const { return slip * overlap; }
  BL_HD Real3 stretch(const SlidingInput& in, const Real3& xi, const Real3& step) const {
    const Real most = slipping(in.overlap);
    Real3 change = step;
    if (in.normal.elastic > in.before.elastic) {
      const Real length = norm(xi), force = force_at(fraction(length, slipping(in.overlap_before)));
      const Real now = stretch_at(force * in.before.elastic / in.normal.elastic) * most;
      if (now < length) change -= (length - now) / length * xi;
    }
    const Real length = norm(xi + change);
    if (length > most) change -= (length - most) / length * (xi + change);
    return change;
  }
  BL_HD SlidingState operator()(const SlidingInput& in, const Real3& xi) const {
    const Real length = norm(xi), most = slipping(in.overlap);
    if (length == 0 || most == 0) return {{}, 0};
    const Real s = fraction(length, most), full = mu * in.normal.elastic;
    return {xi * (-full * force_at(s) / length),
            2 * beta * std::sqrt(Real(1.5) * in.m_star * full * std::sqrt(1 - s) / most)};
  }
  BL_HD Real longest(const SlidingInput& in, Real limit) const {
    const Real full = mu * in.normal.elastic, most = slipping(in.overlap);
    return limit < full ? stretch_at(limit / full) * most : most;
  }
  BL_HD double stored(const SlidingInput& in, const Vec3d& xi) const {
    const double most = slipping(in.overlap);
    if (!(most > 0)) return 0;
    const double s = min_of(norm(xi) / most, 1.0), q = std::sqrt(1 - s);
    return double(mu) * in.normal.elastic * most * (s - 0.4 * (1 - q * q * q * q * q));
  }

 private:
  BL_HD static Real fraction(Real length, Real most) {
    return most > 0 ? min_of(length / most, Real(1)) : Real(1);
  }
  /// Force over mu F_n at the stretch s over that of slip: 1 - q^3 without cancellation at small s.
  BL_HD static Real force_at(Real s) {
    const Real q = std::sqrt(1 - s);
    return s / (1 + q) * (1 + q + q * q);
  }
  BL_HD static Real stretch_at(Real force) {
    const Real q = std::cbrt(1 - force);
    return force / (1 + q + q * q) * (1 + q);
  }
};

}  // namespace BL_SOLVER
