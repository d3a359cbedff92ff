#pragma once
// Particles as spheres, seen from somewhere.

#include <vector>

#include "bedload/core/vec.hpp"
#include "src/viewer/image.hpp"

namespace bedload {

struct Sphere {
  Vec3d x;            ///< m
  double radius = 0;  ///< m
  Colour colour;
};

/// Grains hide each other; fluid veils the grains behind it; walls, one layer of spheres, are a haze, thick
/// where they are seen along their length.
struct Scene {
  std::vector<Sphere> grains, fluid, walls;
  Vec3d min, max;  ///< around everything, m
};

/// A place on the picture.
struct Spot {
  double x = 0, y = 0;  ///< pixels, y downwards
  double depth = 0;     ///< m, away from the viewer
  double scale = 0;     ///< pixels per m there
};

/// Where the viewer is: far away, or `distance` before the centre.
struct View {
  Vec3d right, up, toward;  ///< unit vectors of the picture, the last one to the viewer
  Vec3d centre;             ///< what lies at (0, 0), m
  double distance = 0;      ///< of the viewer from there, m; 0: far away
  double scale = 1;         ///< pixels per m at the centre
  double x0 = 0, y0 = 0;    ///< pixels

  Spot place(const Vec3d& x) const;
};

/// Makes `view` show `scene` as large as width x height pixels allow, in their middle.
void fit(View& view, const Scene& scene, int width, int height);

/// The scene in width x height pixels, each of which is the mean of fine x fine.
Image render(const Scene& scene, const View& view, int width, int height, Colour background, int fine = 2);

}  // namespace bedload
