#pragma once
// The 19 velocities of the lattice, D3Q19. Opposite ones are neighbours: 1 and 2, 3 and 4, ... 17 and 18.

#include <utility>

#include "bedload/core/vec.hpp"

namespace bedload::d3q19 {

constexpr int kVelocities = 19;
constexpr int kPairs = 9;  ///< of opposite velocities; pair p holds 2 p + 1 and 2 p + 2

/// Component of the odd velocity of a pair along an axis: 1 more than it in two bits for each pair, so that
/// no table lies in memory.
BL_HD constexpr int step(int pair, int axis) {
  const unsigned all = axis == 0 ? 0x1a696u : axis == 1 ? 0x24999u : 0x01a65u;
  return int(all >> (2 * pair) & 3u) - 1;
}
BL_HD constexpr int pair_of(int i) { return (i - 1) / 2; }
BL_HD constexpr bool is_odd(int i) { return i % 2 == 1; }
/// Of a velocity other than 0.
BL_HD constexpr int opposite(int i) { return is_odd(i) ? i + 1 : i - 1; }
/// Component of velocity i along an axis, in nodes a step.
BL_HD constexpr int velocity(int i, int axis) {
  return i == 0 ? 0 : is_odd(i) ? step(pair_of(i), axis) : -step(pair_of(i), axis);
}
template <class N>
BL_HD constexpr Vec3<N> velocity_of(int i) {
  return {N(velocity(i, 0)), N(velocity(i, 1)), N(velocity(i, 2))};
}
/// Calls f(p) for every pair, each a constant: what is kept by pair can stay in registers.
template <class F>
BL_HD void each_pair(const F& f) {
  [&]<int... p>(std::integer_sequence<int, p...>) { (f(std::integral_constant<int, p>{}), ...); }
  (std::make_integer_sequence<int, kPairs>{});
}
BL_HD constexpr double weight(int i) { return i == 0 ? 1.0 / 3 : i <= 6 ? 1.0 / 18 : 1.0 / 36; }

}  // namespace bedload::d3q19
