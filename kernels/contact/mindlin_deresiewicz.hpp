#pragma once
#include "kernels/contact/tangential.hpp"

namespace bedload::inline BL_VARIANT {

/// Mindlin-Deresiewicz curve of He et al. (19), (22): slip spreads from the rim until the stretch
/// reaches `slip * overlap`.
struct MindlinDeresiewicz {
  static constexpr bool kActs = true, kPartialSlip = true;
  Real mu = 0;
  Real slip = 0;  ///< mu E* / (4 G*), of one material mu (2 - nu) / (2 - 2 nu)
  Real beta = 0;  ///< damping ratio of the restitution asked for

  static constexpr bool is(SlidingLaw law) { return law == SlidingLaw::mindlin_deresiewicz; }
  static MindlinDeresiewicz of(const ContactMaterials& m) {
    return {Real(m.mu), Real(m.mu * m.tangential / (4 * m.normal)), Real(damping_ratio(m.e))};
  }
  BL_HD double longest(double overlap) const { return double(slip) * overlap; }
  BL_HD Vec3d stretch(const Vec3d& xi, const Vec3d& step, double, double now) const {
    const Vec3d next = xi + step;
    const double most = longest(now), length = norm(next);
    return length > most ? next * (most / length) : next;
  }
  BL_HD SlidingState operator()(const SlidingInput& in, const Vec3d& xi) const {
    const Real length = Real(norm(xi)), limit = Real(longest(in.overlap));
    if (length == 0 || limit == 0) return {{}, 0, 0};
    const Real s = min_of(length / limit, Real(1));
    const Real q = std::sqrt(1 - s);  // 1 - q^3 without cancellation at small s
    const Real force = mu * in.normal_force * s / (1 + q) * (1 + q + q * q);
    const Real damping = 2 * beta * std::sqrt(Real(1.5) * in.m_star * mu * in.normal_force * q / limit);
    return {Real3(xi) * (-force / length), 0, damping};
  }
  BL_HD double stored(const SlidingInput& in, const Vec3d& xi) const {
    const double most = longest(in.overlap);
    if (!(most > 0)) return 0;
    const double s = min_of(norm(xi) / most, 1.0), q = std::sqrt(1 - s);
    return double(mu) * in.normal_force * most * (s - 0.4 * (1 - q * q * q * q * q));
  }
};

}  // namespace bedload::inline BL_VARIANT
