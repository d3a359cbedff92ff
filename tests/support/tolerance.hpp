#pragma once
#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// The tolerance of this build's precision.
constexpr double tolerance(double in_double, double in_mixed, double in_single) {
  return sizeof(Real) == 8 ? in_double : (BL_PACKED_POSITIONS ? in_single : in_mixed);
}
/// Conserved sums, against the sum of magnitudes.
constexpr double kInvariant = tolerance(1e-12, 1e-6, 1e-5);

}  // namespace BL_SOLVER
