#pragma once
#include "kernels/drag/ergun.hpp"
#include "kernels/drag/wen_yu.hpp"

namespace BL_SOLVER {

/// Ergun where dense, Wen-Yu where dilute; jumps at porosity 0.8 [gidaspow94].
struct Gidaspow {
  static constexpr DragLaw law = DragLaw::gidaspow;
  BL_HD Real K(Real eps, Real d, Real rho, Real mu, Real w) const {
    return eps <= Real(0.8) ? Ergun{}.K(eps, d, rho, mu, w) : WenYu{}.K(eps, d, rho, mu, w);
  }
};

}  // namespace BL_SOLVER
