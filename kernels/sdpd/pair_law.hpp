#pragma once
#include "kernels/sdpd/noise.hpp"

namespace BL_SOLVER {

/// Friction coefficients of a pair over g = V_a V_b F, Pa s: of the slip across the line of centres and of
/// the velocity along it.
struct FrictionCoefficients {
  double across = 0, along = 0;
  FrictionCoefficients over(double sum) const { return {across / sum, along / sum}; }
};

/// Friction and noise between two volumes of fluid [espanol03], [mueller15], with any masses: the force that
/// b puts on a is
///   F = -c1 P u - c2 e (e . u) + sqrt(2 kT / dt) (sqrt(c1) P x + sqrt(c2) e (e . x)),
///   u = v_a - v_b + r x (w_a + w_b) / 2,   e = r / |r|,   P = 1 - e e,   c1, c2 = g `across`, g `along`,
/// with three normal deviates x of the pair. u is the slip at the middle, none in rigid rotation; without
/// spin w = 0. Covariance of the noise and friction match, so that m v^2 and I w^2 are kT on average for any
/// masses. `tensor` [tsuzuki]: the same covariance from the nine deviates of a matrix D,
///   2 sqrt(kT / dt) (sqrt(c1) S e + sqrt(c3) tr(D) e / 3),   c3 = 3/2 c2 - 2 c1,
/// S being its symmetric part without trace.
struct PairLaw {
  Real across = 0, along = 0;      ///< Pa s
  Real sliding = 1, spinning = 1;  ///< factors on the two parts of u
  Real thermal = 0;                ///< 2 kT / dt, J/s, times the square of the factor on noise; 0: no noise
  bool tensor = false;
  NoiseKey key;
  Real guard = 0;  ///< m2, far below the square of any distance

  /// Without noise, N. turn: r x (w_a + w_b) / 2.
  template <class N>
  BL_HD Vec3<N> friction(N g, const Vec3<N>& v, const Vec3<N>& turn, const Vec3<N>& r, N r2) const {
    const N along_r = quotient(sliding * dot(v, r), r2 + guard);
    const Vec3<N> u = sliding * v + spinning * turn;
    return -(g * across) * (u - along_r * r) - g * along * along_r * r;
  }
  /// N; a, b: labels of the two.
  template <class N>
  BL_HD Vec3<N> noise(N g, const RowId<N>& a, N b, const Vec3<N>& r, N r2) const {
    if (tensor) {
      const Symmetric<N> D = even_normals(key, a, b);
      const N inverse = quotient(N(1), root(r2 + guard)), third = (D.xx + D.yy + D.zz) * Real(1.0 / 3);
      const Vec3<N> e = inverse * r;
      const Vec3<N> De{D.xx * e.x + D.xy * e.y + D.zx * e.z, D.xy * e.x + D.yy * e.y + D.yz * e.z,
                       D.zx * e.x + D.yz * e.y + D.zz * e.z};
      const Real traced = max_of(Real(1.5) * along - 2 * across, Real(0));
      return root(2 * thermal * across * g) * (De - third * e) + (root(2 * thermal * traced * g) * third) * e;
    }
    const Vec3<N> x = odd_normals(key, a, b);
    const N along_r = quotient(dot(x, r), r2 + guard);
    return root(thermal * across * g) * (x - along_r * r) + (root(thermal * along * g) * along_r) * r;
  }
};

}  // namespace BL_SOLVER
