#pragma once
#include "bedload/core/frame.hpp"
#include "bedload/core/span.hpp"

namespace bedload::inline BL_VARIANT {

/// Disc or rectangle that fluid comes in through.
struct Orifice {
  Vec3d centre, direction;  ///< m; unit, into the flow
  Vec3d axis[2];            ///< rectangle: unit, along its sides
  double half[2];           ///< half sides, or the radius and 0, m
  bool disc;

  /// Of r, from its centre, m.
  BL_HD double distance(const Vec3d& r) const {
    const double along = dot(r, direction);
    if (disc) return std::hypot(along, max_of(norm(r - along * direction) - half[0], 0.0));
    const double a = max_of(std::abs(dot(r, axis[0])) - half[0], 0.0);
    const double b = max_of(std::abs(dot(r, axis[1])) - half[1], 0.0);
    return std::sqrt(along * along + a * a + b * b);
  }
};

/// Share of the solids around a point that count for its porosity. An orifice is free of grains, and what
/// comes in is as dense as without them: the porosity falls from one there to that of the bed over `reach`,
/// so that fluid has the way to make room.
struct OrificeShare {
  Frame frame;
  Span<const Orifice> orifices;
  double near, reach;  ///< free up to here, m; from there on, m

  BL_HD Real operator()(const Vec3d& x) const {
    Real share = 1;
    for (Index k = 0; k < orifices.size; ++k) {
      const Orifice& o = orifices[k];
      const double t = clamp((o.distance(frame.separation(x, o.centre)) - near) / reach, 0.0, 1.0);
      share *= Real(t * t * (3 - 2 * t));
    }
    return share;
  }
};

}  // namespace bedload::inline BL_VARIANT
