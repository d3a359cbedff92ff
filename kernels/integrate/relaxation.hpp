#pragma once
// Drag on a grain over a time in which the fluid velocity and the drag coefficient are constant.

#include <cmath>

#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// Relaxation towards the fluid in a time h at the rate k (1/s).
struct Relaxation {
  double fraction = 0;  ///< by which the slip decays: 1 - exp(-k h)
  double lag = 0;       ///< effect of drag on the kick a h: psi(k h) - 1, psi(x) = (1 - exp(-x))/x
  Relaxation() = default;
  BL_HD Relaxation(double rate, double h, bool exponential) {
    const double x = rate * h;
    if (!(x > 0)) return;
    if (!exponential) {
      fraction = x;
    } else if (x < 1e-4) {
      fraction = -std::expm1(-x);
      lag = -x / 2 * (1 - x / 3);
    } else {
      fraction = -std::expm1(-x);
      lag = fraction / x - 1;
    }
  }
  /// Change of v by drag in time h, with the acceleration a by all other forces.
  BL_HD Vec3d drag(const Vec3d& v, const Vec3d& fluid, const Vec3d& a, double h) const {
    return fraction * (fluid - v) + (lag * h) * a;
  }
};

/// Of a grain's velocity and spin in half a substep.
struct alignas(32) GrainRelaxation {
  Relaxation slide, spin;
};

}  // namespace BL_SOLVER
