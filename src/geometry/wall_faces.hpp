#pragma once
// Where boxes and tanks have sides.

#include <array>

#include "bedload/case/config.hpp"

namespace bedload {

/// By how much, for rounding, what ends at the sides of a period may fall short of it or go beyond, m.
inline double period_slack(const DomainConfig& domain, int k) {
  return 1e-6 * (domain.max[k] - domain.min[k]);
}

/// Whether the body runs through the whole period of axis k, so that it has no end there.
inline bool spans_period(const WallBody& body, const DomainConfig& domain, int k) {
  const double slack = period_slack(domain, k);
  return domain.periodic[k] && body.min[k] <= domain.min[k] + slack && body.max[k] >= domain.max[k] - slack;
}

/// Closed faces of a tank, x- x+ y- y+ z- z+; a period has none.
inline std::array<bool, 6> closed_faces(const WallBody& tank, const DomainConfig& domain) {
  std::array<bool, 6> closed = tank.faces;
  for (int k = 0; k < 3; ++k)
    if (spans_period(tank, domain, k)) closed[2 * k] = closed[2 * k + 1] = false;
  return closed;
}

}  // namespace bedload
