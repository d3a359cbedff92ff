#pragma once
#include "bedload/core/vec.hpp"

namespace bedload {

/// Where a rigid body has been taken and how it moves: a point that was at x0 is at
/// centre + translation + rotation (x0 - centre).
struct RigidMotion {
  Vec3d centre;       ///< m
  Vec3d translation;  ///< of the centre, m
  Quat<double> rotation;
  Vec3d v, omega;  ///< of the centre, m/s; rad/s
  Vec3d a, alpha;  ///< m/s2; rad/s2

  /// Where its centre is now, m.
  BL_HD Vec3d origin() const { return centre + translation; }
  BL_HD bool turned() const { return rotation.w != 1; }
  BL_HD Vec3d place(const Vec3d& x0) const {
    return turned() ? origin() + rotation.rotate(x0 - centre) : x0 + translation;
  }
  /// Where a point was that is at x now.
  BL_HD Vec3d undo(const Vec3d& x) const {
    return turned() ? centre + rotation.conjugate().rotate(x - origin()) : x - translation;
  }
  BL_HD Vec3d velocity(const Vec3d& x) const { return v + cross(omega, x - origin()); }
  BL_HD Vec3d acceleration(const Vec3d& x) const { return speeding_up(x) + centripetal(x); }
  /// The two parts of the acceleration: from the change of velocity and spin, and from the spin itself.
  BL_HD Vec3d speeding_up(const Vec3d& x) const { return a + cross(alpha, x - origin()); }
  BL_HD Vec3d centripetal(const Vec3d& x) const { return cross(omega, cross(omega, x - origin())); }
};

}  // namespace bedload
