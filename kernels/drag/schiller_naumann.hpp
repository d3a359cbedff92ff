#pragma once
#include "kernels/drag/sphere_drag.hpp"

namespace BL_SOLVER {

/// A single sphere at any Reynolds number [schiller33].
struct SchillerNaumann {
  static constexpr DragLaw law = DragLaw::schiller_naumann;
  BL_HD Real K(Real eps, Real d, Real rho, Real mu, Real w) const {
    return stokes_drag(d, mu) * sphere_drag_factor(grain_reynolds(eps, d, rho, mu, w));
  }
};

}  // namespace BL_SOLVER
