#pragma once
#include "bedload/case/choices.hpp"
#include "bedload/core/formula_code.hpp"
#include "bedload/particles/fluid.hpp"
#include "kernels/contact/grain_mass.hpp"

namespace BL_SOLVER {

/// A force given in a case, as it is now and where a particle is.
struct DriveField {
  Frame frame;
  Vec3d f;                   ///< N/m3, m/s2 or N
  Span<const Real> factors;  ///< of each particle; empty: f as it is
  int opposed;               ///< axis along which f is reversed in the upper half of the domain; -1: none

  BL_HD Vec3d at(Index i, const Vec3d& x) const {
    const Vec3d force = factors ? double(factors[i]) * f : f;
    return opposed >= 0 && upper(x) ? -force : force;
  }

 private:
  BL_HD bool upper(const Vec3d& x) const {
    return frame.wrap(x)[opposed] - frame.origin[opposed] > 0.5 * frame.length[opposed];
  }
};

/// drive.factor at the places of particles.
template <class Position>
struct DriveFactorPass {
  Frame frame;
  FormulaCode formula;  ///< of x, y, z (m) and t (s)
  double t;
  Span<const Position> x;
  Span<Real> factors;

  BL_HD void operator()(Index i) const {
    factors[i] = Real(formula(frame.wrap(coordinates(frame, x[i])), t));
  }
};

/// What drives the fluid besides gravity, m/s2.
struct Drive {
  DriveField field;
  Span<const FluidPosition> x;
  DriveMode mode;
  bool shared;           ///< grains are driven, too: fluid takes the force on its own volume
  Vec3d spring, centre;  ///< acceleration -spring (x - centre) per axis, 1/s2, m
  bool pulls;

  BL_HD Real3 operator()(Index a, const EosState<>& state) const {
    const Real3 f = Real3(field.at(a, coordinates(field.frame, x[a])));
    Real3 acc;
    switch (mode) {
      case DriveMode::volume:
        acc = f / (shared ? state.rho : state.eps * state.rho);
        break;
      case DriveMode::mass:
        acc = f;
        break;
      case DriveMode::particle:
        acc = f / (state.mass_over_eps * state.eps);
        break;
    }
    if (pulls) acc -= Real3(pull(a));
    return acc;
  }
  /// J/kg
  BL_HD double energy(Index a) const { return 0.5 * dot(pull(a), coordinates(field.frame, x[a]) - centre); }

 private:
  BL_HD Vec3d pull(Index a) const {
    const Vec3d r = coordinates(field.frame, x[a]) - centre;
    return {spring.x * r.x, spring.y * r.y, spring.z * r.z};
  }
};

/// The same on grains, N.
struct GrainDrivePass {
  DriveField field;
  DriveMode mode;
  PerR3 per_r3;  ///< of mass or volume
  Span<const Vec3d> x;
  Span<const Real> radius;
  Span<Real3> force;

  BL_HD void operator()(Index i) const {
    const double R3 = cube(double(radius[i]));
    const double times = mode == DriveMode::volume || mode == DriveMode::mass ? per_r3(i) * R3 : 1;
    force[i] = Real3(times * field.at(i, x[i]));
  }
};

}  // namespace BL_SOLVER
