#pragma once
#include "bedload/core/types.hpp"
#include "bedload/core/vec.hpp"

namespace BL_SOLVER {

/// Sum of F r over pairs, J: row k has component k of the force. Each partner counts half of a pair's, so
/// that the stress of a volume is minus the sum over its particles divided by it [irving50].
template <class N = Real>
struct PairMoment {
  Vec3<N> row[3];

  BL_HD void add(const Vec3<N>& F, const Vec3<N>& r) {
    row[0] += F.x * r;
    row[1] += F.y * r;
    row[2] += F.z * r;
  }
  BL_HD void add(const PairMoment& o) {
    for (int k = 0; k < 3; ++k) row[k] += o.row[k];
  }
  BL_HD PairMoment times(N factor) const { return {{factor * row[0], factor * row[1], factor * row[2]}}; }
};

}  // namespace BL_SOLVER
