#pragma once
// Error of the pressure force on fluid particles in a linear pressure, and its correction.

#include "bedload/core/records.hpp"
#include "kernels/coupling/symmetric_matrix.hpp"

namespace BL_SOLVER {

/// Correction that makes the pressure force exact for linear pressures. For P_b = P + g . (x_b - x_a) pairs
/// sum to
///   sum_b V_b (P_a + P_b) F r_ab = 2 P E - M g,    E = sum_b V_b F r_ab,  M = sum_b V_b F r_ab r_ab,
/// instead of -g. On disordered particles E != 0 and M != 1; on a lattice this error resists shear by a
/// stress of 2e-3 to 1e-2 P. P and g are fitted to the fluid around by moving least squares with weights V F,
/// and
///   acc += w / rho (M g - g - 2 P E).
/// The fit is smooth, so noise and sound are left to the pairs. Momentum is violated by w times the error.
/// Weight w: 1 where viscosity dominates, the cell Reynolds number (P / rho)^(1/2) dx / nu being below 100, 0
/// above 316, where pairs conserve momentum and energy. Within a kernel's reach of a free surface, where the
/// correction could add energy, the bounds are 3 and 10, and w decreases to 0 as the least eigenvalue of M,
/// or one minus the largest exposure within h, goes from 0.8 to 0.6.
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

}  // namespace BL_SOLVER
