#pragma once
// Surfaces of wall bodies: single layers on them, images in them, how thick what is behind them is.

#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/walls.hpp"
#include "bedload/geometry/shape.hpp"

namespace bedload {

/// Particles on the surface of `body` at t = 0, m, 1 / spacing^2 of them per area; on flat sides the centres
/// of a lattice that divides the side evenly. A plane is covered as far as the domain reaches. A shell
/// thinner than the spacing has one layer for both its sides.
std::vector<Vec3d> sample_surface(const WallBody& body, double spacing, const DomainConfig& domain);

/// Place on the surface of `body` nearest to x, which lies behind it, m.
Vec3d surface_point(const WallBody& body, const Vec3d& x, const DomainConfig& domain);

/// The surface of `body` as seen from x; the normal is that of the surface at its nearest place, into the
/// flow.
SurfacePoint nearest_surface(const WallBody& body, const Vec3d& x, const DomainConfig& domain);

/// How thick the solid is behind the surface at `points`, m: by its sides for a box, for a shape such
/// that a twentieth of it is thinner; 0 and more, +infinity from `reach` on and where nothing lies behind.
double thickness(const WallBody& body, const std::vector<Vec3d>& points, double reach,
                 const DomainConfig& domain);

}  // namespace bedload
