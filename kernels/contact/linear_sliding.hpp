#pragma once
#include "bedload/case/parameters.hpp"
#include "kernels/contact/tangential.hpp"

namespace BL_SOLVER {

/// Spring of a constant fraction of the normal stiffness.
struct LinearSliding {
  static constexpr bool kActs = true;
  Real ratio = Real(2.0 / 7.0);

  static constexpr bool is(SlidingLaw law) { return law == SlidingLaw::linear; }
  static LinearSliding of(const ContactMaterials& m) { return {Real(m.contact.kt_ratio)}; }
  static void describe(Parameters& p, ContactConfig& c) {
    p("contact.kt_ratio", &c.kt_ratio,
      {.meaning = "linear: tangential over normal stiffness", .range = above_to(0, 1)});
  }
  BL_HD Real stiffness(const SlidingInput& in) const { return ratio * in.normal.stiffness; }
  BL_HD Real3 stretch(const SlidingInput& in, const Real3& xi, const Real3& step) const {
    const Real stiffer = max_of(Real(0), in.normal.stiffness - in.before.stiffness);
    return step - stiffer / in.normal.stiffness * xi;
  }
  BL_HD SlidingState operator()(const SlidingInput& in, const Real3& xi) const {
    return {-stiffness(in) * xi, in.normal.damping * std::sqrt(ratio)};
  }
  BL_HD Real longest(const SlidingInput& in, Real limit) const { return limit / stiffness(in); }
  BL_HD double stored(const SlidingInput& in, const Vec3d& xi) const {
    return 0.5 * double(stiffness(in)) * norm2(xi);
  }
};

}  // namespace BL_SOLVER
