#pragma once
#include "bedload/case/config/fluid.hpp"
#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// Tait's equation P = B [(rho/rho0)^gamma - 1] + P_ref, rho being the density of the fluid alone
/// [he18] Eqs. 7, 8. eos.type = "democritus", p0 (rho/rho0)^alpha - beta [tsuzuki] Eq. 17, is the same with
/// B = p0, gamma = alpha, P_ref = p0 - beta. In terms of x = rho/rho0 - 1, which keeps its digits in fp32.
struct EquationOfState {
  Real B = 1, gamma = 7, P_ref = 0, rho0 = 1000;
  bool clip_negative = false;
  Real least = -1;  ///< x at which the fluid cavitates: pressure and density are constant below

  /// Of a fluid that cavitates where it is thinner than rho0 by the fraction `cavitation_limit`.
  static EquationOfState of(const EosConfig& e, const FluidProperties& fluid, double cavitation_limit) {
    const double c = fluid.c, rho0 = fluid.rho0, least = -cavitation_limit;
    const auto law = [&](double B, double gamma, double P_ref) -> EquationOfState {
      return {.B = Real(B),
              .gamma = Real(gamma),
              .P_ref = Real(P_ref),
              .rho0 = Real(rho0),
              .clip_negative = e.clip_negative,
              .least = Real(least)};
    };
    switch (e.type) {
      case EosType::tait:
        return law(c * c * rho0 / e.gamma, e.gamma, e.background);
      case EosType::democritus:
        return law(e.p0, e.alpha, e.p0 - e.beta);
    }
    return {};
  }

  BL_HD Real density(Real x) const { return rho0 * (1 + max_of(x, least)); }  ///< kg/m3
  /// Pressure [Pa].
  BL_HD Real pressure(Real x) const {
    x = max_of(x, least);
    const Real p = B * std::expm1(gamma * std::log1p(x)) + P_ref;
    return clip_negative ? max_of(p, Real(0)) : p;
  }
  /// rho/rho0 - 1 at pressure p [Pa]; p is kept above -0.9 B.
  BL_HD Real compression(Real p) const {
    return std::expm1(std::log1p(max_of((p - P_ref) / B, Real(-0.9))) / gamma);
  }
  /// Elastic energy per mass against rho0 [J/kg]: integral of P / rho^2.
  BL_HD double energy(double x) const {
    const double cavity = max_of(double(least) - x, 0.0), whole = x + cavity;
    const double g = gamma, l = std::log1p(whole);
    const double work = g > 1 ? std::expm1((g - 1) * l) / (g - 1) : l;
    return (double(B) * (work + std::expm1(-l)) - double(P_ref) * std::expm1(-l) -
            cavity * double(pressure(least)) / square(1 + whole)) /
           rho0;
  }
};

}  // namespace BL_SOLVER
