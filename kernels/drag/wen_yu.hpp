#pragma once
#include "kernels/drag/sphere_drag.hpp"

namespace BL_SOLVER {

/// Dilute suspensions: a single sphere times a power of the porosity [wen66].
struct WenYu {
  static constexpr DragLaw law = DragLaw::wen_yu;
  BL_HD Real K(Real eps, Real d, Real rho, Real mu, Real w) const {
    return stokes_drag(d, mu) * sphere_drag_factor(grain_reynolds(eps, d, rho, mu, w)) *
           std::pow(eps, Real(-2.65));
  }
};

}  // namespace BL_SOLVER
