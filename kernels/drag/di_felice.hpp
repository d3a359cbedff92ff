#pragma once
#include "kernels/drag/sphere_drag.hpp"

namespace BL_SOLVER {

/// One continuous form from packed to dilute [difelice94].
struct DiFelice {
  static constexpr DragLaw law = DragLaw::di_felice;
  BL_HD Real K(Real eps, Real d, Real rho, Real mu, Real w) const {
    const Real Re = grain_reynolds(eps, d, rho, mu, w);
    const Real away = Real(1.5) - std::log10(max_of(Re, Real(1e-30)));  // finite at rest
    const Real chi = Real(3.7) - Real(0.65) * std::exp(Real(-0.5) * away * away);
    return kPi / 8 * mu * d * square(Real(0.63) * std::sqrt(Re) + Real(4.8)) * std::pow(eps, 1 - chi);
  }
};

}  // namespace BL_SOLVER
