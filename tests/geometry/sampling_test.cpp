#include "bedload/geometry/sampling.hpp"

#include "bedload/core/error.hpp"
#include "bedload/geometry/lattice.hpp"
#include "bedload/geometry/shape.hpp"
#include "bedload/geometry/wall_surface.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

constexpr double kSpacing = 0.01, kDepth = 0.03;

DomainConfig unit_domain() { return {{-0.1, -0.1, -0.1}, {1, 1, 1}}; }

std::vector<Vec3d> sample(const WallBody& b, const DomainConfig& domain = unit_domain()) {
  return sample_body(b, kSpacing, kDepth, domain);
}

/// Farthest that a point of a grid over the box min..max, where `in` holds, lies from any particle.
template <class F>
double largest_hole(const std::vector<Vec3d>& points, const Vec3d& min, const Vec3d& max, F in) {
  double worst = 0;
  const int n = 24;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) {
        const Vec3d x{min.x + (max.x - min.x) * i / n, min.y + (max.y - min.y) * j / n,
                      min.z + (max.z - min.z) * k / n};
        if (in(x)) worst = std::max(worst, nearest(points, x));
      }
  return worst;
}

TEST(Tank, ClosesFacesEdgesAndCorners) {
  const auto points = sample(body("tank", {0, 0, 0}, {0.1, 0.08, 0.06}));
  EXPECT_EQ(points.size(), 16u * 14 * 12 - 10 * 8 * 6);  // a block less its hollow
  const auto in_wall = [](const Vec3d& x) {
    return !(x.x > 0 && x.x < 0.1 && x.y > 0 && x.y < 0.08 && x.z > 0 && x.z < 0.06);
  };
  // Within a cubic lattice no place is farther than half a body diagonal from a point.
  EXPECT_LT(largest_hole(points, {-0.03, -0.03, -0.03}, {0.13, 0.11, 0.09}, in_wall), 0.8661 * kSpacing);
  for (const Vec3d& x : points) EXPECT_TRUE(in_wall(x));
  EXPECT_NEAR(closest_pair(points, unit_domain()), kSpacing, 1e-12);
}

TEST(Tank, EndsFlushAtAnOpenFace) {
  WallBody tank = body("tank", {0, 0, 0}, {0.1, 0.08, 0.06});
  tank.faces[5] = false;  // open top
  const auto points = sample(tank);
  EXPECT_EQ(points.size(), 16u * 14 * 9 - 10 * 8 * 6);
  double top = 0;
  for (const Vec3d& x : points) top = std::max(top, x.z);
  EXPECT_NEAR(top, 0.055, 1e-12);
}

TEST(Tank, SpacingFollowsTheSides) {
  const auto points = sample(body("tank", {0, 0, 0}, {0.104, 0.08, 0.06}));
  double first = -1;
  for (const Vec3d& x : points)
    if (x.x < 0) first = std::max(first, x.x);
  EXPECT_NEAR(first, -0.0052, 1e-12);
}

TEST(Tank, HasNoWallAcrossAPeriod) {
  DomainConfig domain{{-0.1, 0, -0.1}, {0.3, 0.08, 0.3}, {false, true, false}};
  const auto points = sample(body("tank", {0, 0, 0}, {0.1, 0.08, 0.06}), domain);
  EXPECT_EQ(points.size(), (16u * 12 - 10 * 6) * 8);
  for (const Vec3d& x : points) {
    EXPECT_GT(x.y, 0);
    EXPECT_LT(x.y, 0.08);
  }
  EXPECT_NEAR(closest_pair(points, domain), kSpacing, 1e-12);
}

TEST(Box, IsFilledToTheDepth) {
  EXPECT_EQ(sample(body("box", {0, 0, 0}, {0.05, 0.2, 0.2})).size(), 5u * 20 * 20);
  EXPECT_EQ(sample(body("box", {0, 0, 0}, {0.2, 0.2, 0.2})).size(), 8000u - 14 * 14 * 14);
}

TEST(Box, IsAsLargeAsItsParticlesTogether) {
  for (const Vec3d& size : {Vec3d{0.033, 0.05, 0.016}, Vec3d{0.0251, 0.047, 0.03}}) {
    const WallBody box = body("box", {0, 0, 0}, size);
    EXPECT_NEAR(double(sample(box).size()) * particle_volume(box, 0.01, {}), size.x * size.y * size.z, 1e-12);
  }
}

TEST(Plane, IsAsLargeAsItsParticlesTogether) {
  const DomainConfig domain{{0, 0, 0}, {0.033, 0.047, 0.2}, {true, true, false}};
  WallBody plane = body("plane", {}, {});
  plane.normal = {0, 0, 2};
  const auto points = sample_body(plane, 0.01, 0.03, domain);
  EXPECT_NEAR(double(points.size()) * particle_volume(plane, 0.01, domain), 0.033 * 0.047 * 0.03, 1e-12);
}

TEST(Box, HasNoEndAcrossAPeriod) {
  DomainConfig domain{{0, 0, 0}, {1, 0.2, 1}, {false, true, false}};
  EXPECT_EQ(sample(body("box", {0, 0, 0}, {0.2, 0.2, 0.2}), domain).size(), (400u - 14 * 14) * 20);
}

TEST(Plane, LiesUnderTheWholeDomain) {
  DomainConfig domain{{0, 0, 0}, {0.2, 0.1, 1}, {true, true, false}};
  WallBody plane = body("plane", {}, {});
  plane.point = {7, 7, 0.02};
  plane.normal = {0, 0, 2};
  const auto points = sample(plane, domain);
  EXPECT_EQ(points.size(), 20u * 10 * 3);
  for (const Vec3d& x : points) {
    EXPECT_LT(x.z, 0.0151);
    EXPECT_TRUE(x.x > 0 && x.x < 0.2 && x.y > 0 && x.y < 0.1);
  }
  EXPECT_NEAR(closest_pair(points, domain), kSpacing, 1e-12);
}

TEST(Plane, TwoOfThemCloseTheirCorner) {
  Config config = empty_case({0.1, 0.1, 0.1});
  config.fluid.h_over_dx = 1.5;
  add_fill(config, {0, 0, 0}, {0.1, 0.1, 0.1});
  WallBody floor = body("plane", {}, {}), side = floor;
  floor.normal = {0, 0, 1};
  side.normal = {1, 0, 0};
  config.wall.bodies = {floor, side};
  const auto setup = setup_of(config);
  EXPECT_LT(largest_hole(setup.walls.x, {-0.03, 0, -0.03}, {0.1, 0.1, 0.1},
                         [](const Vec3d& x) { return x.x < 0 || x.z < 0; }),
            0.8661 * kSpacing);
  EXPECT_NEAR(closest_pair(setup.walls.x, config.domain), kSpacing, 1e-9);
}

TEST(Plane, MayStandAtAnAngle) {
  WallBody plane = body("plane", {}, {});
  plane.normal = {-1, 0, 2};
  DomainConfig domain{{0, 0, 0}, {0.2, 0.1, 0.2}, {false, true, false}};
  const auto points = sample(plane, domain);
  const Vec3d n = plane.normal / norm(plane.normal);
  const auto in_wall = [&](const Vec3d& x) { return dot(x, n) < 0 && dot(x, n) > -kDepth; };
  for (const Vec3d& x : points) EXPECT_TRUE(in_wall(x));
  EXPECT_NEAR(closest_pair(points, domain), kSpacing, 0.05 * kSpacing);
  EXPECT_LT(largest_hole(points, {0, 0, 0}, {0.2, 0.1, 0.1}, in_wall), 0.9 * kSpacing);
}

TEST(Plane, MustRepeatWithThePeriod) {
  WallBody plane = body("plane", {}, {});
  plane.normal = {0, 1, 1};
  DomainConfig domain{{0, 0, 0}, {0.2, 0.1, 0.2}, {false, true, false}};
  EXPECT_THROW(sample(plane, domain), CaseError);
}

TEST(WallDistance, IsNegativeInTheSolid) {
  const DomainConfig domain = unit_domain();
  WallBody tank = body("tank", {0, 0, 0}, {1, 1, 1});
  EXPECT_DOUBLE_EQ(wall_distance(tank, {0.2, 0.5, 0.3}, 0.1, domain), 0.2);
  EXPECT_DOUBLE_EQ(wall_distance(tank, {-0.05, 0.5, 0.3}, 0.1, domain), -0.05);
  EXPECT_LT(wall_distance(tank, {-0.05, -0.05, -0.05}, 0.1, domain), 0);
  tank.faces[0] = false;
  EXPECT_DOUBLE_EQ(wall_distance(tank, {-0.05, 0.5, 0.3}, 0.1, domain), 1.05);  // the face opposite
  EXPECT_EQ(wall_distance(tank, {-0.05, 0.5, 1.3}, 0.1, domain), INFINITY);
  const WallBody box = body("box", {0, 0, 0}, {0.2, 0.2, 0.2});
  EXPECT_DOUBLE_EQ(wall_distance(box, {0.05, 0.1, 0.1}, 0, domain), -0.05);
  EXPECT_DOUBLE_EQ(wall_distance(box, {0.23, 0.24, 0.1}, 0, domain), 0.05);
}

TEST(Walls, BodiesDoNotShareParticles) {
  Config config = empty_case({0.4, 0.2, 0.2});
  add_fill(config, {0, 0, 0}, {0.1, 0.2, 0.1});
  config.wall.bodies = {body("tank", {0, 0, 0}, {0.4, 0.2, 0.2}), body("box", {0.2, 0, 0}, {0.25, 0.2, 0.05}),
                        body("box", {0.22, 0, -0.02}, {0.28, 0.2, 0.05})};
  const auto setup = setup_of(config);
  EXPECT_NEAR(closest_pair(setup.walls.x, config.domain), kSpacing, 1e-9);
  const auto& owners = setup.walls.body;
  const auto count = [&](std::uint32_t b) { return std::count(owners.begin(), owners.end(), b); };
  EXPECT_EQ(count(1), 5 * 20 * 5);
  EXPECT_EQ(count(2), 3 * 20 * 5);  // what the tank and the first box leave of 6 x 20 x 7
}

/// A tank may reach beyond a periodic side, as a box may that crosses it: none of it is there twice, nothing
/// is missing.
TEST(Walls, OfBodiesThatReachBeyondAPeriodAreThereOnce) {
  Config config = empty_case({0.4, 0.2, 0.2});
  config.domain.periodic[1] = true;
  add_fill(config, {0, 0, 0}, {0.1, 0.2, 0.1});
  const auto walls = [&](const WallBody& b) {
    config.wall.bodies = {b};
    return setup_of(config).walls.x;
  };
  const double lo = config.domain.min.y, hi = config.domain.max.y;
  const auto flush = walls(tank({0, lo, 0}, {0.3, hi, 0.2}, "x-x+z-"));
  const auto beyond = walls(tank({0, lo - 1, 0}, {0.3, hi + 1, 0.2}, "x-x+z-"));
  EXPECT_EQ(beyond.size(), flush.size());
  for (const Vec3d& x : beyond) EXPECT_TRUE(x.y > lo && x.y < hi) << x.y;
  EXPECT_EQ(walls(body("box", {0.1, hi - 0.02, 0}, {0.2, hi + 0.03, 0.05})).size(), 10u * 5 * 5);
}

/// A gate that stands in the floor and will leave: the floor is whole without it, in either order.
TEST(Walls, OfBodiesThatMoveApartAreBothWhole) {
  Config config = empty_case({0.4, 0.2, 0.2});
  add_fill(config, {0, 0, 0}, {0.1, 0.2, 0.1});
  const WallBody floor = body("box", {0, 0, -0.03}, {0.4, 0.2, 0});
  WallBody gate = body("box", {0.2, 0, -0.02}, {0.24, 0.2, 0.1});
  const auto particles = [&](const std::vector<WallBody>& bodies, std::size_t of) {
    config.wall.bodies = bodies;
    const auto owners = setup_of(config).walls.body;
    return std::count(owners.begin(), owners.end(), of);
  };
  const auto whole = particles({floor}, 0), alone = particles({gate}, 0);
  EXPECT_LT(particles({floor, gate}, 1), alone) << "both stay";
  const auto expect_whole = [&] {
    EXPECT_EQ(particles({floor, gate}, 0), whole);
    EXPECT_EQ(particles({floor, gate}, 1), alone);
    EXPECT_EQ(particles({gate, floor}, 0), alone);
    EXPECT_EQ(particles({gate, floor}, 1), whole);
  };
  gate.motion.kind = "velocity";
  gate.motion.velocity = {0, 0, 1};
  expect_whole();
  gate.motion = {};
  gate.free.present = true;
  expect_whole();
  gate.free = {};
  gate.motion.kind = "velocity";
  gate.motion.velocity = {1, 0, 0};
  WallBody carried = floor;
  carried.motion = gate.motion;
  EXPECT_LT(particles({carried, gate}, 1), alone) << "both move as one";
}

TEST(Walls, OnlyFluidNeedsThem) {
  Config config = empty_case({0.4, 0.2, 0.2});
  config.wall.bodies = {body("tank", {0, 0, 0}, {0.4, 0.2, 0.2})};
  EXPECT_TRUE(setup_of(config).walls.x.empty());
  add_fill(config, {0, 0, 0}, {0.1, 0.2, 0.1});
  EXPECT_FALSE(setup_of(config).walls.x.empty());
  config.wall.bodies[0].type = "grains_only";
  EXPECT_TRUE(setup_of(config).walls.x.empty());
}

TEST(Walls, WarnOfBodiesThinnerThanTheKernel) {
  Config config = empty_case({0.4, 0.2, 0.2});
  add_fill(config, {0, 0, 0}, {0.1, 0.2, 0.1});
  config.wall.bodies = {body("box", {0.1, 0, 0}, {0.11, 0.2, 0.1})};
  std::vector<std::string> warnings;
  build_setup(config, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(
      warnings[0],
      "wall.body \"box\": its shape \"box\" is 0.01 m thick, less than the kernel's reach of 0.03 m, so "
      "fluid on its two sides would share wall particles; type = \"single_layer\" is meant for thin shells");
}

TEST(SingleLayers, CoverTheSidesOfATank) {
  WallBody tank = body("tank", {0, 0, 0}, {0.1, 0.08, 0.06});
  tank.faces[5] = false;
  const auto points = sample_surface(tank, kSpacing, unit_domain());
  EXPECT_EQ(points.size(), 10u * 8 + 2 * 10 * 6 + 2 * 8 * 6);
  for (const Vec3d& x : points) EXPECT_NEAR(wall_distance(tank, x, kDepth, unit_domain()), 0, 1e-12);
}

TEST(SingleLayers, CoverASphereEvenly) {
  WallBody ball = body("sphere", {}, {});
  ball.solid.shape = make_sphere({0.2, 0.2, 0.2}, 0.1);
  const auto points = sample_surface(ball, kSpacing, unit_domain());
  const double area = 4 * M_PI * 0.01;
  EXPECT_NEAR(double(points.size()), area / (kSpacing * kSpacing), 0.02 * area / (kSpacing * kSpacing));
  for (const Vec3d& x : points) EXPECT_NEAR(norm(x - Vec3d{0.2, 0.2, 0.2}), 0.1, 1e-9);
  EXPECT_GT(closest_pair(points, unit_domain()), 0.7 * kSpacing);
}

TEST(SingleLayers, ThinShellsHaveOneForBothSides) {
  WallBody plate = body("plate", {}, {});
  plate.solid.shape = make_box({0, 0, 0}, {0.2, 0.2, 0.05 * kSpacing});
  const double count = double(sample_surface(plate, kSpacing, unit_domain()).size());
  EXPECT_NEAR(count, 20 * 20, 0.2 * 20 * 20);
}

TEST(Images, LieAcrossTheSurface) {
  const DomainConfig domain = unit_domain();
  const auto expect = [&](const WallBody& b, const Vec3d& x, const Vec3d& on) {
    EXPECT_LT(norm(surface_point(b, x, domain) - on), 1e-12) << b.shape.name();
  };
  expect(body("tank", {0, 0, 0}, {1, 1, 1}), {-0.01, 0.5, -0.02}, {0, 0.5, 0});  // of an edge
  expect(body("box", {0, 0, 0}, {1, 1, 1}), {0.3, 0.98, 0.5}, {0.3, 1, 0.5});
  WallBody plane = body("plane", {}, {});
  plane.point = {0, 0, 0.1}, plane.normal = {0, 0, 2};
  expect(plane, {0.3, 0.4, 0.05}, {0.3, 0.4, 0.1});
  WallBody ball = body("ball", {}, {});
  ball.solid.shape = make_sphere({0, 0, 0}, 0.1);
  expect(ball, {0, 0.08, 0}, {0, 0.1, 0});
}

TEST(Walls, OfMeshesAndShapesAreWarnedOfAsTheyAreThin) {
  Config config = empty_case({0.4, 0.2, 0.2});
  add_fill(config, {0, 0, 0}, {0.1, 0.2, 0.1});
  WallBody pipe = body("baffle", {}, {});
  pipe.solid.shape = make_pipe({0.25, 0.1, 0.05}, {0.25, 0.1, 0.15}, 0.04, 0.045, PipeEnds::open);
  config.wall.bodies = {pipe};
  std::vector<std::string> warnings;
  build_setup(config, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("\"baffle\" is 0.005 m thick"), std::string::npos) << warnings[0];
  config.wall.bodies[0].type = "single_layer";
  config.wall.bodies[0].dx = kSpacing / 2;
  warnings.clear();
  build_setup(config, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("fluid_pairs_through_walls"), std::string::npos) << warnings[0];
  config.wall.bodies[0].solid.shape = make_sphere({0.25, 0.1, 0.1}, 0.08);
  warnings.clear();
  build_setup(config, warnings);
  EXPECT_TRUE(warnings.empty());
}

TEST(SingleLayers, RefuseFluidThatTheyWouldThrowOff) {
  Config config = empty_case({0.4, 0.2, 0.2});
  add_fill(config, {0, 0, 0}, {0.1, 0.2, 0.1});
  WallBody tank = body("tank", {0, 0, 0}, {0.4, 0.2, 0.2});
  tank.type = "single_layer";
  tank.dx = kSpacing / 2;
  config.wall.bodies = {tank};
  try {
    setup_of(config);
    FAIL() << "taken";
  } catch (const CaseError& error) {
    EXPECT_STREQ(
        error.what(),
        "fluid.fill: particles begin 0.005 m from wall.body \"tank\", whose single layer throws off what "
        "is nearer than 0.01 m; let the fill begin 0.005 m from it");
  }
}

}  // namespace
}  // namespace bedload::test
