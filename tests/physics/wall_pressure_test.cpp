// Patches on walls against the force on the whole body and against hydrostatic pressure; the parts of that
// force.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/run.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kG = 9.81, kDx = 0.01;

ProbeConfig on(const std::string& body, const std::string& type) {
  ProbeConfig p;
  p.name = p.body = body;
  p.type = type;
  return p;
}

ProbeConfig patches(const std::string& body, const Vec3d& at, const Vec3d& normal, const Vec3d& along,
                    const std::vector<double>& size, const std::vector<double>& count = {}) {
  ProbeConfig p = on(body, "wall_pressure");
  p.at = at, p.normal = normal, p.along = along, p.size = size, p.count = count;
  return p;
}

Vec3d vector(const std::vector<Quantity>& rows, const std::string& name) {
  return {reading(rows, name + "_x"), reading(rows, name + "_y"), reading(rows, name + "_z")};
}

WallBody named(const std::string& name, WallBody body) {
  body.name = name;
  return body;
}

/// Water as deep as it is wide, without its walls.
Config water() {
  Config c = periodic_box(8, kDx);
  c.gravity = {0, 0, -kG};
  c.domain.periodic = {true, true, false};
  c.domain.max.z = 0.12;
  c.fluid.c = 15;
  c.visc.alpha = 0.1;
  c.wall.rep_D = 5 * kG * 0.08;
  c.wall.rep_r0 = kDx;  // acts on the first layer
  c.wall.layer_r0 = kDx;
  c.fluid.fills = {{c.domain.min, {0.08, 0.08, 0.08}}};
  return c;
}

void steps(Simulation& s, int n) {
  for (int k = 0; k < n; ++k) s.step();
}

class SmallPatches : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Each, SmallPatches,
                         testing::Values("adami", "mdbc", "frozen", "kajtar", "monaghan"));

TEST_P(SmallPatches, OfAFloorThatMovesAddUpToItsWholeForce) {
  Config c = water();
  c.wall.bodies = {named("floor", test::tank(c.domain.min, c.domain.max, "z-"))};
  WallBody& floor = c.wall.bodies[0];
  const std::string kind = GetParam();
  const bool layer = kind == "kajtar" || kind == "monaghan";
  floor.type = layer ? "single_layer" : kind;
  if (layer)
    floor.force = kind, floor.dx = kDx / 2, floor.repulsion = false, c.fluid.fills[0].min.z = kDx / 2;
  floor.motion.kind = "velocity";
  floor.motion.velocity = {0.3, 0.17, 0};
  auto s = started(c);
  steps(*s, 20);  // patches now run through the period
  for (const std::vector<double>& count : {std::vector<double>{2, 3}, {1, 1}, {4, 5}}) {
    const auto p = s->measure(patches("floor", {0.04, 0.04, 0}, {0, 0, 1}, {1, 0, 0}, {0.08, 0.08}, count));
    ASSERT_EQ(p.size(), count[0] * count[1]);
    double sum = 0;
    for (const Quantity& q : p) sum += q.value * 0.08 * 0.08 / double(p.size());
    const double whole = -reading(s->measure(on("floor", "force")), "force_by_fluid_z");
    EXPECT_GT(whole, 0.3 * 1000 * kG * 0.08 * 0.08 * 0.08);
    EXPECT_NEAR(sum / whole, 1, 1e-12);
  }
}

TEST(SmallPatch, RidesOnABodyThatTurns) {
  Config c = water();
  c.domain.periodic = {false, false, false};
  c.domain.min = {-0.04, -0.04, -0.04};
  c.domain.max = {0.12, 0.12, 0.12};
  c.wall.bodies = {named("tank", test::tank({0, 0, 0}, {0.08, 0.08, 0.1}, "x-x+y-y+z-")),
                   named("plate", test::body("box", {0.02, 0.02, 0.04}, {0.06, 0.06, 0.06}))};
  c.fluid.fills = {{{0, 0, 0}, {0.08, 0.08, 0.04}}, {{0, 0, 0.06}, {0.08, 0.08, 0.09}}};
  MotionConfig& motion = c.wall.bodies[1].motion;
  motion.kind = "rotation";
  motion.axis = {0.6, 0, 0.8};
  motion.centre = {0.04, 0.04, 0.05};
  motion.rate = 20;
  auto s = started(c);
  run_until(*s, 0.02);
  // larger than the plate and deep enough for all of it: across its plane, all that the fluid does to it
  const Vec3d normal{0, 0, 1};
  const auto p = s->measure(patches("plate", {0.04, 0.04, 0.06}, normal, {1, 0, 0}, {0.1, 0.1}));
  const Vec3d now = Quat<double>::from_rotation(20 * s->time() * motion.axis).rotate(normal);
  EXPECT_LT(now.z, 0.98);
  const Vec3d force = vector(s->measure(on("plate", "force")), "force_by_fluid");
  EXPECT_GT(std::abs(dot(force, now)), 1e-2);
  EXPECT_NEAR(reading(p, "pressure") * 0.01 / -dot(force, now), 1, 1e-9);
}

TEST(SlowPatches, FeelHydrostaticPressure) {
  Config c = water();
  const double depth = 0.12, wide = 0.16;
  c.domain.periodic = {false, true, false};
  c.domain.min = {-0.05, 0, -0.05};
  c.domain.max = {wide + 0.05, 0.08, 0.16};
  c.fluid.c = 10 * std::sqrt(2 * kG * depth);
  c.wall.rep_D = 5 * kG * depth;
  c.wall.rep_r0 = kDx / 2;
  c.fluid.fills = {{{0, 0, 0}, {wide, 0.08, depth}}};
  c.wall.bodies = {named("tank", test::tank({0, 0, 0}, {wide, 0.08, 0.16}, "x-x+z-"))};
  auto s = started(c);
  ProbeConfig disc = patches("tank", {0.08, 0.04, 0}, {0, 0, 1}, {1, 0, 0}, {});
  disc.radius = 0.02;
  const ProbeConfig floor = patches("tank", {0.08, 0.04, 0}, {0, 0, 1}, {1, 0, 0}, {0.08, 0.08});
  const ProbeConfig left = patches("tank", {0, 0.04, 0.06}, {1, 0, 0}, {0, 1, 0}, {0.08, 0.04}, {1, 2});
  const ProbeConfig right = patches("tank", {wide, 0.04, 0.06}, {-1, 0, 0}, {0, -1, 0}, {0.08, 0.04}, {1, 2});
  double on_disc = 0, on_floor = 0, lower[2] = {}, upper[2] = {};
  constexpr int instants = 20;
  for (int k = 0; k < instants; ++k) {
    run_until(*s, 0.3 + 0.02 * k);
    on_disc += reading(s->measure(disc), "pressure") / instants;
    on_floor += reading(s->measure(floor), "pressure") / instants;
    for (int side = 0; side < 2; ++side) {
      const auto p = s->measure(side == 0 ? left : right);
      lower[side] += reading(p, "pressure_0") / instants;
      upper[side] += reading(p, "pressure_1") / instants;
    }
  }
  const double full = 1000 * kG * depth;
  EXPECT_NEAR(on_floor / full, 1, 0.02);
  EXPECT_NEAR(on_disc / full, 1, 0.02);
  for (int side = 0; side < 2; ++side) {
    EXPECT_NEAR(lower[side] / (1000 * kG * 0.07), 1, 0.02) << side;
    EXPECT_NEAR(upper[side] / (1000 * kG * 0.05), 1, 0.02) << side;
  }
}

TEST(SmallForceProbe, TellsPressureFromFriction) {
  for (const char* slip : {"noslip", "slip"}) {
    Config c = water();
    c.visc.alpha = 0;
    c.wall.bodies = {named("floor", test::tank(c.domain.min, c.domain.max, "z-"))};
    c.wall.bodies[0].slip = slip;
    c.wall.bodies[0].motion.kind = "velocity";
    c.wall.bodies[0].motion.velocity = {0.5, 0, 0};
    auto s = started(c);
    steps(*s, 5);
    const auto f = s->measure(on("floor", "force"));
    const Vec3d all = vector(f, "force_by_fluid"), pressure = vector(f, "pressure_force"),
                friction = vector(f, "friction_force");
    EXPECT_LT(norm(all - pressure - friction), 1e-12 * norm(all));
    EXPECT_LT(pressure.z, -0.3 * 1000 * kG * 0.08 * 0.08 * 0.08);
    if (std::string(slip) == "slip")
      EXPECT_EQ(friction, Vec3d{});
    else
      EXPECT_LT(friction.x,
                -1e-3 * 0.5 / (2 * kDx) * 0.08 * 0.08);  // mu du/dz A of a layer two spacings deep
  }
}

}  // namespace
}  // namespace BL_SOLVER
