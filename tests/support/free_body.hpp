#pragma once
// Bodies that move freely, set up in code.

#include "bedload/geometry/body.hpp"
#include "bedload/geometry/shape.hpp"
#include "tests/support/run.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {

/// A case without fluid or grains, in a cube of 2 m.
inline Config void_case() {
  Config c;
  c.domain.min = {-1, -1, -1};
  c.domain.max = {1, 1, 1};
  c.time.end = 10;
  return c;
}

/// What a case file would make of [wall.body.free] with a density, kg/m3.
inline WallBody& set_free(WallBody& b, double density) {
  FreeConfig& f = b.free;
  f.present = true;
  f.density = density;
  f.solid = mass_properties(b);
  const GrainConfig g;
  f.E = g.E, f.nu = g.nu, f.mu = g.mu, f.e = g.e;
  const Vec3d side = b.max - b.min;
  f.contact_spacing = std::min({side.x, side.y, side.z}) / 4;
  return b;
}

inline WallBody ground() {
  WallBody b;
  b.name = "plane", b.shape = WallShape::plane;
  b.normal = {0, 0, 1};
  return b;
}

inline Vec3d vector_of(const std::vector<Quantity>& rows, const std::string& name) {
  return {reading(rows, name + "_x"), reading(rows, name + "_y"), reading(rows, name + "_z")};
}
/// Takes a step; the momentum that pressure.linear_exact gives the fluid in it, by the trapezium rule, N s.
inline Vec3d corrected_in_a_step(Simulation& s) {
  const auto force = [&] { return vector_of(s.diagnostics(), "force_pressure_correction"); };
  const Vec3d before = force();
  const double start = s.time();
  s.step();
  return 0.5 * (s.time() - start) * (before + force());
}
inline Quat<double> rotation_of(const std::vector<Quantity>& rows) {
  const Vec3d u = vector_of(rows, "rotation");
  return {reading(rows, "rotation_w"), u.x, u.y, u.z};
}

}  // namespace BL_SOLVER
