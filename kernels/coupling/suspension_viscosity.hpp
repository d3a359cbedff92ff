#pragma once
#include <cmath>

#include "bedload/case/choices.hpp"
#include "bedload/core/span.hpp"

namespace BL_SOLVER {

/// Viscosity of a suspension over that of its fluid, by the volume fraction phi of grains:
/// (1 - phi/phi_max)^-n, n being 2.5 phi_max [krieger59] or 2 [maron56].
struct SuspensionViscosity {
  /// Limit on phi / phi_max: in a denser bed contacts carry the load.
  static constexpr Real kDensest = Real(0.95);
  Real phi_max, n;

  static SuspensionViscosity of(SuspensionLaw law, double phi_max) {
    return {Real(phi_max), Real(law == SuspensionLaw::krieger_dougherty ? 2.5 * phi_max : 2)};
  }
  BL_HD Real operator()(Real phi) const { return std::pow(1 - clamp(phi / phi_max, Real(0), kDensest), -n); }
};

/// Of each fluid particle by the porosity around it.
struct ThickenPass {
  SuspensionViscosity law;
  Span<const Real> eps;
  Span<Real> relative_viscosity;
  BL_HD void operator()(Index a) const { relative_viscosity[a] = law(1 - eps[a]); }
};

}  // namespace BL_SOLVER
