#pragma once
#include <array>
#include <cmath>

#include "bedload/core/pack.hpp"

namespace BL_SOLVER {

/// Fraction of a smoothing kernel on one side of a plane at distance z from its centre.
struct HalfSpaceFraction {
  static constexpr int points = 65;
  Real range = 0;           ///< support, m
  Real below[points] = {};  ///< fraction below z = range k / (points - 1), 0.5..1

  template <class W>
  static HalfSpaceFraction of(const W& w) {
    HalfSpaceFraction out;
    out.range = Real(w.kappa) * w.h;
    const auto slice = slices(w);
    // over z by the trapezium rule
    double sum[points] = {};
    for (int k = 1; k < points; ++k) sum[k] = sum[k - 1] + 0.5 * (slice[k - 1] + slice[k]);
    for (int k = 0; k < points; ++k) out.below[k] = Real(0.5 + 0.5 * sum[k] / sum[points - 1]);
    return out;
  }
  /// The kernel integrated over the planes at those z, or, of a plane flow, over the lines, by the midpoint
  /// rule, 1/m.
  template <class W>
  static std::array<double, points> slices(const W& w) {
    constexpr int rings = 256;
    const double R = double(w.kappa) * double(w.h), slab = double(w.thickness);
    std::array<double, points> slice{};
    for (int k = 0; k < points; ++k)
      for (int i = 0; i < rings; ++i) {
        const double r = R * (i + 0.5) / rings;
        const double round = slab > 0 ? 2 * slab : 2 * kPi * r;
        slice[k] += round * double(w.W(Real(std::hypot(r, R * k / (points - 1))))) * R / rings;
      }
    return slice;
  }

  BL_HD Real operator()(double z) const { return within(z, range); }
  /// The same for a kernel with another support, m.
  BL_HD Real within(double z, Real range) const {
    const Real at = min_of(Real(std::abs(z)) / range, Real(1)) * (points - 1);
    const int k = int(min_of(at, Real(points - 2)));
    const Real fraction = below[k] + (at - k) * (below[k + 1] - below[k]);
    return z < 0 ? 1 - fraction : fraction;
  }
};

/// What a plane surface takes from the sum of V W over fluid that fills one side of it, by the length of the
/// sum of V grad W: both go with the distance to the surface. Exact for planes; where two of them meet, too
/// little.
struct CutFraction {
  static constexpr int points = 17;
  Real inv_steepest = 0;  ///< 1 / length of the gradient's sum on the surface itself, m
  Real cut[points] = {};  ///< by sqrt(1 - length / steepest), in steps of 1 / (points - 1): 0.5..0

  template <class W>
  static CutFraction of(const W& w) {
    const HalfSpaceFraction side = HalfSpaceFraction::of(w);
    const auto slice = HalfSpaceFraction::slices(w);  // the length for a surface at that distance
    const auto root = [&](int k) { return std::sqrt(1 - slice[k] / slice[0]); };
    CutFraction out;
    out.inv_steepest = Real(1 / slice[0]);
    for (int i = 0, k = 0; i < points; ++i) {
      const double at = double(i) / (points - 1);
      while (k + 2 < HalfSpaceFraction::points && root(k + 1) < at) ++k;
      const double fraction = (at - root(k)) / (root(k + 1) - root(k));
      out.cut[i] = Real(1 - double(side.below[k]) - fraction * double(side.below[k + 1] - side.below[k]));
    }
    return out;
  }

  BL_HD Real operator()(Real gradient) const {
    const Real at = root(max_of(Real(0), 1 - gradient * inv_steepest)) * (points - 1);
    const int k = int(min_of(at, Real(points - 2)));
    return cut[k] + (at - k) * (cut[k + 1] - cut[k]);
  }
};

}  // namespace BL_SOLVER
