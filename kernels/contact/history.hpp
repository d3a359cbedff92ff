#pragma once
// History of a contact, kept from one substep to the next. Springs are fp64 in every precision, because
// increments are tiny compared with their sums.
//
// A quantity to be remembered is a member of ContactHistory and a place in HistoryParts, with its unit.
// Arrays of pairs, checkpoints and the memory estimate follow from that.

#include <string>
#include <utility>

#include "bedload/particles/field.hpp"

namespace BL_SOLVER {

/// Kept for the pair (lower id, higher id), or for (grain, wall surface).
struct ContactHistory {
  Vec3d xi;            ///< tangential spring, m
  Vec3d couple;        ///< elastic rolling couple on the first grain, N m
  double overlap = 0;  ///< at the last evaluation, m, to Real's digits; 0: apart. Walls: negative behind them
  double recede = 0;   ///< normal speed at the last evaluation, m/s, to Real's digits
};

/// Members of a history that an array of pairs holds side by side, as numbers of type T.
template <class T, auto... members>
struct HistoryPart {
  static constexpr std::size_t kBytes = (sizeof(std::declval<ContactHistory>().*members) + ...);
  T value[sizeof...(members)];

  BL_HD void from(const ContactHistory& h) {
    T* to = value;
    ((*to++ = T(h.*members)), ...);
  }
  BL_HD void to(ContactHistory& h) const {
    const T* from = value;
    ((h.*members = *from++), ...);
  }
};

// Each part has its units, and whether a law needs it: kOptional and keeps(law).
struct SlidingSpring : HistoryPart<Vec3d, &ContactHistory::xi> {
  static constexpr const char* units = "m";
  static constexpr bool kOptional = true;
  static bool keeps(const auto& law) { return law.slides(); }
};
struct RollingCouple : HistoryPart<Vec3d, &ContactHistory::couple> {
  static constexpr const char* units = "N m";
  static constexpr bool kOptional = true;
  static bool keeps(const auto& law) { return law.remembers_couple(); }
};
/// Not accumulated, so that Real is precise enough.
struct LastApproach : HistoryPart<Real, &ContactHistory::overlap, &ContactHistory::recede> {
  static constexpr const char* units = "m, m/s";
  static constexpr bool kOptional = false;
  static bool keeps(const auto&) { return true; }
};

/// All of them, in the order of the members.
template <class... Parts>
struct HistoryPartList {
  static constexpr std::size_t kBytes = (Parts::kBytes + ...);
  /// "m, N m, m, m/s"
  static std::string units() {
    std::string all;
    ((all += (all.empty() ? "" : ", ") + std::string(Parts::units)), ...);
    return all;
  }
  template <template <class...> class Of>
  using Apply = Of<Parts...>;
};
using HistoryParts = HistoryPartList<SlidingSpring, RollingCouple, LastApproach>;
static_assert(HistoryParts::kBytes == sizeof(ContactHistory), "a member of ContactHistory is in no part");

/// Files hold a history as columns of doubles.
template <>
struct FileType<ContactHistory> {
  static constexpr Scalar scalar = Scalar::f64;
  static constexpr int components = sizeof(ContactHistory) / sizeof(double);
};

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
      : to(onto), bend((from + onto) * quotient(1.0, 1 + dot(from, onto))) {}
  BL_HD Vec3d operator()(const Vec3d& a) const { return a - dot(a, to) * bend; }
};
/// The unit vector halfway between two others; b if they are opposite.
BL_HD Vec3d halfway(const Vec3d& a, const Vec3d& b) {
  const Vec3d sum = a + b;
  const double size = root(norm2(sum));
  return size > 0 ? sum * quotient(1.0, size) : b;
}

}  // namespace BL_SOLVER
