#pragma once
// Sliding friction: a tangential spring xi, damped, never above mu F_n. A law has its parameters from `of`,
// `stretch`, the spring after one more `step` (m), force and damping from its operator, `stored`, J, and
// `kPartialSlip`: whether it slips by itself, so that Coulomb's limit leaves xi as it is.

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

/// Incremental Mindlin: stiffness 8 G* sqrt(R* overlap); as `democritus` S_n / (2 + 2 nu) [tsuzuki] Eq. 31,
/// with the mean nu of both sides.
struct Mindlin {
  static constexpr bool kPartialSlip = false;
  Real G_star = 0;  ///< Pa

  static Mindlin of(const ContactMaterials& m) {
    if (m.contact.tangential == SlidingLaw::democritus) return {Real(m.E_star() / (8 * (1 + m.nu)))};
    return {Real(m.G_star())};
  }
  BL_HD Vec3d stretch(const Vec3d& xi, const Vec3d& step, double before, double now) const {
    return rescale(xi, before, now) + step;
  }
  /// Keeps a closed cycle from gaining work: unloading shortens the spring with the contact radius,
  /// and loading leaves the force as it is although the stiffness grows.
  BL_HD static Vec3d rescale(const Vec3d& xi, double before, double now) {
    if (before == 0 || before == now) return xi;
    return xi * std::sqrt(now < before ? now / before : before / now);
  }
  BL_HD SlidingState operator()(const SlidingInput& in, const Vec3d& xi) const {
    const Real stiffness = 8 * G_star * in.root;
    return {-stiffness * Real3(xi), stiffness,
            in.normal_damping * std::sqrt(stiffness / in.normal_stiffness)};
  }
  BL_HD double stored(const SlidingInput& in, const Vec3d& xi) const {
    return 0.5 * double(8 * G_star * in.root) * norm2(xi);
  }
};

/// Spring of a constant fraction of the normal stiffness.
struct LinearSliding {
  static constexpr bool kPartialSlip = false;
  Real ratio = Real(2.0 / 7.0);

  static LinearSliding of(const ContactMaterials& m) { return {Real(m.contact.kt_ratio)}; }
  BL_HD Vec3d stretch(const Vec3d& xi, const Vec3d& step, double, double) const { return xi + step; }
  BL_HD SlidingState operator()(const SlidingInput& in, const Vec3d& xi) const {
    const Real stiffness = ratio * in.normal_stiffness;
    return {-stiffness * Real3(xi), stiffness, in.normal_damping * std::sqrt(ratio)};
  }
  BL_HD double stored(const SlidingInput& in, const Vec3d& xi) const {
    return 0.5 * double(ratio * in.normal_stiffness) * norm2(xi);
  }
};

/// Mindlin-Deresiewicz curve of He et al. (19), (22): slip spreads from the rim until the stretch
/// reaches `slip * overlap`.
struct MindlinDeresiewicz {
  static constexpr bool kPartialSlip = true;
  Real mu = 0;
  Real slip = 0;  ///< mu E* / (4 G*), of one material mu (2 - nu) / (2 - 2 nu)
  Real beta = 0;  ///< damping ratio of the restitution asked for

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
