#pragma once
#include "kernels/contact/tangential.hpp"

namespace BL_SOLVER {

/// Incremental Mindlin: stiffness 8 G* sqrt(R* overlap); as `democritus` S_n / (2 + 2 nu) [tsuzuki] Eq. 31,
/// with the mean nu of both sides.
struct Mindlin {
  static constexpr bool kActs = true;
  Real G_star = 0;  ///< Pa

  static constexpr bool is(SlidingLaw law) {
    return law == SlidingLaw::mindlin || law == SlidingLaw::democritus;
  }
  static Mindlin of(const ContactMaterials& m) {
    if (m.contact.tangential == SlidingLaw::democritus) return {Real(m.E_star() / (8 * (1 + m.nu)))};
    return {Real(m.G_star())};
  }
  BL_HD Real stiffness(const SlidingInput& in) const { return 8 * G_star * in.root; }
  /// Unloading shortens the spring with the contact radius; loading keeps its force.
  BL_HD Real3 stretch(const SlidingInput& in, const Real3& xi, const Real3& step) const {
    const Real before = in.overlap_before, now = in.overlap;
    if (before == 0 || before == now) return step;
    // xi (1 - less)^1/2; where almost nothing is left, a quotient of a GPU may round to above 1
    const Real less = min_of(quotient(std::abs(now - before), max_of(now, before)), Real(1));
    return step - quotient(less, 1 + std::sqrt(1 - less)) * xi;
  }
  BL_HD SlidingState operator()(const SlidingInput& in, const Real3& xi) const {
    const Real k = stiffness(in);
    return {-k * xi, in.normal.damping * std::sqrt(quotient(k, in.normal.stiffness))};
  }
  BL_HD Real longest(const SlidingInput& in, Real limit) const { return limit / stiffness(in); }
  BL_HD double stored(const SlidingInput& in, const Vec3d& xi) const {
    return 0.5 * double(stiffness(in)) * norm2(xi);
  }
};

}  // namespace BL_SOLVER
