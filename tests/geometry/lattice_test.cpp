#include "bedload/geometry/lattice.hpp"

#include <numeric>

#include "bedload/geometry/shape.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

TEST(FluidLattice, FillsTheBoxHalfASpacingFromItsSides) {
  Config config = empty_case({1, 1, 1});
  add_fill(config, {0.1, 0, 0}, {0.2, 0.05, 0.03});
  const auto setup = setup_of(config);
  ASSERT_EQ(setup.fluid.x.size(), 10u * 5 * 3);
  EXPECT_NEAR(setup.fluid.x.front().x, 0.105, 1e-12);
  EXPECT_NEAR(setup.fluid.x.back().x, 0.195, 1e-12);
  EXPECT_NEAR(setup.fluid.x.back().z, 0.025, 1e-12);
  EXPECT_NEAR(closest_pair(setup.fluid.x, config.domain), 0.01, 1e-12);
}

TEST(FluidLattice, MassIsExactWhateverTheSpacing) {
  Config config = empty_case({1, 1, 1});
  config.fluid.rho0 = 998;
  add_fill(config, {0, 0, 0}, {0.146, 0.2, 0.0333});
  add_fill(config, {0.5, 0, 0}, {0.6, 0.1, 0.1});
  const auto setup = setup_of(config);
  const double mass = std::accumulate(setup.fluid.mass.begin(), setup.fluid.mass.end(), 0.0);
  EXPECT_NEAR(mass, 998 * (0.146 * 0.2 * 0.0333 + 1e-3), 1e-9);
}

TEST(FluidLattice, RepeatsExactlyWithThePeriod) {
  Config config = empty_case({1, 0.0963, 1});
  config.domain.periodic[1] = true;
  add_fill(config, {0, 0, 0}, {0.02, 0.0963, 0.02});
  const auto setup = setup_of(config);
  ASSERT_EQ(setup.fluid.x.size(), 2u * 10 * 2);
  for (const Vec3d& x : setup.fluid.x) {  // each has a neighbour one step on, across the period too
    double y = x.y + 0.00963;
    if (y > 0.0963) y -= 0.0963;
    EXPECT_LT(nearest(setup.fluid.x, {x.x, y, x.z}), 1e-12);
  }
}

TEST(FluidLattice, WarnsWhereTheBoxIsNoMultiple) {
  Config config = empty_case({1, 1, 1});
  add_fill(config, {0, 0, 0}, {0.1, 0.1, 0.034});
  std::vector<std::string> warnings;
  build_setup(config, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0],
            "fluid.fill 1: 0.034 m along z is not near a multiple of fluid.dx = 0.01 m; "
            "3 layers 0.0113333 m apart are placed");
}

TEST(FluidLattice, VelocityFollowsItsFormulas) {
  Config config = empty_case({1, 1, 1});
  add_fill(config, {0, 0, 0}, {0.1, 0.1, 0.1});
  config.fluid.fills[0].velocity = {"sin(2*pi*x)", "-0.5", "x*y + z^2"};
  const auto setup = setup_of(config);
  for (std::size_t a = 0; a < setup.fluid.x.size(); a += 37) {
    const Vec3d x = setup.fluid.x[a], v = setup.fluid.v[a];
    EXPECT_NEAR(v.x, std::sin(2 * M_PI * x.x), 1e-12);
    EXPECT_EQ(v.y, -0.5);
    EXPECT_NEAR(v.z, x.x * x.y + x.z * x.z, 1e-12);
  }
}

TEST(FluidLattice, RefusesFormulasThatAreNone) {
  Config config = empty_case({1, 1, 1});
  add_fill(config, {0, 0, 0}, {0.1, 0.1, 0.1});
  config.fluid.fills[0].velocity[2] = "2*radius";
  EXPECT_NE(error_of(config).find("fluid.fill.velocity = \"2*radius\" along z"), std::string::npos)
      << error_of(config);
  EXPECT_NE(error_of(config).find("radius", 45), std::string::npos);
  config.fluid.fills[0].velocity[2] = "1/(x-0.005)";
  EXPECT_EQ(error_of(config),
            "fluid.fill.velocity = \"1/(x-0.005)\" along z must be finite; it is not at (0.005, 0.005, "
            "0.005) m");
}

TEST(FluidLattice, RefusesFluidOutsideTheDomain) {
  Config config = empty_case({1, 1, 0.25});
  add_fill(config, {0, 0, 0}, {0.1, 0.1, 0.3});
  EXPECT_EQ(error_of(config),
            "fluid.fill 1: its box runs from z = 0 to 0.3 m, the domain only from 0 to 0.25 m");
}

TEST(FluidLattice, RefusesFillsThatOverlap) {
  Config config = empty_case({1, 1, 1});
  add_fill(config, {0, 0, 0}, {0.1, 0.1, 0.1});
  add_fill(config, {0.1, 0, 0}, {0.2, 0.1, 0.1});
  EXPECT_EQ(error_of(config), "");
  add_fill(config, {0.15, 0.05, 0.05}, {0.3, 0.1, 0.1});
  EXPECT_EQ(error_of(config), "fluid.fill 3 overlaps fluid.fill 2");
}

TEST(FluidLattice, RefusesShapesThatOverlap) {
  Config config = empty_case({1, 1, 1});
  config.fluid.dx = 0.02;
  const auto add_shape = [&](ShapePtr shape, double level = INFINITY) {
    FluidFill fill{shape->bounds().min, shape->bounds().max};
    fill.solid.shape = shape;
    fill.level = level;
    config.fluid.fills.push_back(fill);
  };
  add_fill(config, {0.2, 0.2, 0.2}, {0.4, 0.4, 0.4});
  add_shape(make_box({0.2, 0.2, 0.4}, {0.4, 0.4, 0.5}));  // on top of the box
  add_shape(make_sphere({0.5, 0.5, 0.3}, 0.13), 0.3);     // apart, though its bounds meet the box'
  EXPECT_EQ(error_of(config), "");
  auto& fills = config.fluid.fills;
  fills.pop_back();
  add_shape(make_sphere({0.5, 0.5, 0.3}, 0.17), 0.3);
  EXPECT_TRUE(error_of(config).starts_with("fluid.fill 3 overlaps fluid.fill 1 at (0.3")) << error_of(config);
  fills.pop_back();
  add_shape(make_sphere({0.3, 0.3, 0.45}, 0.04));  // within the second
  EXPECT_TRUE(error_of(config).starts_with("fluid.fill 3 overlaps fluid.fill 2 at (")) << error_of(config);
}

TEST(FluidLattice, RefusesMoreParticlesThanIdsBeforeMakingThem) {
  Config config = empty_case({20, 20, 20});
  add_fill(config, {0, 0, 0}, {20, 20, 20});
  EXPECT_EQ(error_of(config), "fluid.dx = 0.01 m makes 8e+09 fluid particles: must be fewer than 2^31");
}

TEST(FluidLattice, LeavesOutBodiesThatStandInIt) {
  Config config = empty_case({1, 1, 1});
  add_fill(config, {0, 0, 0}, {0.1, 0.1, 0.1});
  config.wall.bodies = {body("box", {0.08, -0.1, -0.1}, {0.2, 0.2, 0.2})};
  std::vector<std::string> warnings;
  std::vector<std::string> notes;
  struct Setup setup = build_setup(config, warnings, &notes);
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0], "fluid.fill 1: leaves out wall.body \"box\", 200 of 1000 particles");
  ASSERT_EQ(setup.fluid.x.size(), 800u);
  double mass = 0;
  for (std::size_t a = 0; a < setup.fluid.x.size(); ++a) {
    mass += setup.fluid.mass[a];
    EXPECT_LT(setup.fluid.x[a].x, 0.0755);
  }
  EXPECT_NEAR(mass, 0.8, 1e-3);

  ShapeConfig ball;
  ball.name = "ball", ball.kind = "sphere";
  ball.solid.shape = make_sphere({0.05, 0.05, 0.05}, 0.03);
  config.shapes = {ball};
  config.wall.bodies[0].shape = "ball", config.wall.bodies[0].solid = ball.solid;
  setup = build_setup(config, warnings);
  mass = 0;
  for (std::size_t a = 0; a < setup.fluid.x.size(); ++a) {
    mass += setup.fluid.mass[a];
    EXPECT_GT(ball.solid.shape->distance(setup.fluid.x[a]), 0.0045);
  }
  EXPECT_NEAR(mass, 1 - 4e3 / 3 * M_PI * 0.03 * 0.03 * 0.03, 2e-3);

  config.shapes[0].kind = "hollow";  // may be meant to hold it
  EXPECT_NE(error_of(config).find("inside wall.body"), std::string::npos);
}

TEST(FluidLattice, RefusesFluidInsideASolid) {
  Config config = empty_case({1, 1, 1});
  add_fill(config, {0, 0, 0}, {0.1, 0.1, 0.1});
  config.wall.bodies = {body("tank", {0.01, 0, 0}, {0.5, 0.5, 0.5})};
  EXPECT_NE(error_of(config).find("inside wall.body \"tank\""), std::string::npos);
  config.wall.bodies[0].faces[0] = false;  // open towards x-
  EXPECT_EQ(error_of(config), "");
}

}  // namespace
}  // namespace bedload::test
