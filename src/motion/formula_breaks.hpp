#pragma once
#include <vector>

#include "bedload/case/formula.hpp"

namespace bedload {

/// Where a formula in t is not smooth.
struct Break {
  double time;       ///< s
  double within;     ///< s; it lies in time - within .. time + within
  double jump;       ///< of its value
  double rate_jump;  ///< of its rate, 1/s times the value's unit
};

/// Breaks of a formula over `span` seconds from 0 on, ascending: jumps of more than a millionth of what it
/// covers, and of its rate by more than a hundredth of the highest. At most some hundred; two that lie within
/// 1/4096 of the span may be taken for one. Found by where second differences do not vanish as steps do.
std::vector<Break> breaks_of(const Formula& formula, double span);

}  // namespace bedload
