#pragma once
#include <cmath>

#include "bedload/core/types.hpp"
#include "kernels/smoothing/half_space_fraction.hpp"

namespace BL_SOLVER {

/// Disturbance of the fluid that a single grain reads by that grain itself: the flow caused by its own drag,
/// and its own volume. Drag laws refer to undisturbed flow. Among other grains the disturbance is part of the
/// mean and decays as (1 - phi)^8, 8 being the second virial coefficient of spheres. All zero: not corrected.
struct OwnWake {
  Real mobility = 0;    ///< m/(N s), of the fluid's mean velocity around a grain by its drag, in Stokes flow
  Real h_c = 0;         ///< m
  Real per_volume = 0;  ///< 1/m3, by how much a grain's volume lowers the porosity that it reads

  /// For the kernel that spreads drag and reads the fluid: <1/|r - r'|> / (6 pi mu), the mean of Oseen's
  /// tensor, and the integral of W^2.
  template <class W>
  static OwnWake of(const W& w, double h_c, double mu, bool flow) {
    constexpr int shells = 2000;
    const double dr = double(w.kappa) * double(w.h) / shells;
    double within = 0, inverse = 0, squares = 0;  // fraction within r; <1/|r - r'|>, 1/m; 1/m3
    for (int k = 0; k < shells; ++k) {
      const double r = (k + 0.5) * dr, W_r = double(w.W(Real(r)));
      const double round = double(w.thickness) > 0 ? 2 * kPi * r * double(w.thickness) : 4 * kPi * r * r;
      const double shell = round * dr * W_r;
      // the mean of 1/distance between two shells is one over the radius of the outer one
      inverse += shell * (2 * within + shell) / r;
      within += shell;
      squares += shell * W_r;
    }
    return {flow ? Real(inverse / (6 * kPi * mu)) : Real(0), Real(h_c), Real(squares)};
  }
  BL_HD static Real alone(Real eps) { return square(square(square(eps))); }
  /// That of a grain with its own averaging length, `shrink` being that of the kernel over it.
  BL_HD OwnWake with(Real shrink) const {
    return {mobility * shrink, h_c / shrink, per_volume * cube(shrink)};
  }
  /// Porosity without the grain's own volume (m3).
  BL_HD Real porosity(Real eps, Real volume) const {
    return min_of(eps + per_volume * volume * alone(eps), Real(1));
  }
  /// Fraction of the undisturbed slip w (m/s) that is missing in the slip read by a grain with drag K (kg/s).
  /// Inertia: a fit, within 0.2 %, to Oseen's flow averaged with Wendland's kernel.
  BL_HD Real fraction(Real K, Real w, Real eps, Real rho, Real mu) const {
    const Real inertia = 1 + Real(0.36) * std::pow(rho * w * h_c / mu, Real(1.03));
    return min_of(K * mobility * alone(eps) / inertia, Real(0.5));
  }
};

}  // namespace BL_SOLVER
