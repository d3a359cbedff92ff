#pragma once
#include "bedload/case/parameters.hpp"
#include "kernels/contact/tangential.hpp"

namespace bedload::inline BL_VARIANT {

/// Spring of a constant fraction of the normal stiffness.
struct LinearSliding {
  static constexpr bool kActs = true, kPartialSlip = false;
  Real ratio = Real(2.0 / 7.0);

  static constexpr bool is(SlidingLaw law) { return law == SlidingLaw::linear; }
  static LinearSliding of(const ContactMaterials& m) { return {Real(m.contact.kt_ratio)}; }
  static void describe(Parameters& p, ContactConfig& c) {
    p("contact.kt_ratio", &c.kt_ratio,
      {.meaning = "tangential / normal spring, linear", .range = above_to(0, 1)});
  }
  BL_HD Vec3d stretch(const Vec3d& xi, const Vec3d& step, double, double) const { return xi + step; }
  BL_HD SlidingState operator()(const SlidingInput& in, const Vec3d& xi) const {
    const Real stiffness = ratio * in.normal_stiffness;
    return {-stiffness * Real3(xi), stiffness, in.normal_damping * std::sqrt(ratio)};
  }
  BL_HD double stored(const SlidingInput& in, const Vec3d& xi) const {
    return 0.5 * double(ratio * in.normal_stiffness) * norm2(xi);
  }
};

}  // namespace bedload::inline BL_VARIANT
