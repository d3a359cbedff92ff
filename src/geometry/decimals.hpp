#pragma once
// Lengths rounded so that they do not depend on the place of the origin.

#include <cmath>

#include "bedload/core/vec.hpp"

namespace bedload {

/// Rounds to a power of ten that is at most 1e-7 of a length: decimals, as cases hold them, stay as they are.
class Decimals {
 public:
  explicit Decimals(double length) {
    const double digits = std::ceil(7 - std::log10(length));
    if (std::abs(digits) <= 22) per_metre_ = std::pow(10, digits);  // beyond, powers are not exact
  }

  double operator()(double x) const {
    return per_metre_ > 0 ? std::nearbyint(x * per_metre_) / per_metre_ : x;
  }
  Vec3d operator()(const Vec3d& x) const { return {(*this)(x.x), (*this)(x.y), (*this)(x.z)}; }

  /// A length that must not vanish: as it is where it is hardly longer than the last decimal.
  double positive(double x) const { return std::abs(x * per_metre_) < 1000 ? x : (*this)(x); }

 private:
  double per_metre_ = 0;
};

}  // namespace bedload
