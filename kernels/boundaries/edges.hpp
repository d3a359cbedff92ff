#pragma once
// Reflecting sides of the domain.

#include "bedload/case/config/domain.hpp"
#include "bedload/core/frame.hpp"

namespace BL_SOLVER {

/// A particle that crosses a reflecting side is mirrored back, and its velocity is reversed: the normal
/// component with slip, all components without [tsuzuki]. Its speed is unchanged. Sides have neither
/// particles nor surfaces: they have no effect on particles that do not cross them.
class Edges {
 public:
  Edges() = default;
  Edges(const ReflectConfig& sides, const Frame& frame) {
    for (int face = 0; face < 6; ++face) {
      at_[face] = face % 2 ? frame.origin[face / 2] + frame.length[face / 2] : frame.origin[face / 2];
      rounding_[face / 2] = frame.length[face / 2] * kPackedRounding;
      if (sides.slip[face] || sides.no_slip[face]) all_ |= 1u << face;
      if (sides.no_slip[face]) no_slip_ |= 1u << face;
    }
  }
  BL_HD bool any() const { return all_ != 0; }

  /// Reflects a particle that has moved from `from` to x with velocity v.
  template <class T>
  BL_HD void put_back(const Vec3d& from, Vec3d& x, Vec3<T>& v) const {
    if (const unsigned crossed = mirror(from, x)) turn(crossed, v);
  }
  /// x - way, mirrored if that is outside.
  BL_HD Vec3d inside(const Vec3d& x, const Vec3d& way) const {
    Vec3d at = x - way;
    mirror(x, at);
    return at;
  }

 private:
  /// Mirrors x at the sides that it crossed; returns them, one bit per side.
  BL_HD unsigned mirror(const Vec3d& from, Vec3d& x) const {
    unsigned crossed = 0;
    if (!any()) return crossed;
    for (int face = 0; face < 6; ++face) {
      const int k = face / 2;
      const double out = face % 2 ? 1 : -1, beyond = out * (x[k] - at_[face]);
      if (!(all_ >> face & 1u) || !(beyond > 0) || out * (from[k] - at_[face]) > rounding_[k]) continue;
      x[k] = 2 * at_[face] - x[k];
      crossed |= 1u << face;
    }
    return crossed;
  }
  /// Drift may differ from velocity: a velocity that points inwards is kept.
  template <class T>
  BL_HD void turn(unsigned crossed, Vec3<T>& v) const {
    for (int face = 0; face < 6; ++face)
      if ((crossed & no_slip_) >> face & 1u && outwards(face, v)) {
        v = -v;
        break;
      }
    for (int face = 0; face < 6; ++face)
      if (crossed >> face & 1u && outwards(face, v)) v[face / 2] = -v[face / 2];
  }
  template <class T>
  BL_HD static bool outwards(int face, const Vec3<T>& v) {
    return face % 2 ? v[face / 2] > 0 : v[face / 2] < 0;
  }

  double at_[6] = {0, 0, 0, 0, 0, 0}, rounding_[3] = {0, 0, 0};  ///< m
  unsigned all_ = 0, no_slip_ = 0;                               ///< one bit per side, in the order of kFaces
};

}  // namespace BL_SOLVER
