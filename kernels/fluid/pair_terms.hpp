#pragma once
// Accelerations that one SPH particle b gives particle a, per term; r = r_a - r_b, v = v_a - v_b; every term
// is antisymmetric after times M_a. Among grains these are terms of the mixture: M = m / eps, v its volume
// flux.

#include "bedload/case/choices.hpp"
#include "bedload/core/pack.hpp"

namespace bedload::inline BL_VARIANT {

/// Pressure [H (9)], [R (8)]. pa, pb: P / rho^2; F: kernel factor.
template <class N>
BL_HD N pressure_term(N m_b, N pa, N pb, N F) {
  return m_b * (pa + pb) * F;
}

/// Physical viscosity, as the acceleration that b gives a:
///   Morris et al. 1997 [H (10)]   -M_b 2 mu / (rho_a rho_b) F v, the Laplacian of the velocity;
///   Monaghan 2005                 -M_b 2 (d + 2) mu / (rho_a rho_b) F (v . r / r^2) r, the divergence of the
///                                 whole stress, in d dimensions.
/// [H] divides by r^2 + 0.01 h^2 instead of r^2, which would take 1 to 2 % of the viscosity at any
/// resolution.
struct Viscosity {
  Real mu = 0;       ///< Pa s
  Real central = 0;  ///< d + 2 for Monaghan's form, 0 for Morris'
  Real guard = 0;    ///< m2, far below the square of any distance

  /// mu: Pa s; h: smoothing length, m.
  static Viscosity of(ViscosityModel model, double mu, double h, int dimensions) {
    const Real guard = Real(1e-4 * h * h);
    switch (model) {
      case ViscosityModel::morris:
        return {Real(mu), 0, guard};
      case ViscosityModel::monaghan:
        return {Real(mu), Real(dimensions + 2), guard};
      case ViscosityModel::none:
        break;
    }
    return {0, 0, guard};
  }
  BL_HD bool acts() const { return mu > 0; }
  template <class N>
  BL_HD Vec3<N> operator()(N m_b, N rho_a, N rho_b, const Vec3<N>& v, const Vec3<N>& r, N r2, N F) const {
    const N k = quotient(-m_b * (2 * mu) * F, rho_a * rho_b);
    if (central > 0) return quotient(k * central * dot(v, r), r2 + guard) * r;
    return k * v;
  }
};

/// Artificial viscosity (Monaghan 1992): times r gives the acceleration; zero for receding pairs.
struct ArtificialViscosity {
  Real alpha = 0, beta = 0, c = 0, h = 0;
  BL_HD bool acts() const { return alpha > 0 || beta > 0; }
  template <class N>
  BL_HD N term(N m_b, N v_dot_r, N rho_mean, N r2, N F) const {
    const N mu = quotient(h * v_dot_r, r2 + Real(0.01) * h * h);
    return select(v_dot_r < N(0), quotient(m_b * F * (beta * mu * mu - alpha * c * mu), rho_mean), N(0));
  }
};

/// Tensile term (Monaghan 2000, [H (11)] with the sign split): R_ab.
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

}  // namespace bedload::inline BL_VARIANT
