#pragma once
// History of a contact, kept from one substep to the next. What is added to springs is tiny compared with
// them, so it is found as a difference.
//
// A quantity to be remembered is a member of HistoryOf, with its unit, and a place in HistoryParts.
// Arrays of pairs, checkpoints and the memory estimate follow from that.

#include <string>
#include <utility>

#include "bedload/particles/field.hpp"

namespace BL_SOLVER {

/// Kept for the pair (lower id, higher id), or for (grain, wall surface).
template <class S>
struct HistoryOf {
  Vec3<S> xi;      ///< tangential spring, m
  Vec3<S> couple;  ///< elastic rolling couple on the first grain, N m
  S overlap = 0;   ///< at the last evaluation, m, to Real's digits; 0: none yet; < 0: apart, with a range
  S recede = 0;    ///< normal speed at the last evaluation, m/s, to Real's digits

  template <class T>
  BL_HD operator HistoryOf<T>() const {
    return {Vec3<T>(xi), Vec3<T>(couple), T(overlap), T(recede)};
  }
  static std::string units() { return "m, N m, m, m/s"; }
};
/// Of walls, and in files.
using ContactHistory = HistoryOf<double>;
/// Of pairs. Springs are rounded once a substep, as often up as down; slip by less than half of their last
/// digit a substep is lost, some nm/s.
using PairHistory = HistoryOf<Real>;

/// A vector and a number of a history, which arrays of pairs keep as one load.
template <auto vector, auto number>
struct HistoryPart {
  static constexpr std::size_t kBytes = 4 * sizeof(Real);
  Vec4<Real> value;

  BL_HD void from(const PairHistory& h) { value = {h.*vector, h.*number}; }
  BL_HD void to(PairHistory& h) const { h.*vector = value.xyz(), h.*number = value.w; }
};

template <class... Parts>
struct HistoryPartList {
  static constexpr std::size_t kBytes = (Parts::kBytes + ...);
  template <template <class...> class Of>
  using Apply = Of<Parts...>;
};
using HistoryParts = HistoryPartList<HistoryPart<&PairHistory::xi, &PairHistory::overlap>,
                                     HistoryPart<&PairHistory::couple, &PairHistory::recede>>;
static_assert(HistoryParts::kBytes == sizeof(PairHistory), "a member of HistoryOf is in no part");

/// Files hold a history as columns of doubles.
template <>
struct FileType<ContactHistory> {
  static constexpr Scalar scalar = Scalar::f64;
  static constexpr int components = sizeof(ContactHistory) / sizeof(double);
};

/// Length of a vector that may be too small for its square in Real.
BL_HD Real length_of(const Real3& a) {
  const Real size = max_of(std::abs(a.x), max_of(std::abs(a.y), std::abs(a.z)));
  return size == 0 ? Real(0) : size * norm(a * quotient(Real(1), size));
}

/// How a contact turns in the second half of a substep, from the normal n_mid to n: about it by `twist`
/// (rad), then by the shortest rotation from one to the other.
class ContactTurn {
 public:
  BL_HD ContactTurn(const Real3& n_mid, const Real3& n, Real twist)
      : n_mid_(n_mid), n_(n), bend_((n_mid + n) * quotient(Real(1), 1 + dot(n_mid, n))), twist_(twist) {}

  /// Of a vector normal to n_mid, the rotation from n_mid to n alone.
  BL_HD Real3 tilted(const Real3& a) const { return a - dot(a, n_) * bend_; }
  /// By how much a spring `a` changes that was tangential at the start of the substep. Its length is kept: as
  /// a small difference, found as such, this has all digits of a Real.
  BL_HD Real3 change(const Real3& a) const {
    const Real size = max_of(std::abs(a.x), max_of(std::abs(a.y), std::abs(a.z)));
    if (size == 0) return {};
    const Real3 u = a * quotient(Real(1), size);  // springs of tiny grains have no squares in fp32
    const Real3 across = cross(n_mid_, u);
    const Real along = dot(u, n_mid_);
    Real3 moved = twist_ * across - along * n_mid_;
    // |u + moved|^2 = |u|^2 (1 + longer)
    const Real longer = quotient(square(twist_) * norm2(across) - square(along), norm2(u)), left = 1 + longer;
    if (!(left > Real(1e-6))) return -a;
    moved -= quotient(longer, left + std::sqrt(left)) * (u + moved);
    moved -= dot(u + moved, n_) * bend_;
    return size * moved;
  }

 private:
  Real3 n_mid_, n_, bend_;
  Real twist_;
};
/// The unit vector halfway between two others; b if they are opposite.
BL_HD Real3 halfway(const Real3& a, const Real3& b) {
  const Real3 sum = a + b;
  const Real size = norm(sum);
  return size > 0 ? sum * quotient(Real(1), size) : b;
}

}  // namespace BL_SOLVER
