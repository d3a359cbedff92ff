// What fluid does to walls and walls to fluid.

#include <gtest/gtest.h>

#include <random>

#include "kernels/fluid/layer_force.hpp"
#include "kernels/fluid/wall_density.hpp"
#include "kernels/fluid/wall_pass.hpp"
#include "kernels/smoothing/wendland_c2.hpp"
#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

/// One wall particle at the origin and the pass that gives it its state.
struct LoneWall {
  std::vector<Vec3d> x = std::vector<Vec3d>(1);
  std::vector<std::uint32_t> body = {0};
  std::vector<BodyPose> pose = std::vector<BodyPose>(1);
  std::vector<VelocityDensity<>> v_rho = std::vector<VelocityDensity<>>(1);
  std::vector<NoSlip<>> no_slip = std::vector<NoSlip<>>(1);
  std::vector<WallState<>> state = std::vector<WallState<>>(1);
  std::vector<Real> compression = std::vector<Real>(1);

  LoneWall() { pose[0].volume = 1e-3; }

  /// Beside fluid of this velocity and density, and state.
  WallPass<WendlandC2> pass(const std::vector<VelocityDensity<>>& v, const std::vector<EosState<>>& m,
                            const Vec3d& gravity) {
    const auto in = [](const auto& host) { return Span(host.data(), Index(host.size())); };
    const auto out = [](auto& host) { return Span(host.data(), Index(host.size())); };
    return {.w = WendlandC2(0.1),
            .eos = {Real(1e7), 7, 0, 1000, false},
            .fluid = {in(v), in(m)},
            .drag_kick = {},
            .rate = 0,
            .x0 = in(x),
            .bodies = {in(body), in(pose)},
            .gravity = Real3(gravity),
            .least_sum = Real(1e-3),
            .v_rho = out(v_rho),
            .no_slip = out(no_slip),
            .state = out(state),
            .compression = out(compression)};
  }
};

/// Pressure that one wall particle at the origin takes from fluid above it whose pressure is
/// 500 Pa + rho0 push . x and whose velocity is v_fluid.
double extrapolated(const Vec3d& gravity, const RigidMotion& wall, const Vec3d& push,
                    const Vec3d& v_fluid = {}) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-0.1, 0.1);
  std::vector<VelocityDensity<>> v;
  std::vector<EosState<>> m;
  std::vector<Vec3d> at;
  for (int a = 0; a < 60; ++a) {
    at.push_back({u(rng), u(rng), 0.1 + u(rng)});
    const double p = 500 + 1000 * dot(push, at.back());
    v.push_back({Real3(v_fluid), Real(1000)});
    m.push_back({Real(1e-3), Real(p / 1e6), Real(1000), 1});
  }
  LoneWall lone;
  static_cast<RigidMotion&>(lone.pose[0]) = wall;
  const auto pass = lone.pass(v, m, gravity);
  auto sum = pass.start(0);
  for (int a = 0; a < 60; ++a) {
    const Real3 r = Real3(-at[a]);
    if (norm2(r) < Real(0.04)) pass.pair(sum, r, norm2(r), m[a].mass_over_eps, v[a], m[a], Real3());
  }
  pass.finish(0, sum);
  return lone.state[0].p_over_rho2 * square(lone.v_rho[0].rho);
}

TEST(Walls, TakeALinearPressureExactly) {  // T-11
  const Vec3d g{1, -2, -9.81};
  EXPECT_NEAR(extrapolated(g, {}, g), 500, 500 * 10 * kInvariant);
  RigidMotion wall;
  wall.a = {-3, 0.5, 4};  // an accelerated wall sees g - a
  EXPECT_NEAR(extrapolated(g, wall, g - wall.a), 500, 500 * 10 * kInvariant);
}

TEST(Walls, ThatTurnSeeFluidOnACircleAsFarAsItTurnsAlong) {
  const Vec3d g{0, 0, -9.81};
  RigidMotion drum;
  drum.centre = {-1, 0, 0};
  drum.omega = {0, 0, 10};
  for (double fraction : {0.0, 0.5, 1.0, 1.5})
    EXPECT_NEAR(extrapolated(g, drum, g - Vec3d{-100 * std::min(fraction * fraction, 1.0), 0, 0},
                             {0, 10 * fraction, 3}),
                500, 500 * 20 * kInvariant)
        << fraction;
}

TEST(Walls, FallingFreelyTakeTheMeanPressure) {  // T-11: a_w = g
  const Vec3d g{0, 0, -9.81};
  RigidMotion wall;
  wall.a = g;
  EXPECT_NEAR(extrapolated(g, wall, {}), 500, 500 * kInvariant);
}

TEST(Walls, AreAsHeavyAsFluidThatFillsThem) {
  const std::vector<VelocityDensity<>> v{{Real3(), Real(1000)}};
  const std::vector<EosState<>> m{{Real(1e-3), Real(2e4 / 1e6), Real(1000), Real(0.4)}};
  LoneWall lone;
  const auto mass = [&](bool near) {
    const auto pass = lone.pass(v, m, {});
    auto sum = pass.start(0);
    if (near) pass.pair(sum, Real3(Real(0.05), 0, 0), Real(0.0025), m[0].mass_over_eps, v[0], m[0], Real3());
    pass.finish(0, sum);
    return double(lone.state[0].mass);
  };
  const double rho = 1000 * std::pow(1 + 2e4 / 1e7, 1.0 / 7);  // at 20 kPa
  EXPECT_NEAR(mass(true), 1e-3 * rho, 1e-5) << "whatever the porosity beside it";
  EXPECT_EQ(mass(false), 0) << "dry";
}

/// What a mirrored particle finds about its image in fluid of density rho0 (1 + field).
template <class Field>
double mirrored(const std::vector<Vec3d>& at, const Vec3d& x, const Vec3d& image, const Field& field) {
  std::vector<VelocityDensity<>> v;
  std::vector<EosState<>> m;
  for (const Vec3d& place : at) {
    v.push_back({Real3(), Real(1000)});
    m.push_back({Real(0.42), 0, Real(1000 * (1 + field(place))), 0});  // 150 fill what holds them
  }
  const auto in = [](const auto& host) { return Span(host.data(), Index(host.size())); };
  const std::vector<Vec3d> place{x}, images{image};
  const std::vector<std::uint32_t> body{0};
  std::vector<BodyPose> pose(1);
  pose[0].kind = WallKind::mirrored;
  std::vector<Real> compression(1);
  const MirrorPass<WendlandC2> pass{.w = WendlandC2(0.15),
                                    .frame = {{-9, -9, -9}, {9, 9, 9}, false, false, false},
                                    .rho0 = 1000,
                                    .least = Real(-0.5),
                                    .least_sum = Real(1e-3),
                                    .fluid = {in(v), in(m)},
                                    .x = in(place),
                                    .image = in(images),
                                    .bodies = {in(body), in(pose)},
                                    .compression = Span(compression.data(), 1)};
  auto sum = pass.start(0);
  for (std::size_t a = 0; a < at.size(); ++a) {
    const Real3 r = Real3(image - at[a]);
    if (norm2(r) < Real(0.09)) pass.pair(sum, r, norm2(r), m[a].mass_over_eps, v[a], m[a]);
  }
  pass.finish(0, sum);
  return compression[0];
}

TEST(Walls, MirrorALinearDensityExactly) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> u(-0.25, 0.25);
  std::vector<Vec3d> at;
  for (int a = 0; a < 150; ++a) at.push_back({u(rng), u(rng), std::abs(u(rng))});
  const Vec3d slope{0.02, -0.03, 0.05}, wall{0.01, 0.02, -0.08}, image{0.01, 0.02, 0.08};
  const auto linear = [&](const Vec3d& x) { return 0.01 + dot(slope, x); };
  EXPECT_NEAR(mirrored(at, wall, image, linear), linear(wall), tolerance(1e-10, 1e-5, 1e-5));
}

TEST(Walls, MirrorTheMeanWhereFluidSaysNothingOfItsSlope) {
  const std::vector<Vec3d> at{{0.1, 0, 0}, {-0.1, 0, 0}};  // on a line
  const auto field = [](const Vec3d& x) { return 0.02 + x.x; };
  EXPECT_NEAR(mirrored(at, {0, 0, -0.05}, {}, field), 0.02, 1e-6);
  EXPECT_EQ(mirrored({}, {0, 0, -0.05}, {}, field), double(kNoCompression));
}

/// One over the integral of F |z|: 2/3 h for Wendland's function, 3 pi/14 h in a plane flow of any thickness.
TEST(Walls, OfOneLayerStandForTheDepthThatCarriesShear) {
  EXPECT_NEAR(layer_depth(WendlandC2(0.15)), 0.1, 1e-5);
  EXPECT_NEAR(layer_depth(WendlandC2(0.15, 0.4)), 3 * M_PI / 14 * 0.15, 1e-5);
}

TEST(Walls, OfOneLayerPushAsMonaghanAndKajtarSay) {
  // q = 1: W = 1.77 / 32 (1 + 5/2 + 2)
  EXPECT_NEAR(SoftRepulsion({3, Real(0.2)})(Real(0.2)), 3 * 1.77 / 32 * 5.5 / 0.2, 1e-5);
  EXPECT_EQ(SoftRepulsion({3, Real(0.2)})(Real(0.4)), 0);
  const LayerLaw steep{{Real(2), Real(0.1), Real(1e30)}, {}};
  EXPECT_NEAR(steep(Real(0.05)), 2 * (16 - 4) / 0.05, 1e-3);
}

/// Water thrown into the corner of a tank, periodic across.
Config thrown() {
  Config c = periodic_box(8, 0.01);
  c.gravity = {0, 0, -9.81};
  c.domain.periodic = {false, true, false};
  c.domain.min = {-0.05, 0, -0.05};
  c.domain.max = {0.25, 0.08, 0.25};
  c.visc.alpha = 0.02;
  c.density.delta = 0.1;
  c.wall.rep_D = 4;
  c.fluid.fills = {{{0, 0, 0}, {0.06, 0.08, 0.08}, {"-2", "0", "-1"}}};
  c.wall.bodies = {test::tank({0, 0, 0}, {0.2, 0.08, 0.2}, "x-x+z-z+")};
  return c;
}

TEST(SmallWalls, TakeWhatTheFluidGives) {  // T-17: sum of forces, repulsion among them
  auto s = started(thrown());
  double largest = 0;
  for (int k = 0; k < 40; ++k) {
    s->step();
    if (k % 10 != 9) continue;
    const auto d = s->diagnostics();
    const double scale =
        std::abs(reading(d, "force_walls_on_fluid_x")) + std::abs(reading(d, "force_walls_on_fluid_z"));
    largest = std::max(largest, scale);  // what has rebounded presses no more
    for (const char* axis : {"x", "y", "z"})
      EXPECT_LT(std::abs(reading(d, std::string("fluid_force_residual_") + axis)) / largest, 10 * kInvariant)
          << axis;
  }
  EXPECT_GT(largest, 10 * 9.81 * 0.384) << "no impact";
}

WallBody slab(const char* name, const Vec3d& min, const Vec3d& max, double rise) {
  WallBody b;
  b.name = name;
  b.shape = "box";
  b.min = min;
  b.max = max;
  b.slip = "slip";
  b.motion.kind = "velocity";
  b.motion.velocity = {0, 0, rise};
  return b;
}

/// How much higher resting water comes to stand beside a wall that goes down than beside one that goes up, m;
/// it is 0.12 m deep.
double lifted_by_sliding_walls(double shift) {
  Config c = periodic_box(8, 0.01);
  c.shift = shift;
  c.gravity = {0, 0, -9.81};
  c.domain.periodic = {false, true, false};
  c.domain.min = {-0.05, 0, -0.9};
  c.domain.max = {0.13, 0.08, 0.9};
  c.density.delta = 0.1;
  c.visc.alpha = 0.05;
  c.fluid.fills = {{{0, 0, 0}, {0.08, 0.08, 0.12}}};
  c.wall.bodies = {slab("floor", {0, 0, -0.03}, {0.08, 0.08, 0}, 0),
                   slab("down", {-0.03, 0, -0.2}, {0, 0.08, 0.8}, -1),
                   slab("up", {0.08, 0, -0.8}, {0.11, 0.08, 0.3}, 1)};
  c.wall.bodies[0].motion = {};
  auto s = started(c);
  run_until(*s, 0.6);
  double height[2] = {}, count[2] = {};
  for (const Vec3d& x : vectors(s->snapshot("fluid"), "position")) {
    const int side = x.x < 0.04 ? 0 : 1;
    height[side] += x.z;
    ++count[side];
  }
  return height[0] / count[0] - height[1] / count[1];
}

/// Walls that counted with the density of their pressure made it 2.7e-4 m lower where they go down. Particle
/// shifting leaves it 1.8e-4 m higher there, without it 0.5e-4 m are left.
TEST(SlowWallFlow, WallsThatSlidePastRestingWaterLeaveItAsItIs) {
  EXPECT_NEAR(lifted_by_sliding_walls(0), 0, 1.2e-4);
  EXPECT_NEAR(lifted_by_sliding_walls(Config{}.shift), 0, 2.4e-4);
}

TEST(WallFlow, NoFluidPassesAWall) {
  const Config c = thrown();
  auto s = started(c);
  double deepest = 0;
  for (int k = 0; k < 1500; ++k) {
    s->step();
    if (k % 20 == 0)
      for (const Vec3d& x : vectors(s->snapshot("fluid"), "position"))
        deepest = std::max({deepest, -x.x, x.x - 0.2, -x.z, x.z - 0.2});
  }
  EXPECT_LE(deepest, 0);
  EXPECT_EQ(reading(s->diagnostics(), "lost_fluid_count"), 0);
}

}  // namespace
}  // namespace BL_SOLVER
