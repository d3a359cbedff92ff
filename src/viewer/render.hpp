#pragma once
// Renders particles as spheres.

#include <vector>

#include "bedload/core/vec.hpp"
#include "src/viewer/image.hpp"

namespace bedload {

struct Sphere {
  Vec3d x;            ///< m
  double radius = 0;  ///< m
  Colour colour;
};

/// Grains are opaque, fluid is translucent over the grains behind it; walls, one layer of spheres, are a
/// haze, denser where seen edge-on.
struct Scene {
  std::vector<Sphere> grains, fluid, walls;
  Vec3d min, max;  ///< around everything, m
};

/// A point in the picture.
struct Spot {
  double x = 0, y = 0;  ///< pixels, y downwards
  double depth = 0;     ///< m, away from the viewer
  double scale = 0;     ///< pixels per m there
};

/// The viewer: at infinity (parallel projection), or at `distance` from the centre.
struct View {
  Vec3d right, up, toward;  ///< unit vectors of the picture, the last one to the viewer
  Vec3d centre;             ///< point of the scene at (0, 0), m
  double distance = 0;      ///< of the viewer from the centre, m; 0: at infinity
  double scale = 1;         ///< pixels per m at the centre
  double x0 = 0, y0 = 0;    ///< pixels

  Spot place(const Vec3d& x) const;
};

/// Scales and centres `view` so that `scene` fills width x height pixels.
void fit(View& view, const Scene& scene, int width, int height);

/// The scene in width x height pixels, each the mean of fine x fine samples.
Image render(const Scene& scene, const View& view, int width, int height, Colour background, int fine = 2);

}  // namespace bedload
