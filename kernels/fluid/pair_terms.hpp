#pragma once
// Accelerations that one SPH particle b gives particle a, per term; r = r_a - r_b, v = v_a - v_b; every term
// is antisymmetric after times M_a. Among grains these are terms of the mixture: M = m / eps, v its volume
// flux.

#include "bedload/core/pack.hpp"

namespace bedload::inline BL_VARIANT {

/// Pressure [H (9)], [R (8)]. pa, pb: P / rho^2; F: kernel factor.
template <class N>
BL_HD N pressure_term(N m_b, N pa, N pb, N F) {
  return m_b * (pa + pb) * F;
}

/// Morris et al. 1997 [H (10)]: times -v gives the acceleration; mu_sum = mu_a + mu_b [Pa s].
template <class N>
BL_HD N morris_term(N m_b, Real mu_sum, N rho_a, N rho_b, N r2, N F, Real h2) {
  return m_b * mu_sum * r2 * F / (rho_a * rho_b * (r2 + Real(0.01) * h2));
}

/// Artificial viscosity (Monaghan 1992): times r gives the acceleration; zero for receding pairs.
struct ArtificialViscosity {
  Real alpha = 0, beta = 0, c = 0, h = 0;
  BL_HD bool acts() const { return alpha > 0 || beta > 0; }
  template <class N>
  BL_HD N term(N m_b, N v_dot_r, N rho_mean, N r2, N F) const {
    const N mu = h * v_dot_r / (r2 + Real(0.01) * h * h);
    return select(v_dot_r < N(0), m_b * (beta * mu * mu - alpha * c * mu) / rho_mean * F, N(0));
  }
};

/// Tensile term (Monaghan 2000, [H (11)] with the sign split): R_ab.
struct TensileTerm {
  Real s_positive = 0, s_negative = 0, W_dx = 1;
  template <class N>
  BL_HD N R(N W, N pa, N pb) const {
    const N f = square(square(W / W_dx));
    return f * (share(pa) * pa + share(pb) * pb);
  }

 private:
  template <class N>
  BL_HD N share(N p) const {
    return select(p > N(0), N(s_positive), N(-s_negative));
  }
};

}  // namespace bedload::inline BL_VARIANT
