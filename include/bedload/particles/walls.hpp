#pragma once
#include "bedload/core/rigid_motion.hpp"
#include "bedload/particles/store.hpp"

namespace bedload::inline BL_VARIANT {

/// Where a wall body is, how it moves and how it meets fluid and grains.
struct BodyPose : RigidMotion {
  std::uint32_t slip = 0;       ///< 1: slip
  std::uint32_t repulsion = 0;  ///< 1: Monaghan repulsion
  std::uint32_t present = 1;    ///< 0: removed
  std::uint32_t flows = 0;      ///< 1: fluid on its way in, at the spacing of the fluid
  std::uint32_t free = 0;       ///< 1 + place among the free bodies; 0: motion prescribed
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
  /// mass (kg; 0: inactive), P / rho~^2, intrinsic density, mass that came with the last change of porosity
  Field<Real4> m_state{*this, "m_state", "-", Lifetime::kept};
};

}  // namespace bedload::inline BL_VARIANT
