#pragma once
#include "bedload/core/frame.hpp"
#include "bedload/core/span.hpp"
#include "kernels/boundaries/orifice.hpp"

namespace BL_SOLVER {

/// Weight with which grains near a point count in its porosity. At an orifice it is 0, since the inflow has
/// the density of fluid without grains; it rises to 1 over `reach`, a distance in which fluid can be
/// displaced.
struct OrificeWeight {
  Frame frame;
  Span<const Orifice> orifices;
  double near, reach;  ///< free up to here, m; from there on, m

  BL_HD Real operator()(const Vec3d& x) const {
    Real weight = 1;
    for (Index k = 0; k < orifices.size; ++k) {
      const Orifice& o = orifices[k];
      const double t = clamp((o.distance(frame.separation(x, o.centre)) - near) / reach, 0.0, 1.0);
      weight *= Real(t * t * (3 - 2 * t));
    }
    return weight;
  }
};

}  // namespace BL_SOLVER
