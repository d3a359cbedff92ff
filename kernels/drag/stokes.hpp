#pragma once
#include "kernels/drag/sphere_drag.hpp"

namespace BL_SOLVER {

/// Creeping flow around a single sphere [stokes51].
struct Stokes {
  static constexpr DragLaw law = DragLaw::stokes;
  BL_HD Real K(Real, Real d, Real, Real mu, Real) const { return stokes_drag(d, mu); }
};

}  // namespace BL_SOLVER
