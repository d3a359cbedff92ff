// Bodies that move freely: what follows from their shapes.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bedload/core/error.hpp"
#include "bedload/geometry/body.hpp"
#include "resolve.hpp"

namespace bedload {

void resolve_free_bodies(Config& c, const Value& root) {
  for (std::size_t i = 0; i < c.wall.bodies.size(); ++i) {
    WallBody& body = c.wall.bodies[i];
    FreeConfig& f = body.free;
    if (!f.present) continue;
    const std::string path = fmt::format("wall.body.{}.free", i), place = nearest_value(root, path).place();
    const auto sized = [&](const char* key, std::vector<double>& list, std::size_t size) {
      if (!list.empty() && list.size() != size)
        reject(root, path + key, fmt::format("[{}]", fmt::join(list, ", ")),
               fmt::format("must hold {} numbers", size));
    };
    sized(".centre_of_mass", f.centre_of_mass, 3);
    sized(".inertia", f.inertia, 6);
    sized(".point", f.point, 3);
    if (body.shape == WallShape::plane)
      reject(root, fmt::format("wall.body.{}.shape", i), "\"plane\"", "must not move freely; it has no end");
    if ((f.density > 0) + (f.mass > 0) != 1)
      throw CaseError(fmt::format("{}: wall.body.free must have exactly one of density and mass", place));
    if (body.motion.moves())
      throw CaseError(
          fmt::format("{}: wall.body \"{}\" must have only one of motion and free", place, body.name));
    f.axis = direction(f.axis, root, path + ".axis");
    try {
      f.solid = mass_properties(body, c.domain);
    } catch (const CaseError& error) {
      throw CaseError(fmt::format("{}: wall.body.free {}", place, error.what()));
    }
    const PrincipalInertia p = principal_inertia(f.solid.inertia);
    const double sum = p.moments.x + p.moments.y + p.moments.z;
    for (int k = 0; k < 3; ++k)
      if (!(p.moments[k] > 0 && 2 * p.moments[k] <= sum * (1 + 1e-9)))
        reject(root, path + ".inertia", fmt::format("[{}]", fmt::join(f.solid.inertia, ", ")),
               "must be of a solid: principal moments above 0, none above the sum of the other two");
    const GrainMaterial of = c.grain.all_materials()[c.grain.material(body.material)];
    if (f.E == 0) f.E = of.E;
    if (std::isinf(f.nu)) f.nu = of.nu;
    if (std::isinf(f.mu)) f.mu = of.mu;
    if (f.e == 0) f.e = of.e;
    if (!f.balls.empty() && f.contact_spacing > 0)
      throw CaseError(
          fmt::format("{}: wall.body.free must have only one of contact and contact_spacing", place));
    if (f.contacts && f.balls.empty() && f.contact_spacing == 0) {
      const std::vector<Vec3d> at = corners(body, c.domain);
      const Vec3d side = at.back() - at.front();
      const double least = std::min({side.x, c.domain.two_d ? side.x : side.y, side.z});
      f.contact_spacing = std::max(least / 4, norm(side) / 60);
    }
  }
}

}  // namespace bedload
