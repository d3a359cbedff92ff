#pragma once
// History of a contact, kept from one substep to the next. Springs are fp64 in every precision, because
// increments are tiny compared with their sums.

#include "bedload/particles/field.hpp"

namespace bedload::inline BL_VARIANT {

/// Kept for the pair (lower id, higher id), or for (grain, wall surface).
struct ContactHistory {
  Vec3d xi;            ///< tangential spring, m
  Vec3d couple;        ///< elastic rolling couple on the first grain, N m
  double overlap = 0;  ///< at the last evaluation, m, to Real's digits; 0: apart. Walls: negative behind them
  double recede = 0;   ///< normal speed at the last evaluation, m/s, to Real's digits
};

template <>
struct FileType<ContactHistory> {
  static constexpr Scalar scalar = Scalar::f64;
  static constexpr int components = 8;
};
static_assert(sizeof(ContactHistory) == 8 * sizeof(double));

/// Rotates the tangential vector `a` with a contact that has turned by `twist` (rad) about its normal, which
/// is now n. The length is kept; the result lies in the new tangent plane.
BL_HD Vec3d turn_with_contact(const Vec3d& a, const Vec3d& n, double twist) {
  const double before = norm2(a);
  if (before == 0) return a;
  Vec3d b = a + twist * cross(n, a);
  b -= dot(b, n) * n;
  const double after = norm2(b);
  return after > 0 ? b * std::sqrt(before / after) : Vec3d{};
}

/// The shortest rotation that takes the unit vector `from` to `to`, of vectors normal to `from`.
struct Tilt {
  Vec3d to, bend;
  BL_HD Tilt(const Vec3d& from, const Vec3d& onto)
      : to(onto), bend((from + onto) * (1 / (1 + dot(from, onto)))) {}
  BL_HD Vec3d operator()(const Vec3d& a) const { return a - dot(a, to) * bend; }
};
/// The unit vector halfway between two others; b if they are opposite.
BL_HD Vec3d halfway(const Vec3d& a, const Vec3d& b) {
  const Vec3d sum = a + b;
  const double size = norm(sum);
  return size > 0 ? sum * (1 / size) : b;
}

}  // namespace bedload::inline BL_VARIANT
