#pragma once
// The number types of one build of the solver library. The library is compiled
// once per precision and backend, each build in its own inline namespace
// (BL_VARIANT, set by CMake), and chosen at run time.

#include <cstdint>

#include "bedload/core/vec.hpp"

#if !defined(BL_VARIANT) || !defined(BL_REAL) || !defined(BL_PACKED_POSITIONS)
#error "compile through the bedload_variant() CMake function, which sets BL_VARIANT, BL_REAL, BL_PACKED_POSITIONS"
#endif
/// The namespace of the solver. A name without `inline` in it, so that ctags finds what is inside.
#define BL_SOLVER bedload::inline BL_VARIANT

namespace BL_SOLVER {

using Real = BL_REAL;  ///< velocities, densities, pressures and pair arithmetic
using Real3 = Vec3<Real>;
using Real4 = Vec4<Real>;
using Index = std::uint32_t;  ///< place of a particle in its (sorted) store
using Id = std::uint32_t;     ///< permanent name of a particle
constexpr Index kNone = 0xffffffffu;
constexpr Real kPi = Real(3.14159265358979323846);

template <class N>
BL_HD N square(N x) {
  return x * x;
}
template <class N>
BL_HD N cube(N x) {
  return x * x * x;
}
template <class T>
BL_HD T min_of(T a, T b) {
  return a < b ? a : b;
}
template <class T>
BL_HD T max_of(T a, T b) {
  return a > b ? a : b;
}
template <class T>
BL_HD T clamp(T x, T lo, T hi) {
  return x < lo ? lo : (x > hi ? hi : x);
}

}  // namespace BL_SOLVER
