// What surfaces of walls do to fluid and grains beside the pressure of their particles; closed boxes.

#include "tests/boundaries/support.hpp"

namespace BL_SOLVER {
namespace {

/// A block of water that flies into the corner of a closed box at 30 m/s.
std::string jet(const std::string& walls) {
  return R"([domain]
min = [-0.1, 0, -0.1]
max = [0.3, 0.1, 0.3]
two_d = true
[fluid]
dx = 0.005
vmax = 30
[[fluid.fill]]
min = [0.08, 0, 0.08]
max = [0.18, 0.1, 0.18]
velocity = ["-21.2", "0", "-21.2"]
[wall]
)" + walls +
         R"([[wall.body]]
name = "box"
shape = "tank"
min = [0, 0, 0]
max = [0.2, 0.1, 0.2]
faces = ["x-", "x+", "z-", "z+"]
[time]
end = 1
[out]
every = 1
)";
}

TEST(PlaneJet, IntoACornerLeaksNothing) {
  auto s = started(jet(""));
  run_until(*s, 0.03);
  EXPECT_EQ(reading(*s, "lost_fluid_count"), 0);
  for (const Vec3d& x : vectors(s->snapshot("fluid"), "position")) {
    EXPECT_TRUE(x.x > 0 && x.x < 0.2 && x.z > 0 && x.z < 0.2) << x.x << ' ' << x.z;
  }
}

/// Particles that a coarse dam break loses when it strikes the far wall.
double lost(const std::string& walls) {
  auto s = started(R"([domain]
min = [0, 0, -0.1]
max = [1.61, 0.15, 1.2]
two_d = true
[fluid]
dx = 0.02
[[fluid.fill]]
min = [0, 0, 0]
max = [0.6, 0.15, 0.3]
[visc]
alpha = 0.02
[wall]
slip = "slip"
)" + walls + R"([[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [1.61, 0.15, 1.2]
faces = ["x-", "x+", "z-"]
[time]
end = 1
[out]
every = 1
)");
  run_until(*s, 0.6);
  return reading(*s, "lost_fluid_count");
}

TEST(PlaneDamBreak, LeaksNothingWhereItStrikes) {
  EXPECT_EQ(lost(""), 0);
  EXPECT_GT(lost("no_penetration = false\n"), 0) << "pressure alone holds it";
}

/// Force along x (N) of a floor of 0.1 by 0.1 m on the liquid between it and a lid at rest 0.01 m above,
/// before the shear reaches that.
double drag_of(const std::string& floor) {
  auto s = started(R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, -0.005]
max = [0.1, 0.1, 0.015]
periodic = [true, true, false]
two_d = true
[fluid]
dx = 0.001
mu = 1
vmax = 0.1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.1, 0.1, 0.01]
[[wall.body]]
name = "floor"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.1, 0.01]
faces = ["z-"]
)" + floor + R"([[wall.body]]
name = "lid"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.1, 0.01]
faces = ["z+"]
[time]
end = 1
[out]
every = 1
)");
  run_until(*s, 0.005);
  return reading(*s, "force_walls_on_fluid_x");
}

TEST(SlidingSurface, DragsFluidAsAWallThatMoves) {
  const double slides = drag_of("surface_velocity = [0.05, 0, 0]\n");
  const double moves = drag_of("[wall.body.motion]\nkind = \"velocity\"\nvelocity = [0.05, 0, 0]\n");
  EXPECT_NEAR(moves, 0.126, 0.02) << "diffusion into a half-space: mu u / sqrt(pi nu t)";
  EXPECT_NEAR(slides / moves, 1, 0.01);
}

TEST(SlidingSurface, CarriesGrainsAlong) {
  auto s = started(R"([domain]
min = [-0.1, -0.1, -0.01]
max = [0.5, 0.1, 0.1]
[grain]
d = 0.01
E = 1e7
mu = 0.3
[[grain.fill]]
positions = [[0, 0, 0.005]]
[[wall.body]]
name = "belt"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
surface_velocity = [2, 0, 0]
[time]
end = 1
[out]
every = 1
)");
  run_until(*s, 0.05);
  const Vec3d v = vectors(s->snapshot("grains"), "velocity")[0];
  EXPECT_NEAR(v.x, 0.3 * 9.81 * 0.05, 0.03 * 0.3 * 9.81 * 0.05) << "friction carries it while it slips";
}

TEST(ClosedBox, FilledToItsLidStandsUnderItsBackgroundPressure) {
  auto s = started(R"(gravity = [0, 0, 0]
[domain]
min = [-0.05, 0, -0.05]
max = [0.15, 0.1, 0.15]
two_d = true
[fluid]
dx = 0.01
vmax = 1
[eos]
background = 500
[[fluid.fill]]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
[[wall.body]]
name = "box"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
faces = ["x-", "x+", "z-", "z+"]
[time]
end = 1
[out]
every = 1
)");
  run_until(*s, 0.1);
  EXPECT_NEAR(reading(*s, "pressure_min"), 500, 5);
  EXPECT_NEAR(reading(*s, "pressure_max"), 500, 5);
  EXPECT_LT(reading(*s, "fluid_speed_max"), 0.01);
}

}  // namespace
}  // namespace BL_SOLVER
