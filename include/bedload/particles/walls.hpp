#pragma once
#include "bedload/core/rigid_motion.hpp"
#include "bedload/core/wall_kind.hpp"
#include "bedload/particles/store.hpp"

namespace BL_SOLVER {

/// Where a wall body is, how it moves and how it meets fluid and grains.
struct BodyPose : RigidMotion {
  std::uint32_t slip = 0;            ///< 1: slip
  std::uint32_t repulsion = 0;       ///< 1: Monaghan repulsion
  std::uint32_t no_penetration = 0;  ///< 1: stops fluid that comes too near
  std::uint32_t present = 1;         ///< 0: removed
  std::uint32_t flows = 0;           ///< 1: fluid on its way in
  std::uint32_t free = 0;            ///< 1 + place among the free bodies; 0: motion prescribed
  WallKind kind = WallKind::extrapolated;
  double volume = 0;  ///< that one of its particles represents, m3
  Vec3d slide;        ///< velocity of its surface in place, in the body's axes, m/s
};

/// Images of wall particles in the fluid. Empty, or one for each wall particle and in their order; those of
/// walls that are not mirrored stand on the particles themselves.
struct MirrorStore : Store {
  MirrorStore() : Store("mirrors") {}

  Field<Vec3d> x0{*this, "x0", "m", Lifetime::kept};  ///< place at t = 0
  Field<Vec3d> x{*this, "x", "m", Lifetime::kept};
  Field<Vec3d> x_list{*this, "x_list", "m", Lifetime::renewed};
  Field<PairPosition> xp{*this, "xp", "m", Lifetime::derived};
};

constexpr Real kNoCompression = -1;  // no fluid is as thin as that

/// Wall particles of the fluid: prescribed motion, state by the kind of their body. The next density step
/// reads the state of the last one, so it is kept.
struct WallStore : Store {
  WallStore() : Store("walls") {}

  Field<Id> id{*this, "id", "-", Lifetime::kept, Output{.order = 99}};
  Field<Vec3d> x0{*this, "x0", "m", Lifetime::kept};  ///< place at t = 0
  Field<std::uint32_t> body{*this, "body", "-", Lifetime::kept, Output{.order = 3}};
  Field<Vec3d> x{*this, "x", "m", Lifetime::kept, Output{.order = 0, .uses = kViews, .name = "position"}};
  Field<Vec3d> x_list{*this, "x_list", "m", Lifetime::renewed};
  Field<PairPosition> xp{*this, "xp", "m", Lifetime::derived};
  Field<PairPosition> xp_mid{*this, "xp_mid", "m",
                             Lifetime::derived};  ///< as the fluid's; left out where no wall moves
  Field<VelocityDensity<>> v_rho{
      *this, "v_rho", "m/s, kg/m3", Lifetime::kept,
      Output{.order = 1, .name = "velocity", .unit = "m/s", .components = 3}};  ///< true velocity, density
  Field<NoSlip<>> no_slip{*this, "no_slip", "m/s, kg", Lifetime::kept};
  Field<WallState<>> state{*this, "state", "kg, m5/(kg s2), kg/m3, -", Lifetime::kept};
  /// rho / rho0 - 1 of frozen and mirrored walls; kNoCompression: outer layers of a frozen one, or no fluid
  /// about the image
  Field<Real> compression{*this, "compression", "-", Lifetime::kept};
  Field<Real> work{*this, "work", "m6/s",
                   Lifetime::derived};  ///< of WallWorkPass; left out where nothing pays
  MirrorStore mirrors;
};

}  // namespace BL_SOLVER
