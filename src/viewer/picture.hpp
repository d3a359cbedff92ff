#pragma once
// The initial state of a case as a picture.

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"
#include "src/viewer/image.hpp"

namespace bedload {

inline constexpr double kFluidRadius = 0.71;  ///< of a fluid particle, spacings; no gaps on a lattice
inline constexpr Colour kPaper{1, 1, 1}, kWall{0.35f, 0.38f, 0.45f}, kMoving{0.85f, 0.25f, 0.15f};

/// Unit vectors of a view: to the right, upwards and towards the viewer.
struct Sides {
  Vec3d right, up, toward;
};

/// The axes of the case along, up and into the front view; up is against gravity.
struct Axes {
  int along = 0, up = 2, into = 1;
  double sign = 1;  ///< of up

  explicit Axes(const Vec3d& gravity);
  Sides front() const;
  Sides above() const;
  /// Obliquely from the front, the right and above.
  Sides oblique() const;
};

/// Spacing of the particles that show walls in a picture: `at_least`, and no finer than a picture resolves,
/// m.
double surface_spacing(const Config& config, double at_least);

/// One layer of particles below the surface of every wall body, at surface_spacing().
Setup::Walls wall_surfaces(const Config& config, double at_least);

/// Views from the front, from above and in perspective, with axes and legend.
Image picture_of(const Config& config, const Setup& setup);

}  // namespace bedload
