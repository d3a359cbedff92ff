#pragma once
#include "kernels/contact/tangential.hpp"

namespace bedload::inline BL_VARIANT {

/// Incremental Mindlin: stiffness 8 G* sqrt(R* overlap); as `democritus` S_n / (2 + 2 nu) [tsuzuki] Eq. 31,
/// with the mean nu of both sides.
struct Mindlin {
  static constexpr bool kActs = true, kPartialSlip = false;
  Real G_star = 0;  ///< Pa

  static constexpr bool is(SlidingLaw law) {
    return law == SlidingLaw::mindlin || law == SlidingLaw::democritus;
  }
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
    return xi * std::sqrt(min_of(now, before) / max_of(now, before));
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

}  // namespace bedload::inline BL_VARIANT
