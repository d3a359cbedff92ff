#pragma once
#include "kernels/drag/ergun.hpp"
#include "kernels/drag/wen_yu.hpp"

namespace BL_SOLVER {

/// As gidaspow, with a smooth transition around porosity 0.8 [huilin03].
struct GidaspowBlend {
  static constexpr DragLaw law = DragLaw::gidaspow_blend;
  BL_HD Real K(Real eps, Real d, Real rho, Real mu, Real w) const {
    const Real psi = Real(0.5) + std::atan(Real(262.5) * (eps - Real(0.8))) / kPi;
    return psi * WenYu{}.K(eps, d, rho, mu, w) + (1 - psi) * Ergun{}.K(eps, d, rho, mu, w);
  }
};

}  // namespace BL_SOLVER
