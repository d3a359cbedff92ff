#pragma once
#include "bedload/particles/store.hpp"

namespace bedload::inline BL_VARIANT {

/// Where a wall body is and how it moves, about its centre of motion.
struct BodyPose {
  Vec3d centre;       ///< point that the rotation leaves alone, at t = 0 (m)
  Vec3d translation;  ///< m
  Quat<double> rotation;
  Vec3d v, omega;               ///< of the centre, m/s; rad/s
  Vec3d a, alpha;               ///< m/s2; rad/s2
  std::uint32_t slip = 0;       ///< 1: slip
  std::uint32_t repulsion = 0;  ///< 1: Monaghan repulsion
  std::uint32_t present = 1;    ///< 0: removed

  BL_HD bool turned() const { return rotation.w != 1; }
  BL_HD Vec3d place(const Vec3d& x0) const {
    return turned() ? centre + translation + rotation.rotate(x0 - centre) : x0 + translation;
  }
  BL_HD Vec3d velocity(const Vec3d& x) const { return v + cross(omega, x - centre - translation); }
  BL_HD Vec3d acceleration(const Vec3d& x) const {
    const Vec3d r = x - centre - translation;
    return a + cross(alpha, r) + cross(omega, cross(omega, r));
  }
};

/// Wall particles of the fluid: prescribed motion, extrapolated state. The next density step reads the state
/// of the last one, so it is kept.
struct WallStore : Store {
  WallStore() : Store("walls") {}

  Field<Id> id{*this, "id", "-", Lifetime::kept};
  Field<Vec3d> x0{*this, "x0", "m", Lifetime::kept};  ///< place at t = 0
  Field<std::uint32_t> body{*this, "body", "-", Lifetime::kept};
  Field<Vec3d> x{*this, "x", "m", Lifetime::kept};
  Field<Vec3d> x_list{*this, "x_list", "m", Lifetime::kept};
  Field<PairPosition> xp{*this, "xp", "m", Lifetime::derived};
  Field<Real4> v_rho{*this, "v_rho", "m/s, kg/m3", Lifetime::kept};  ///< true velocity, superficial density
  Field<Real4> v_visc{*this, "v_visc", "m/s",
                      Lifetime::kept};  ///< no-slip velocity; w = 1 where viscous pairs count
  Field<Real4> m_state{*this, "m_state", "-", Lifetime::kept};  ///< as of the fluid; mass 0: inactive
};

}  // namespace bedload::inline BL_VARIANT
