#pragma once
#include "bedload/core/span.hpp"
#include "kernels/drag/sphere_drag.hpp"

namespace BL_SOLVER {

/// A law from a table of K / (3 pi mu d). ln of it is linear between porosities, and between Reynolds numbers
/// over ln(1 + Re): constant in creeping flow, a power of Re far from it. Beyond the first and last porosity
/// the table is constant; beyond the last Reynolds number the last power is extrapolated.
struct Tabulated {
  static constexpr DragLaw law = DragLaw::table;
  Span<const Real> porosity, log_re,
      log_factor;  ///< rising; ln(1 + Re), rising from 0; a row for each porosity

  BL_HD Real K(Real eps, Real d, Real rho, Real mu, Real w) const {
    const Place row = place(porosity, eps),
                column = place(log_re, std::log(1 + grain_reynolds(eps, d, rho, mu, w)));
    const Real weight = clamp(row.fraction, Real(0), Real(1));
    const Real log_F = (1 - weight) * along(row.before, column) + weight * along(row.after, column);
    return stokes_drag(d, mu) * std::exp(log_F);
  }

 private:
  struct Place {
    Index before, after;
    Real fraction;
  };
  BL_HD static Place place(const Span<const Real>& nodes, Real x) {
    if (nodes.size < 2) return {0, 0, 0};
    Index k = 0;
    while (k + 2 < nodes.size && nodes[k + 1] <= x) ++k;
    return {k, k + 1, (x - nodes[k]) / (nodes[k + 1] - nodes[k])};
  }
  BL_HD Real along(Index row, const Place& column) const {
    const Index first = row * log_re.size;
    return log_factor[first + column.before] +
           column.fraction * (log_factor[first + column.after] - log_factor[first + column.before]);
  }
};

}  // namespace BL_SOLVER
