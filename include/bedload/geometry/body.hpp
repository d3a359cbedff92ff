#pragma once
// Wall bodies as rigid solids: what they weigh, where they touch.

#include <array>
#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/fluid.hpp"
#include "bedload/case/config/walls.hpp"

namespace bedload {

class Shape;

/// Integrals of 1, x and x x over a solid, about the origin.
struct SolidMoments {
  double volume = 0;               ///< m3
  Vec3d first;                     ///< m4
  std::array<double, 6> second{};  ///< of xx, yy, zz, xy, xz, yz, m5

  Vec3d middle() const { return first / volume; }
  /// A piece small enough to count as a point.
  void add(double volume, const Vec3d& at);
};

/// Of a closed solid: in closed form for one box, sphere, capsule, cylinder, cone, pipe or mesh, else, and of
/// the slab that its slice makes of a plane flow, on a raster of about a million cells.
SolidMoments solid_moments(const Shape& shape, const DomainConfig& domain = {});
/// Of a body that is closed: a box or a named shape, not a tank or a plane.
SolidMoments solid_moments(const WallBody& body, const DomainConfig& domain = {});
bool is_closed(const WallBody& body);

/// Mass, centre and inertia of a free body: as the case gives them, the rest from its shape at uniform
/// density. Throws CaseError, a sentence that continues "wall.body.free", where there is no closed shape.
MassProperties mass_properties(const WallBody& body, const DomainConfig& domain = {});

/// What a free body turns about and is placed by, m: the point that is held, else its centre of mass
/// (resolved).
Vec3d turning_centre(const FreeConfig& free);

/// Principal moments of inertia, kg m2, and the turn of their axes.
struct PrincipalInertia {
  Vec3d moments;
  Quat<double> axes;
};
PrincipalInertia principal_inertia(const std::array<double, 6>& inertia);

/// `inertia` of a mass (kg) about its centre, as seen from a point `offset` (m) away.
std::array<double, 6> shifted_inertia(const std::array<double, 6>& inertia, double mass, const Vec3d& offset);

/// The balls by which a free body touches others: those given; else the line of a sphere or capsule; else,
/// and in a plane flow, balls that touch its surface from within, contact_spacing apart.
std::vector<BodyBall> contact_balls(const WallBody& body, const DomainConfig& domain);

/// How far beyond the box around a wall body its particles or their images may lie, m.
double particles_beyond(const WallBody& body, const FluidConfig& fluid);

/// The corners of the box around a wall body, or of the domain for a plane, each moved `beyond` (m) outwards;
/// those of a plane flow in its middle.
std::vector<Vec3d> corners(const WallBody& body, const DomainConfig& domain, double beyond = 0);

}  // namespace bedload
