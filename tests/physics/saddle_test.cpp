// A grain, or a free ball, rolls off the saddle between two larger ones: friction of unlike sizes in whole
// runs.

#include <gtest/gtest.h>

#include "tests/geometry/mesh_support.hpp"
#include "tests/support/free_body.hpp"
#include "tests/support/saddle.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kStart = 5;  // degrees from the top
constexpr Saddle kSaddle{0.25e-3, 5};

/// A case with gravity and with grains that grip.
Config gripping() {
  Config c = void_case();
  c.domain.min = {-0.02, -0.02, -0.02}, c.domain.max = {0.02, 0.02, 0.02};
  c.gravity = {0, 0, -Saddle::kG};
  c.contact.rolling = "none";
  c.grain.d = c.grain.d_min = c.grain.d_max = 2 * kSaddle.R;
  c.grain.mu = 5, c.grain.e = 0.5;
  return c;
}
void add(bedload::Setup& setup, const Vec3d& x, double radius, std::uint32_t fill) {
  setup.grains.x.push_back(x), setup.grains.v.push_back({});
  setup.grains.radius.push_back(radius);
  setup.grains.fill.push_back(fill);
}
WallBody fixed_sphere(int side) {
  return test::shaped("sphere " + std::to_string(side),
                      make_sphere(kSaddle.large(side), kSaddle.ratio * kSaddle.R));
}
/// The same of triangles, whose neighbours lean 3 degrees.
WallBody fixed_mesh(int side) {
  TriangleSoup soup = test::ball(5);
  for (Vec3d& x : soup.vertices) x *= kSaddle.ratio * kSaddle.R;
  soup = test::moved(soup, kSaddle.large(side));
  return test::shaped("mesh " + std::to_string(side), std::make_shared<TriangleMesh>(soup, "ball"));
}
constexpr double kOnTriangles = 4;  ///< that they change the angle by, degrees

/// Runs until it has fallen below the saddle; the angle at which it left.
template <class Where, class Velocity>
double released(Simulation& s, Where&& where, Velocity&& velocity) {
  while (s.time() < 1 && kSaddle.gap(where()) < 2 * kSaddle.R) s.step();
  EXPECT_GE(kSaddle.gap(where()), 2 * kSaddle.R) << "it sticks";
  return kSaddle.released(velocity().x);
}
double released_grain(Simulation& s) {
  return released(
      s, [&] { return vectors(s.snapshot("grains"), "position")[0]; },
      [&] { return vectors(s.snapshot("grains"), "velocity")[0]; });
}

TEST(Saddle, AGrainRollsOffTwoLargerGrains) {
  Config c = gripping();
  c.grain.present = true;
  c.grain.d_max = 2 * kSaddle.R * kSaddle.ratio;
  c.grain.fills.resize(2);
  RigidConfig& fixed = c.grain.fills[1].rigid;
  fixed.present = true, fixed.move = "none", fixed.turn = "none";
  bedload::Setup setup;
  add(setup, kSaddle.start(kStart), kSaddle.R, 0);
  for (const int side : {0, 1}) add(setup, kSaddle.large(side), kSaddle.ratio * kSaddle.R, 1);
  auto s = started(c, setup);
  EXPECT_NEAR(released_grain(*s), kSaddle.release(kStart), 1);
}

double off_walls(WallBody (*wall)(int)) {
  Config c = gripping();
  c.grain.present = true;
  c.wall.bodies = {wall(0), wall(1)};
  bedload::Setup setup;
  add(setup, kSaddle.start(kStart), kSaddle.R, 0);
  auto s = started(c, setup);
  return released_grain(*s);
}
TEST(Saddle, AGrainRollsOffTwoWalls) {
  EXPECT_NEAR(off_walls(fixed_sphere), kSaddle.release(kStart), 1);
  EXPECT_NEAR(off_walls(fixed_mesh), kSaddle.release(kStart), kOnTriangles);
}

double ball_off_walls(WallBody (*wall)(int)) {
  Config c = gripping();
  WallBody ball = test::shaped("ball", make_sphere(kSaddle.start(kStart), kSaddle.R));
  set_free(ball, c.grain.rho);
  ball.free.mu = 5, ball.free.e = 0.5;
  ball.free.balls = {{kSaddle.start(kStart), kSaddle.R}};
  c.wall.bodies = {wall(0), wall(1), ball};
  auto s = started(c);
  return released(
      *s, [&] { return vector_of(s->body_state(2), "centre"); },
      [&] { return vector_of(s->body_state(2), "velocity"); });
}
TEST(Saddle, AFreeBallRollsOffTwoWalls) {
  EXPECT_NEAR(ball_off_walls(fixed_sphere), kSaddle.release(kStart), 1);
  EXPECT_NEAR(ball_off_walls(fixed_mesh), kSaddle.release(kStart), kOnTriangles);
}

}  // namespace
}  // namespace BL_SOLVER
