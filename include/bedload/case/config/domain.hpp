#pragma once
// Extent of a case, and whether it is plane, periodic or sheared.

#include <array>

#include "bedload/core/vec.hpp"

namespace bedload {

/// Sides of the domain that reflect what crosses them, in the order of kFaces.
struct ReflectConfig {
  std::array<bool, 6> slip{}, no_slip{};
  bool any() const { return *this != ReflectConfig{}; }
  bool operator==(const ReflectConfig&) const = default;
};

struct DomainConfig {
  Vec3d min, max;                              ///< m
  std::array<bool, 3> periodic{false, false, false};
  ReflectConfig reflect{};
  bool two_d = false;                          ///< flow in the plane of x and z, the same at every y
  double shear_rate = 0;                       ///< of Lees-Edwards boundaries, dv_x / dz, 1/s; 0: none
  double thickness() const { return two_d ? max.y - min.y : 0; }  ///< of the plane flow, m; 0 in 3-D
  double middle() const { return 0.5 * (min.y + max.y); }         ///< y of the plane, m
  bool flat(int k) const { return two_d && k == 1; }              ///< whether nothing changes along axis k
  bool sheared() const { return shear_rate != 0; }
  /// Spacing of a lattice along axis k: a plane flow has one layer.
  double spacing_along(int k, double spacing) const { return flat(k) ? thickness() : spacing; }
  /// Volume that a particle of a lattice of that spacing represents, m3.
  double cell_volume(double spacing) const { return spacing * spacing * spacing_along(1, spacing); }
  bool operator==(const DomainConfig&) const = default;
};

}  // namespace bedload
