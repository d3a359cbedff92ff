// Bodies that move freely in fluid.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bedload/geometry/sampling.hpp"
#include "tests/support/free_body.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// Fluid where `wet` says on a lattice that leaves out the bodies, and their wall particles.
template <class Wet>
bedload::Setup initialised(const Config& c, const Wet& wet) {
  bedload::Setup setup;
  const double dx = c.fluid.dx;
  const Vec3d &lo = c.domain.min, &hi = c.domain.max;
  for (double z = lo.z + dx / 2; z < hi.z; z += dx)
    for (double y = lo.y + dx / 2; y < hi.y; y += dx)
      for (double x = lo.x + dx / 2; x < hi.x; x += dx) {
        bool clear = wet(Vec3d{x, y, z});
        for (const WallBody& body : c.wall.bodies)
          clear = clear && wall_distance(body, {x, y, z}, 0.1, c.domain) > 0;
        if (!clear) continue;
        setup.fluid.x.push_back({x, y, z});
        setup.fluid.v.push_back({});
        setup.fluid.mass.push_back(c.fluid.rho0 * dx * dx * dx);
      }
  std::vector<std::string> warnings;
  add_walls(c, setup.walls, warnings);
  return setup;
}

Config wet_case(double half, double dx) {
  Config c = periodic_box(2, dx);
  c.domain.periodic = {false, false, false};
  c.domain.min = {-half, -half, -half};
  c.domain.max = {half, half, half};
  c.time.end = 10;
  return c;
}

/// A box that drives through a drop, without gravity or walls.
Config drop(const std::string& viscosity) {
  Config c = wet_case(0.1, 0.01);
  c.visc.model = viscosity;
  c.fluid.mu = 1;
  c.wall.rep_D = 0.5;
  WallBody box = test::shaped("box", make_box({-0.03, -0.03, -0.03}, {0.03, 0.03, 0.03}));
  set_free(box, 800).free.velocity = {0.3, -0.1, 0.2};
  box.free.spin = {1, 4, -2};
  c.wall.bodies = {box};
  return c;
}

TEST(FreeBodyInFluid, ClosedSystemKeepsMomenta) {
  for (const char* viscosity : {"none", "morris", "monaghan"}) {
    for (const double shift : {0.0, 200.0}) {
      Config c = drop(viscosity);
      c.shift = shift;
      auto s = started(c, initialised(c, [](const Vec3d& x) {
                         return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}) < 0.06;
                       }));
      const auto total = [&](const char* what) {
        const auto d = s->diagnostics();
        return vector_of(d, std::string("fluid_") + what) + vector_of(d, std::string("body_") + what);
      };
      const Vec3d p = total("momentum"), l = total("angular_momentum");
      const double scale = norm(p);
      double pushed = 0;
      Vec3d corrected;  // impulse that pressure.linear_exact tells
      for (int k = 0; k < 200; ++k) {
        corrected += corrected_in_a_step(*s);
        pushed = std::max(pushed, norm(vector_of(s->body_state(0), "force_by_fluid")));
      }
      ASSERT_GT(pushed, 1);
      EXPECT_LT(norm(vector_of(s->diagnostics(), "body_momentum")), 0.95 * scale)
          << "the fluid has taken some";
      EXPECT_LT(norm(total("momentum") - p - corrected), 10 * kInvariant * scale + 0.02 * norm(corrected))
          << viscosity;
      // Morris viscosity is not central: it keeps no angular momentum, with or without bodies; shifting takes
      // momentum from place to place
      if (c.visc.model != "morris") {
        EXPECT_LT(norm(total("angular_momentum") - l), (shift > 0 ? 0.02 : 10 * kInvariant) * scale * 0.05);
      }
    }
  }
}

/// How fast a ball among viscous fluid under `background` Pa still is, of 0.1 m/s at first, when drag, a
/// stress of some 3 Pa, has acted for 0.15 s.
double slowed(double background, bool linear_exact = true) {
  Config c = periodic_box(12);
  c.time.end = 1;
  c.fluid.mu = 1;
  c.fluid.vmax = 0.8;
  c.eos.background = background;
  c.pressure.linear_exact = linear_exact;
  WallBody ball = test::shaped("ball", make_sphere({0.06, 0.06, 0.06}, 0.03));
  set_free(ball, 2000).free.velocity = {0.1, 0, 0};
  c.wall.bodies = {ball};
  auto s = started(c, initialised(c, [](const Vec3d&) { return true; }));
  run_until(*s, 0.15);
  return vector_of(s->body_state(0), "velocity").x;
}

TEST(SlowLinearFit, LetsABodyMoveUnderAnyPressure) {
  const double without = slowed(0);
  EXPECT_GT(without, 0.02);
  EXPECT_LT(without, 0.08);
  for (const double background : {30.0, 3000.0}) EXPECT_NEAR(slowed(background), without, 0.03 * without);
  EXPECT_GT(std::abs(slowed(3000, false) - without), 0.3 * without) << "a lattice holds it";
}

/// Held at a point beside its middle, in disordered fluid whose pressure is that of its depth.
TEST(FreeBodyInFluid, OfViscousFluidHasTheBuoyancyOfItsVolume) {
  Config c = periodic_box(16);
  c.domain.min.z = -0.04, c.domain.max.z = 0.18;
  c.domain.periodic[2] = false;
  c.time.end = 1;
  c.gravity = {0, 0, -9.81};
  c.fluid.mu = 10;
  const Vec3d middle{0.08, 0.08, 0.07}, arm{0.02, -0.005, 0.01}, half{0.03, 0.02, 0.02};
  WallBody block = test::body("box", middle - half, middle + half);
  set_free(block, 1000).free.move = "none";
  block.free.point = {middle.x - arm.x, middle.y - arm.y, middle.z - arm.z};
  block.free.release_time = 1;
  c.wall.bodies = {test::tank({0, 0, 0}, {0.16, 0.16, 0.17}, "z-"), block};
  c.fluid.fills = {{{0, 0, 0}, {0.16, 0.16, 0.16}}};
  bedload::Setup setup = initialised(c, [](const Vec3d& x) { return x.z > 0 && x.z < 0.16; });
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> by(-0.15 * c.fluid.dx, 0.15 * c.fluid.dx);
  for (Vec3d& x : setup.fluid.x) x += Vec3d{by(rng), by(rng), by(rng)};
  const Vec3d buoyancy{0, 0, 9810 * 8 * half.x * half.y * half.z};
  const auto error = [&](bool linear_exact) {
    c.pressure.linear_exact = linear_exact;
    auto s = started(c, setup);
    s->step();
    const auto d = s->body_state(1);
    return std::pair{
        norm(vector_of(d, "force_by_fluid") - buoyancy) / norm(buoyancy),
        norm(vector_of(d, "torque_by_fluid") - cross(arm, buoyancy)) / norm(cross(arm, buoyancy))};
  };
  const auto [force, torque] = error(true);
  EXPECT_LT(force, 0.03) << "disorder is in the walls' pressure, too";
  EXPECT_LT(torque, 0.03);
  const auto [force_by_pairs, torque_by_pairs] = error(false);
  EXPECT_GT(force_by_pairs, 3 * force);
  EXPECT_GT(torque_by_pairs, 3 * torque);
}

TEST(FreeBodyInFluid, MayBeDeafToItWhileTheFluidFeelsTheBody) {
  Config c = drop("none");
  c.wall.bodies[0].free.fluid = false;
  auto s = started(c, initialised(c, [](const Vec3d& x) {
                     return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}) < 0.06;
                   }));
  for (int k = 0; k < 100; ++k) s->step();
  EXPECT_LT(norm(vector_of(s->body_state(0), "velocity") - Vec3d{0.3, -0.1, 0.2}), 1e-12);
  EXPECT_GT(norm(vector_of(s->body_state(0), "force_by_fluid")), 0.1);
  EXPECT_GT(norm(vector_of(s->diagnostics(), "fluid_momentum")), 0.01);
}

/// Fluid, grains and a body, all pushing each other but for what `mode` of coupling leaves out; angular
/// momentum is kept to `along_the_way` of its scale and round-off.
void expect_momenta_kept(const char* mode, double along_the_way, bool wall_normalise = true,
                         double cfl = 0.25, bool smoothed = true, double shift = Config{}.shift,
                         bool suction = false) {
  Config c = drop("none");
  c.wall.suction = suction;
  c.shift = shift;
  if (!smoothed) c.density.delta = c.density.void_relaxation = 0;
  c.couple.mode = mode;
  c.couple.wall_normalise = wall_normalise;
  c.time.cfl = cfl;
  c.grain.present = true;
  c.grain.d = c.grain.d_min = c.grain.d_max = 6e-3;
  c.grain.E = 1e6;
  c.couple.hc = 0.015;
  const auto within = [](const Vec3d& x) {
    return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}) < 0.06;
  };
  bedload::Setup setup = initialised(c, within);
  for (int k = 0; k < 12; ++k) {  // one beside each face touches at once
    const double side = k % 2 ? 1 : -1;
    Vec3d x{0.004 * (k / 6), 0.007 * (k / 6) - 0.003, 0.005};
    x[(k / 2) % 3] = side * (k < 6 ? 0.0329 : 0.045);
    setup.grains.x.push_back(x);
    setup.grains.v.push_back({0.1 * side, -0.05, 0.02});
    setup.grains.radius.push_back(3e-3);
  }
  auto s = started(c, setup);
  const auto total = [&](const char* what) {
    const auto d = s->diagnostics();
    Vec3d sum;
    for (const char* of : {"fluid_", "grain_", "body_"}) sum += vector_of(d, std::string(of) + what);
    return sum;
  };
  const Vec3d p = total("momentum"), l = total("angular_momentum");
  double by_fluid = 0, by_grains = 0;
  for (int k = 0; k < 60; ++k) {
    s->step();
    const auto b = s->body_state(0);
    by_fluid = std::max(by_fluid, norm(vector_of(b, "force_by_fluid")));
    by_grains = std::max(by_grains, norm(vector_of(b, "force_by_grains")));
  }
  EXPECT_GT(by_fluid, 1);
  EXPECT_GT(by_grains, 0.1);
  EXPECT_LT(norm(total("momentum") - p), 10 * kInvariant * norm(p));
  EXPECT_LT(norm(total("angular_momentum") - l), (10 * kInvariant + along_the_way) * norm(p) * 0.05);
}

/// Shifted particles take their momentum to where they drift: 2e-4 of the scale here where the body holds the
/// fluid, 6.7e-4 where fluid parts from it and has more surfaces to shift along.
TEST(SmallFreeBody, BesideFluidAndGrainsKeepsMomenta) {
  expect_momenta_kept("off", 0, true, 0.25, true, 0);
  expect_momenta_kept("off", 3e-4, true, 0.25, true, Config{}.shift, true);
  expect_momenta_kept("off", 8e-4);
}

/// An exchange keeps the angular momentum of places at the start of a step; how far grains move while drag
/// acts is left out, as is how the couple of the stress changes in it. At these steps that is 1.2e-6 of the
/// scale.
TEST(SmallFreeBody, FluidGrainsAndBodyKeepMomentaTogether) {
  expect_momenta_kept("two_way", 1.6e-6, false, 0.25, true, 0);
  expect_momenta_kept("two_way", 0.8e-6, false, 0.125, true, 0);
  expect_momenta_kept("two_way", 3e-4, false);
}

/// The part of a grain's volume that the body has pushed aside is lifted beside the grain, and the moment of
/// that is given to no one: the more, the higher the pressure, and as it is where fluid is fragmented.
/// Clipping the density there instead of the pressure, with the repulsion of walls, leaves 5e-6 of the scale
/// for 9e-6.
TEST(SmallFreeBody, KeepsAngularMomentumButForVolumeThatItPushesAside) {
  expect_momenta_kept("two_way", 9e-6, true, 0.25, false, 0);
  expect_momenta_kept("two_way", 1.2e-5, true, 0.25, true, 0);
  expect_momenta_kept("two_way", 3e-4);
}

// -- floating -------------------------------------------------------------------

constexpr double kDepth = 0.08, kSide = 0.16, kDraught = 0.03;  // of the water, its tank, the slab at first

Config tank_with_slab(double density) {
  const double dx = 0.01;
  Config c = wet_case(0.5 * kSide, dx);
  c.domain.min.z = 0, c.domain.max.z = 0.2;
  c.gravity = {0, 0, -9.81};
  c.fluid.c = 15, c.fluid.vmax = 1.5;
  c.density.delta = 0.1;
  c.visc.alpha = 0.2;  // to come to rest
  c.wall.rep_D = 5 * 9.81 * kDepth;
  const WallBody tank = test::tank(c.domain.min, c.domain.max, "x-x+y-y+z-");
  WallBody slab = test::shaped(
      "slab", make_box({-0.04, -0.04, kDepth - kDraught}, {0.04, 0.04, kDepth - kDraught + 0.04}));
  set_free(slab, density);
  c.wall.bodies = {tank, slab};
  // space for the layers of the tank
  for (int k = 0; k < 2; ++k) c.domain.min[k] -= 0.04, c.domain.max[k] += 0.04;
  c.domain.min.z = -0.04;
  return c;
}

bedload::Setup filled(const Config& c) {
  return initialised(c, [](const Vec3d& x) {
    return std::max(std::abs(x.x), std::abs(x.y)) < 0.5 * kSide && x.z > 0 && x.z < kDepth;
  });
}

class SlowFloat : public testing::TestWithParam<double> {};

TEST_P(SlowFloat, RestsAtArchimedesDepth) {
  const double density = GetParam();
  const Config c = tank_with_slab(density);
  auto s = started(c, filled(c));
  run_until(*s, 1.2);
  double z = 0, n = 0;
  while (s->time() < 1.5) {
    s->step();
    z += reading(s->body_state(1), "centre_z") - 0.02, n += 1;
  }
  const double area = 0.08 * 0.08, draught = 0.04 * density / 1000;
  const double water = kSide * kSide * kDepth - area * kDraught,
               level = (water + area * draught) / (kSide * kSide);
  EXPECT_NEAR(z / n, level - draught, 0.1 * c.fluid.dx);
  const auto b = s->body_state(1);
  EXPECT_NEAR(reading(b, "force_by_fluid_z") / (9.81 * c.wall.bodies[1].free.solid.mass), 1, 0.1);
  EXPECT_LT(norm(vector_of(b, "velocity")), 0.02);
  EXPECT_GT(rotation_of(b).rotate({0, 0, 1}).z, std::cos(0.15)) << "upright";
}

INSTANTIATE_TEST_SUITE_P(Densities, SlowFloat, testing::Values(200.0, 500.0));

TEST(FreeBodyInFluid, PushesALightRaftUpSmoothly) {
  // a twentieth of the density of water; wall pressure that took its last acceleration would fragment the
  // fluid
  const Config c = tank_with_slab(50);
  auto s = started(c, filled(c));
  const double weight = 9.81 * c.wall.bodies[1].free.solid.mass,
               buoyancy = 9.81 * 1000 * 0.08 * 0.08 * kDraught;
  double last = 0;
  for (int k = 0; k < 200; ++k) {
    s->step();
    const auto b = s->body_state(1);
    const double force = reading(b, "force_by_fluid_z"), v = reading(b, "velocity_z");
    EXPECT_LT(std::abs(force), buoyancy + weight);
    EXPECT_LT(std::abs(v - last), 0.01) << "from step to step";
    last = v;
  }
  EXPECT_GT(last, 0.05);
}

TEST(FreeBodyInFluidRestart, GoesOnBitForBit) {
  const Config c = tank_with_slab(400);
  const bedload::Setup setup = filled(c);
  auto whole = started(c, setup);
  for (int k = 0; k < 60; ++k) whole->step();
  auto second = make_coupled(c, setup);
  second->load(whole->save());
  for (int k = 0; k < 60; ++k) whole->step(), second->step();
  EXPECT_EQ(bits(*whole), bits(*second));
  EXPECT_NE(reading(whole->body_state(1), "centre_z"), c.wall.bodies[1].free.solid.centre.z);
}

}  // namespace
}  // namespace BL_SOLVER
