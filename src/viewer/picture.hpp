#pragma once
// A case before it runs, drawn.

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"
#include "src/viewer/image.hpp"

namespace bedload {

inline constexpr double kFluidRadius = 0.71;  ///< of a fluid particle, spacings; no gaps on a lattice
inline constexpr Colour kPaper{1, 1, 1}, kWall{0.35f, 0.38f, 0.45f}, kMoving{0.85f, 0.25f, 0.15f};

/// What a picture has to the right, upwards and towards the viewer, as unit vectors.
struct Sides {
  Vec3d right, up, toward;
};

/// Which axes of the case run along, up and into the picture seen from the front: up is against gravity.
struct Axes {
  int along = 0, up = 2, into = 1;
  double sign = 1;  ///< of up

  explicit Axes(const Vec3d& gravity);
  Sides front() const;
  Sides above() const;
  /// From the front, from the right and from above, for a perspective.
  Sides aslant() const;
};

/// How far apart particles below the surfaces of walls are in a picture of all that there is: `at_least`, and
/// no finer than it shows, m.
double surface_spacing(const Config& config, double at_least);

/// One layer of particles below the surface of every wall body, so far apart.
Setup::Walls wall_surfaces(const Config& config, double at_least);

/// Views from the front, from above and in perspective, with axes and a legend.
Image picture_of(const Config& config, const Setup& setup);

}  // namespace bedload
