#pragma once
#include "bedload/particles/store.hpp"

namespace BL_SOLVER {

/// Free rigid bodies. The reference point of a body is its centre of mass, or the pivot of a body that only
/// rotates. Forces are those of the last evaluation; torques are about the reference point.
struct BodyStore : Store {
  BodyStore() : Store("bodies") {}

  Field<Vec3d> x{*this, "x", "m", Lifetime::kept};                       ///< of the reference point
  Field<Vec4<double>> rotation{*this, "rotation", "-", Lifetime::kept};  ///< since t = 0: x, y, z, w
  Field<Vec3d> v{*this, "v", "m/s", Lifetime::kept};                     ///< of the reference point
  /// About the reference point.
  Field<Vec3d> angular_momentum{*this, "angular_momentum", "kg m2/s", Lifetime::kept};
  Field<Vec3d> a{*this, "acceleration", "m/s2", Lifetime::kept};  ///< as the fluid next to it reads it
  Field<Vec3d> alpha{*this, "angular_acceleration", "rad/s2", Lifetime::kept};
  Field<Vec3d> grain_force{*this, "grain_force", "N", Lifetime::kept};
  Field<Vec3d> grain_torque{*this, "grain_torque", "N m", Lifetime::kept};
  Field<Vec3d> contact_force{*this, "contact_force", "N", Lifetime::kept};  ///< of other bodies
  Field<Vec3d> contact_torque{*this, "contact_torque", "N m", Lifetime::kept};
  Field<Vec3d> fluid_force{*this, "fluid_force", "N", Lifetime::kept};
  Field<Vec3d> fluid_torque{*this, "fluid_torque", "N m", Lifetime::kept};
  // the part of it that pressure.linear_exact adds to the force of the pairs
  Field<Vec3d> corrected_force{*this, "pressure_correction", "N", Lifetime::kept};
  Field<Vec3d> corrected_torque{*this, "pressure_correction_torque", "N m", Lifetime::kept};
  // at the start of the last step
  Field<Vec3d> x_before{*this, "x_before", "m", Lifetime::derived};
  Field<Vec4<double>> rotation_before{*this, "rotation_before", "-", Lifetime::derived};
  Field<Vec3d> v_before{*this, "v_before", "m/s", Lifetime::derived};
  Field<Vec3d> omega_before{*this, "omega_before", "rad/s", Lifetime::derived};
};

}  // namespace BL_SOLVER
