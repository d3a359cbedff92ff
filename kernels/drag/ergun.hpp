#pragma once
#include "kernels/drag/sphere_drag.hpp"

namespace BL_SOLVER {

/// Packed beds [ergun52].
struct Ergun {
  static constexpr DragLaw law = DragLaw::ergun;
  BL_HD Real K(Real eps, Real d, Real rho, Real mu, Real w) const {
    const Real volume = kPi / 6 * cube(d);
    return volume * (150 * mu * (1 - eps) / (eps * d * d) + Real(1.75) * rho * w / d);
  }
};

}  // namespace BL_SOLVER
