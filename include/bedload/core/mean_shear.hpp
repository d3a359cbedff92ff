#pragma once
// Lees-Edwards boundaries [lees72]: the images of the box across z move along x, and shear what is in it.

#include "bedload/core/types.hpp"

namespace BL_SOLVER {

/// Flow along x with a mean gradient along z, at rest in the middle of the box. Loops over pairs see
/// positions that are sheared back by the strain, among which the box and its images are a lattice of right
/// angles as without shear, and peculiar velocities, less those of the mean flow, which are the same for all
/// images.
struct MeanShear {
  double rate = 0;             ///< dv_x / dz, 1/s; 0: no shear
  double strain = 0;           ///< by how much images have moved over their distance, but for whole periods
  double low = 0, height = 0;  ///< of the box along z, m

  BL_HD bool acts() const { return rate != 0; }
  /// A time dt (s) ago.
  BL_HD MeanShear before(double dt) const { return {rate, strain - rate * dt, low, height}; }
  BL_HD double from_middle(double z) const { return z - low - height / 2; }
  /// x sheared back.
  BL_HD Vec3d lattice(const Vec3d& x) const { return {x.x - strain * from_middle(x.z), x.y, x.z}; }
  BL_HD Real3 peculiar(const Real3& v, double z) const {
    return {Real(v.x - rate * from_middle(z)), v.y, v.z};
  }
  /// Into the box along z: what leaves comes back at the other face as the image there moves.
  BL_HD void wrap(Vec3d& x, Real3& v) const {
    const double periods = floor((x.z - low) / height);
    if (periods == 0) return;
    x.z -= periods * height;
    x.x -= periods * height * strain;
    v.x = Real(v.x - periods * height * rate);
  }
  /// The most that a distance may be longer among positions that are sheared back.
  double stretch() const { return std::abs(strain) / 2 + std::sqrt(1 + strain * strain / 4); }
};

}  // namespace BL_SOLVER
