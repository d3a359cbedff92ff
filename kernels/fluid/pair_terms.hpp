#pragma once
// Accelerations that one SPH particle b gives particle a, per term. All densities are
// superficial; r = r_a - r_b, v = v_a - v_b; every term is antisymmetric after times m_a.

#include "bedload/core/types.hpp"

namespace bedload::inline BL_VARIANT {

/// Pressure of locally averaged WCSPH [H (9)], [R (8)]. pa, pb: P / rho~^2; F: kernel factor.
BL_HD Real pressure_term(Real m_b, Real pa, Real pb, Real F) { return m_b * (pa + pb) * F; }

/// Morris et al. 1997 [H (10)]: times -v gives the acceleration; mu_sum = mu_a + mu_b [Pa s].
BL_HD Real morris_term(Real m_b, Real mu_sum, Real rho_a, Real rho_b, Real r2, Real F, Real h2) {
  return m_b * mu_sum * r2 * F / (rho_a * rho_b * (r2 + Real(0.01) * h2));
}

/// Artificial viscosity (Monaghan 1992): times r gives the acceleration; zero for receding pairs.
struct ArtificialViscosity {
  Real alpha = 0, beta = 0, c = 0, h = 0;
  BL_HD Real term(Real m_b, Real v_dot_r, Real rho_mean, Real r2, Real F) const {
    if (v_dot_r >= 0) return 0;
    const Real mu = h * v_dot_r / (r2 + Real(0.01) * h * h);
    return m_b * (-alpha * c * mu + beta * mu * mu) / rho_mean * F;
  }
};

/// Tensile term (Monaghan 2000, [H (11)] with the sign split): R_ab.
struct TensileTerm {
  Real s_positive = 0, s_negative = 0, W_dx = 1;
  BL_HD Real R(Real W, Real pa, Real pb) const {
    const Real f = square(square(W / W_dx));
    return f * ((pa > 0 ? s_positive : -s_negative) * pa + (pb > 0 ? s_positive : -s_negative) * pb);
  }
};

}  // namespace bedload::inline BL_VARIANT
