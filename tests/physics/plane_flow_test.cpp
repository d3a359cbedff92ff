// Plane flows: one layer of particles that stands for the whole length of the domain along y.

#include <gtest/gtest.h>

#include <cmath>

#include "bedload/geometry/shape.hpp"
#include "kernels/smoothing/registry.hpp"
#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kG = 9.81, kDx = 0.01, kLong = 0.37;

/// Still water 0.2 m deep in a tank 0.3 m wide.
Config tank() {
  Config c = periodic_box(8, kDx);
  c.gravity = {0, 0, -kG};
  c.domain.min = {-0.05, -0.1, -0.05};
  c.domain.max = {0.35, -0.1 + kLong, 0.3};
  c.domain.periodic = {false, true, false};
  c.domain.two_d = true;
  c.fluid.c = 10 * std::sqrt(2 * kG * 0.2);
  c.visc.alpha = 0.1;
  c.wall.rep_D = 5 * kG * 0.2;
  c.wall.rep_r0 = kDx / 2;
  c.fluid.fills = {{{0, c.domain.min.y, 0}, {0.3, c.domain.max.y, 0.2}}};
  c.wall.bodies = {test::tank({0, c.domain.min.y, 0}, {0.3, c.domain.max.y, 0.3}, "x-x+z-")};
  c.wall.bodies[0].name = "tank";
  return c;
}

ProbeConfig on_tank(const std::string& type) {
  ProbeConfig p;
  p.name = p.body = "tank";
  p.type = type;
  return p;
}

TEST(PlaneFlow, IsOneLayerThatWeighsAsMuchAsAllOfIt) {
  const Config c = tank();
  std::vector<std::string> warnings;
  const auto setup = build_setup(c, warnings);
  EXPECT_EQ(setup.fluid.x.size(), 30u * 20u);
  double mass = 0;
  for (const double m : setup.fluid.mass) mass += m;
  EXPECT_NEAR(mass / (1000 * 0.3 * 0.2 * kLong), 1, 1e-12);
  for (const auto* places : {&setup.fluid.x, &setup.walls.x})
    for (const Vec3d& x : *places) EXPECT_EQ(x.y, c.domain.middle());
  EXPECT_EQ(setup.walls.x.size(), 3u * (30 + 6) + 2 * 3 * 30u);
}

/// In a drum that is full and turns as a whole the fluid rests beside its wall. With a mean velocity that
/// counted as if it were beside the wall, it would come to turn 5 % faster.
TEST(PlaneFlow, TurnsWithItsVesselAndNoFaster) {
  constexpr double radius = 0.1, turn = 2;  // m, rad/s; ten particles to the radius
  Config c = tank();
  c.gravity = {0, 0, 0};
  c.domain.min = {-0.16, c.domain.min.y, -0.16}, c.domain.max = {0.16, c.domain.max.y, 0.16};
  c.fluid.c = 4;
  c.fluid.mu = 5;  // catches up within a second
  c.visc.alpha = 0;
  c.eos.background = 1000;
  const ShapePtr inside = make_cylinder({0, -1, 0}, {0, 1, 0}, radius);
  WallBody drum = test::shaped("drum", make_hollow(inside, 0.05));
  drum.motion.kind = "rotation";
  drum.motion.axis = {0, 1, 0};
  drum.motion.rate = turn;
  c.wall.bodies = {drum};
  c.fluid.fills = {{c.domain.min, c.domain.max}};
  c.fluid.fills[0].solid.shape = inside;
  auto s = started(c);
  run_until(*s, 3);
  const auto fluid = s->snapshot("fluid");
  const auto x = vectors(fluid, "position"), v = vectors(fluid, "velocity");
  double momentum = 0, inertia = 0;
  for (std::size_t a = 0; a < x.size(); ++a) {
    momentum += x[a].z * v[a].x - x[a].x * v[a].z;
    inertia += square(x[a].z) + square(x[a].x);
  }
  EXPECT_NEAR(momentum / inertia / turn, 1, 0.01);
}

TEST(PlaneFlow, SeesASliceOfAShape) {
  Config c = tank();
  const double radius = 0.05;
  const ShapePtr cylinder = make_cylinder({0.15, -1, 0.1}, {0.15, 1, 0.1}, radius);
  c.wall.bodies.push_back(test::body("cylinder", {0.1, -1, 0.05}, {0.2, 1, 0.15}));
  c.wall.bodies.back().name = "cylinder";
  c.wall.bodies.back().solid.shape = cylinder;
  c.fluid.fills = {{{0, c.domain.min.y, 0}, {0.3, c.domain.max.y, 0.04}}};
  std::vector<std::string> warnings;
  const auto setup = build_setup(c, warnings);
  int count = 0;
  for (std::size_t w = 0; w < setup.walls.x.size(); ++w) {
    if (setup.walls.body[w] != 1) continue;
    ++count;
    EXPECT_EQ(setup.walls.x[w].y, c.domain.middle());
    const double depth = -cylinder->distance(setup.walls.x[w]) / kDx;
    EXPECT_NEAR(depth - std::floor(depth), 0.5, 1e-6);
  }
  // three layers hold what the ring between the radii does
  EXPECT_NEAR(count, M_PI * (radius * radius - 0.02 * 0.02) / (kDx * kDx), 2);
}

TEST(PlaneFlow, LeavesOutTheSliceOfABodyAtAnySpacing) {
  for (const double dx : {0.01, 0.008, 0.00625, 0.005}) {
    Config c = tank();
    c.fluid.dx = c.wall.dx = dx;
    ShapeConfig pile;
    pile.name = "pile", pile.kind = "cylinder";
    pile.solid.shape = make_cylinder({0.15, -1, 0.1}, {0.15, 1, 0.1}, 0.04);
    c.shapes = {pile};
    c.wall.bodies.push_back(test::body("pile", {0.1, -1, 0.05}, {0.2, 1, 0.15}));
    c.wall.bodies.back().shape = "pile", c.wall.bodies.back().solid = pile.solid;
    std::vector<std::string> warnings;
    const auto setup = build_setup(c, warnings);
    const double area = 0.3 * 0.2 - M_PI * 0.04 * 0.04;
    double mass = 0;
    for (const double m : setup.fluid.mass) mass += m;
    EXPECT_NEAR(mass / (1000 * area * kLong), 1, 2e-3) << dx;
    EXPECT_NEAR(double(setup.fluid.x.size()) * dx * dx / area, 1, 0.02)
        << dx << ": places alike stay together";
  }
}

TEST(PlaneFlow, StandsOnItsFloor) {
  auto s = started(tank());
  ProbeConfig floor = on_tank("wall_pressure");
  floor.at = {0.15, 0.085, 0}, floor.normal = {0, 0, 1}, floor.along = {1, 0, 0}, floor.size = {0.1, 1};
  double pressure = 0, force = 0;
  constexpr int instants = 10;
  for (int k = 0; k < instants; ++k) {
    run_until(*s, 0.2 + 0.02 * k);
    pressure += reading(s->measure(floor), "pressure") / instants;
    force += -reading(s->measure(on_tank("force")), "force_by_fluid_z") / instants;
  }
  EXPECT_NEAR(pressure / (1000 * kG * 0.2), 1, 0.02);
  EXPECT_NEAR(force / (1000 * kG * 0.2 * 0.3 * kLong), 1, 0.02);
  for (const Vec3d& x : vectors(s->snapshot("fluid"), "position")) EXPECT_NEAR(x.y, 0.085, 1e-6);
}

/// A shear wave decays as viscosity has it, the second derivative in two dimensions.
TEST(PlaneFlow, HasTheViscosityOfTheFluid) {
  for (const char* model : {"morris", "monaghan"}) {
    const int n = 40;
    Config c = periodic_box(n, kDx);
    c.domain.max.y = 0.05;
    c.domain.two_d = true;
    c.visc.model = model;
    c.fluid.mu = 0.5;
    c.fluid.c = 2;
    const double k = 2 * M_PI / (n * kDx);
    c.fluid.fills = {{c.domain.min, c.domain.max, {"0.01*sin(" + std::to_string(k) + "*z)", "0", "0"}}};
    auto s = started(c);
    const double before = reading(s->diagnostics(), "fluid_kinetic_energy");
    run_until(*s, 1);
    const double after = reading(s->diagnostics(), "fluid_kinetic_energy");
    const double rate = std::log(before / after) / (2 * s->time());
    double along_centres =
        0;  // what a square lattice leaves of it there: sum V 4 F (x z / r)^2, 1 for a fluid
    with_fluid_kernel(c.fluid, c.domain, [&](const auto& w) {
      for (int i = -3; i <= 3; ++i)
        for (int j = -3; j <= 3; ++j)
          if (const double r = kDx * std::hypot(i, j); r > 0)
            along_centres +=
                4 * kDx * kDx * c.domain.max.y * double(w.F(Real(r))) * std::pow(kDx * kDx * i * j / r, 2);
    });
    EXPECT_NEAR(along_centres, 0.886, 0.001);
    const double expected = std::string(model) == "morris" ? 1 : along_centres;
    EXPECT_NEAR(rate / (c.fluid.mu / c.fluid.rho0 * k * k), expected, 0.01) << model;
  }
}

TEST(PlaneFlow, RefusesFluidThatLeavesThePlane) {
  Config c = tank();
  c.fluid.fills[0].velocity[1] = "0.1*x";
  std::vector<std::string> warnings;
  EXPECT_THROW(build_setup(c, warnings), CaseError);
}

}  // namespace
}  // namespace BL_SOLVER
