#pragma once
// What the pressure force of a particle is wrong by, where pressure is linear in space.

#include "bedload/core/records.hpp"
#include "kernels/coupling/symmetric_matrix.hpp"

namespace bedload::inline BL_VARIANT {

/// The sum over pairs of a pressure that is linear around a, P_b = P + g . (x_b - x_a), is
///   sum_b V_b (P_a + P_b) F r_ab = 2 P E - M g,    E = sum_b V_b F r_ab,  M = sum_b V_b F r_ab r_ab,
/// and ought to be -g: where particles are not in order, E and M - 1 are not zero, and a lattice under
/// pressure P resists shear by a stress of 2e-3 to 1e-2 P. Its own error on the linear fit of the pressure
/// around it, by moving least squares with the weights V F, is taken off a particle's acceleration:
///   acc += w / rho (M g - g - 2 P E).
/// Noise and sound stay in the pairs, since the fit is smooth. That gives up w times the sum of the errors of
/// momentum. w is 1 where viscosity rules a particle's scale, the cell Reynolds number (P / rho)^(1/2) dx /
/// nu being below 100, and 0 where it is above 316: there pairs keep momentum and energy as they are. Energy
/// enters at free surfaces: within a kernel's reach of one these numbers are 3 and 10, and w falls to 0 as
/// the least eigenvalue of M does from 0.8 to 0.6, for the particle or any that is exposed within h of it.
struct LinearFit {
  static constexpr bool acts = true;
  Real at_h, volume;  ///< F at the distance h, 1/m5; dx^3, m3
  Real at_zero;       ///< F of a particle with itself, 1/m5
  Real cell;          ///< rho0 dx^2 / mu^2, 1/Pa
  /// log10 of the squares of the cell Reynolds numbers up to which w is 1, and over what it falls
  Real whole_within, whole_at_surface, fading;
  Span<const Real> viscosity;  ///< over mu; empty: 1
  Span<Real4> correction;      ///< m/s2; w

  template <class N>
  struct Sum {
    N pressure;     ///< of a, Pa
    N at_h;         ///< V F at the distance h, 1/m2
    N exposed;      ///< greatest exposure within h (Shifting)
    N unity, p;     ///< sums of V F, V F (P_b - P_a)
    Vec3<N> slope;  ///< sum of V F (P_b - P_a) r_ab
    /// b: V_b F_ab
    BL_HD void add_fluid(const N& b, const N& P, const Vec3<N>& r, const N& exposure) {
      add(b, P, r);
      exposed = max_of(exposed, select(b > at_h, exposure, N(0)));
    }
    BL_HD void add(const N& b, const N& P, const Vec3<N>& r) {
      const N more = b * (P - pressure);
      unity += b;
      p += more;
      slope += more * r;
    }
    BL_HD void merge(const Sum& o) {
      exposed = max_of(exposed, o.exposed);
      unity += o.unity, p += o.p, slope += o.slope;
    }
  };
  /// State of a.
  BL_HD Sum<Real> start(const EosState<>& state) const {
    return {state.pressure(), volume * at_h, 0, state.mass_over_eps / state.rho * at_zero, 0, {}};
  }
  /// rho: of a; E, M: as above; least: the least eigenvalue of M; inside: 0 within a kernel's reach of a free
  /// surface, else 1.
  BL_HD void finish(Index a, const Sum<Real>& sum, Real rho, const Real3& E, const SymmetricMatrix<Real>& M,
                    Real least, Real inside) const {
    correction[a] = {};
    SymmetricMatrix<Real> about = M;  // the centre
    about.add_outer(-1 / sum.unity, E);
    if (!(least > Real(0.6)) || !(about.determinant() > Real(1e-3))) return;
    // x_b - x_a = -r: the mean of it is -E / unity
    const Real3 g = about.inverse() * ((sum.p / sum.unity) * E - sum.slope);
    const Real P = sum.pressure + (sum.p + dot(E, g)) / sum.unity;
    const Real w = weight(a, P, min_of(least, 1 - sum.exposed), inside);
    correction[a] = {w / rho * (M * g - g - (2 * P) * E), w};
  }

 private:
  BL_HD Real weight(Index a, Real P, Real least, Real inside) const {
    const Real mu = viscosity ? viscosity[a] : Real(1);
    const Real cell_re2 = std::abs(P) * cell / square(mu);
    const Real whole = whole_at_surface + inside * (whole_within - whole_at_surface);
    const Real slow = clamp(1 + (whole - std::log10(max_of(cell_re2, Real(1)))) / fading, Real(0), Real(1));
    return smooth(slow) * smooth(clamp(5 * (least - Real(0.6)), Real(0), Real(1)));
  }
  BL_HD static Real smooth(Real t) { return t * t * (3 - 2 * t); }
};

/// Pressure acts by pairs alone.
struct NoFit {
  static constexpr bool acts = false;
  template <class N>
  struct Sum {
    BL_HD void merge(const Sum&) {}
  };
  BL_HD Sum<Real> start(const EosState<>&) const { return {}; }
};

}  // namespace bedload::inline BL_VARIANT
