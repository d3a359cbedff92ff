#include <cmath>
#include <limits>

#include "kernels/walls/surface.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

Vec3d unit(int k, double sign = 1) {
  Vec3d e;
  e[k] = sign;
  return e;
}

/// Half the extent of a body along axis k; without end where it spans a period.
double half_extent(const Config& config, const WallBody& body, int k) {
  const double length = body.max[k] - body.min[k], period = config.domain.max[k] - config.domain.min[k];
  if (config.domain.periodic[k] && length > period * (1 - 1e-9))
    return std::numeric_limits<double>::infinity();
  return 0.5 * length;
}

Surface make_box(const Config& config, const WallBody& body, std::uint32_t index) {
  Surface s{SurfaceKind::box, index, 0.5 * (body.min + body.max), {}, {}};
  for (int k = 0; k < 3; ++k) {
    s.axis[k] = unit(k);
    s.half[k] = half_extent(config, body, k);
  }
  return s;
}

Surface make_face(const Config& config, const WallBody& body, std::uint32_t index, int face) {
  const int k = face / 2, u = (k + 1) % 3, w = (k + 2) % 3;
  Surface s{SurfaceKind::rectangle, index, 0.5 * (body.min + body.max), {}, {}};
  const bool upper = face % 2;
  s.centre[k] = upper ? body.max[k] : body.min[k];
  s.axis[2] = unit(k, upper ? -1 : 1);  // into the tank
  s.axis[0] = unit(upper ? w : u);
  s.axis[1] = unit(upper ? u : w);
  s.half[0] = half_extent(config, body, upper ? w : u);
  s.half[1] = half_extent(config, body, upper ? u : w);
  return s;
}

}  // namespace

std::vector<Surface> make_surfaces(const Config& config) {
  std::vector<Surface> surfaces;
  for (std::uint32_t b = 0; b < config.wall.bodies.size(); ++b) {
    const WallBody& body = config.wall.bodies[b];
    if (body.shape == "plane") {
      Surface s{SurfaceKind::plane, b, body.point, {}, {}};
      s.axis[2] = body.normal * (1 / norm(body.normal));
      surfaces.push_back(s);
    } else if (body.shape == "box") {
      surfaces.push_back(make_box(config, body, b));
    } else if (body.shape == "tank") {
      for (int face = 0; face < 6; ++face)
        if (body.faces[face]) surfaces.push_back(make_face(config, body, b, face));
    }
  }
  return surfaces;
}

}  // namespace bedload::inline BL_VARIANT
