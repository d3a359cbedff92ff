#pragma once
#include "bedload/core/frame.hpp"
#include "bedload/core/span.hpp"
#include "kernels/boundaries/orifice.hpp"

namespace bedload::inline BL_VARIANT {

/// Weight of the solids around a point that count for its porosity. An orifice is free of grains, and what
/// comes in is as dense as without them: the porosity falls from one there to that of the bed over `reach`,
/// so that fluid has the way to give way.
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

}  // namespace bedload::inline BL_VARIANT
