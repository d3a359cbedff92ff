#pragma once
// Accelerations that one SPH particle b gives particle a, per term; r = r_a - r_b, v = v_a - v_b; every term
// is antisymmetric after times M_a. Among grains these are terms of the mixture: M = m / eps, v its volume
// flux.

#include "bedload/case/choices.hpp"
#include "bedload/core/pack.hpp"
#include "kernels/smoothing/lengths.hpp"

namespace BL_SOLVER {

/// Pressure [he18] Eq. 9, [robinson14] Eq. 8. pa, pb: P / rho^2, divided by Omega where smoothing lengths
/// vary; F: kernel factor.
template <class N>
BL_HD N pressure_term(N m_b, N pa, N pb, N F) {
  return m_b * F * (pa + pb);
}
template <class N>
BL_HD N pressure_term(N m_b, N pa, N pb, const PairFactors<N>& F) {
  return m_b * (pa * F.a + pb * F.b);
}

/// Physical viscosity, as the acceleration that b gives a:
///   [morris97], [he18] Eq. 10     -M_b 2 mu / (rho_a rho_b) F v, the Laplacian of the velocity;
///   [monaghan05]                  -M_b 2 (d + 2) mu / (rho_a rho_b) F (v . r / r^2) r, the divergence of the
///                                 whole stress, in d dimensions;
///   [robinson14] Eq. 9, signal    -M_b alpha (c + |u|) u / rho F r, u = v . r / |r|, the same with the mean
///                                 distance of the kernel for |r|, alpha c = 2 (d + 2) mu / rho0 times the
///                                 integrals of F r^2 over F r^3, whether particles approach or recede.
/// [he18] divides by r^2 + 0.01 h^2 instead of r^2, which underestimates the viscosity by 1 to 2 % at any
/// resolution.
struct Viscosity {
  Real mu = 0;       ///< Pa s
  Real central = 0;  ///< d + 2 for forms along the line of centres, 0 for Morris'
  Real guard = 0;    ///< m2, far below the square of any distance
  Real signal = 0;   ///< alpha c of that form, m/s; else 0
  Real alpha = 0;

  /// mu: Pa s; rho0: kg/m3; c: speed of sound, m/s.
  template <class W>
  static Viscosity of(ViscosityModel model, double mu, double rho0, double c, const W& w) {
    const Real guard = Real(1e-4 * double(w.h) * double(w.h));
    const int d = w.thickness > 0 ? 2 : 3;
    switch (model) {
      case ViscosityModel::morris:
        return {Real(mu), 0, guard};
      case ViscosityModel::monaghan:
        return {Real(mu), Real(d + 2), guard};
      case ViscosityModel::signal: {
        const double speed = 2 * (d + 2) * mu / rho0 / mean_distance(w);
        return {Real(mu), Real(d + 2), guard, Real(speed), Real(speed / c)};
      }
      case ViscosityModel::none:
        break;
    }
    return {0, 0, guard};
  }
  BL_HD bool acts() const { return mu > 0; }
  template <class N, class Factor>
  BL_HD Vec3<N> operator()(N m_b, N rho_a, N rho_b, const Vec3<N>& v, const Vec3<N>& r, N r2,
                           const Factor& factor) const {
    const N weight = m_b * mean_factor(factor);
    if (central > 0) return along_centres(weight, rho_a, rho_b, v, r, r2, N(pair_length(factor)));
    return shear(weight, rho_a, rho_b) * v;
  }

 private:
  template <class N>
  BL_HD N shear(N weight, N rho_a, N rho_b) const {
    return quotient(-weight * (2 * mu), rho_a * rho_b);
  }
  template <class N>
  BL_HD Vec3<N> along_centres(N weight, N rho_a, N rho_b, const Vec3<N>& v, const Vec3<N>& r, N r2,
                              N length) const {
    if (!(signal > 0)) return quotient(shear(weight, rho_a, rho_b) * central * dot(v, r), r2 + guard) * r;
    const N u = quotient(dot(v, r), root(r2 + guard));
    const N speed = quotient(signal + alpha * max_of(u, -u), length);
    return quotient(-weight * speed * u, Real(0.5) * (rho_a + rho_b)) * r;
  }
  /// Integral of F r^3 over that of F r^2, m.
  template <class W>
  static double mean_distance(const W& w) {
    constexpr int shells = 4000;
    const double step = double(w.kappa) * double(w.h) / shells;
    double second = 0, third = 0;
    for (int k = 0; k < shells; ++k) {
      const double r = (k + 0.5) * step, round = w.thickness > 0 ? r : r * r;
      second += round * r * r * double(w.F(Real(r)));
      third += round * r * r * r * double(w.F(Real(r)));
    }
    return third / second;
  }
};

/// Artificial viscosity [monaghan92]; zero for receding pairs. term() times r_ab is the acceleration.
struct ArtificialViscosity {
  Real alpha = 0, beta = 0, c = 0, h = 0;
  BL_HD bool acts() const { return alpha > 0 || beta > 0; }
  template <class N, class Factor>
  BL_HD N term(N m_b, N v_dot_r, N rho_mean, N r2, const Factor& factor) const {
    const auto length = h * pair_length(factor);
    const N mu = quotient(length * v_dot_r, r2 + Real(0.01) * length * length);
    const N weight = m_b * mean_factor(factor);
    return select(v_dot_r < N(0), quotient(weight * (mu * (beta * mu - alpha * c)), rho_mean), N(0));
  }
};

/// Tensile correction R_ab [monaghan00], [he18] Eq. 11, with a factor each for pressure and tension.
struct TensileTerm {
  Real s_positive = 0, s_negative = 0, W_dx = 1;
  template <class N>
  BL_HD N R(N W, N pa, N pb) const {
    const N f = square(square(W / W_dx));
    return f * (weight(pa) * pa + weight(pb) * pb);
  }

 private:
  template <class N>
  BL_HD N weight(N p) const {
    return select(p > N(0), N(s_positive), N(-s_negative));
  }
};

}  // namespace BL_SOLVER
