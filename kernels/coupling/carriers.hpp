#pragma once
#include "bedload/core/span.hpp"
#include "kernels/coupling/symmetric_matrix.hpp"

namespace BL_SOLVER {

#if BL_CUDA
/// Type of the sum of weights, by which the others are divided: fp64 where one thread sums a long row.
template <class N>
using Divisor = double;
#else
template <class N>
using Divisor = N;
#endif

/// Weighted sums over the fluid around a grain; u: velocity relative to the grain, m/s; arm: r_a - r_j, m.
template <class N = Real>
struct FlowSums {
  Divisor<N> weight{};
  Vec3<N> u, arm, spin;       // spin: arm x u
  SymmetricMatrix<N> moment;  // of arm

  template <bool Moments>
  BL_HD void add(N w, const Vec3<N>& velocity, const Vec3<N>& at) {
    weight += w;
    u += w * velocity;
    if constexpr (Moments) {
      arm += w * at;
      spin += w * cross(at, velocity);
      moment.add_outer(w, at);
    }
  }
  template <bool Moments>
  BL_HD void merge(const FlowSums& o) {
    weight += o.weight;
    u += o.u;
    if constexpr (Moments) {
      arm += o.arm;
      spin += o.spin;
      moment += o.moment;
    }
  }
  /// a this + b o
  BL_HD FlowSums blend(Real a, const FlowSums& o, Real b) const {
    FlowSums out;
    out.weight = a * weight + b * o.weight;
    out.u = a * u + b * o.u;
    out.arm = a * arm + b * o.arm;
    out.spin = a * spin + b * o.spin;
    out.moment = moment.template as<Real>(a);
    out.moment += o.moment.template as<Real>(b);
    return out;
  }
};

/// The fluid around a grain as a rigid body with weights w_a, on which the couple acts.
struct Carriers {
  Span<Real3> arm;                    ///< mean of r_a - r_j, m
  Span<SymmetricMatrix<Real>> inv_M;  ///< 1/m2, M = sum w (s2 1 - s s) about that mean; zero where undefined

  /// scale: one over the sum of the weights, or 0. Returns the root mean square of |s|, m.
  BL_HD Real set(Index j, const FlowSums<>& flow, Real scale) const {
    arm[j] = scale * flow.arm;
    auto moment = flow.moment.template as<double>(1);
    const double second = moment.trace();
    moment.add_outer(-double(flow.weight), Vec3d(arm[j]));
    // Relative to the moment about the grain, which is never smaller than M: round-off is not taken for
    // spread.
    const auto inverse = moment.inertia().inverse();
    const bool usable = scale > 0 && inverse.norm() * second < 1e6;  // false for NaN
    inv_M[j] = usable ? inverse.template as<Real>(flow.weight) : SymmetricMatrix<Real>{};
    return Real(std::sqrt(max_of(moment.trace() * scale, 0.0)));
  }
  /// Angular velocity of the fluid, rad/s.
  BL_HD Real3 rotation(Index j, const FlowSums<>& flow, Real scale) const {
    return scale * (inv_M[j] * (flow.spin - cross(arm[j], flow.u)));
  }
  /// A of the couple w A x s that, with the force -F, leaves the fluid a moment -T about the grain's centre.
  BL_HD Real3 couple(Index j, const Real3& F, const Real3& T) const {
    return inv_M[j] * (cross(arm[j], F) - T);
  }
};

}  // namespace BL_SOLVER
