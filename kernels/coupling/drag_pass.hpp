#pragma once
#include "kernels/coupling/interpolation_pass.hpp"

namespace bedload::inline BL_VARIANT {

/// Torque of a viscous fluid on a spinning sphere per relative spin, N m s: Kirchhoff's law, then
/// the fit of Dennis et al. (1980) above a rotational Reynolds number of 32 [dennis80].
BL_HD Real spin_drag(Real d, Real rho, Real mu, Real spin) {
  const Real Re = rho * d * d * spin / mu;
  if (Re < 32) return kPi * mu * cube(d);
  const Real r = Real(0.5) * d;
  return Real(0.5) * rho * square(square(r)) * r * (Real(12.9) / std::sqrt(Re) + Real(128.4) / Re) * spin;
}

/// Drag and spin drag coefficients of each grain, times its wetness.
template <class Law>
struct DragPass {
  Law law;
  Real mu;      ///< Pa s
  bool torque;  ///< whether the fluid turns grains
  Span<const Real> radius, eps, wetness;
  Span<const Real3> v, U, omega, omega_f;
  GrainSurroundings surroundings;
  Span<Real> K, K_rot;

  BL_HD void operator()(Index j) const {
    const Real wet = wetness[j];
    K[j] = 0;
    K_rot[j] = 0;
    if (!(wet > 0)) return;
    const Real d = 2 * radius[j], rho = surroundings.rho[j];
    K[j] = wet * law.K(eps[j], d, rho, mu, norm(U[j] - v[j]));
    if (torque && surroundings.inv_M[j].trace() > 0)
      K_rot[j] = wet * spin_drag(d, rho, mu, norm(omega_f[j] - omega[j]));
  }
};

}  // namespace bedload::inline BL_VARIANT
