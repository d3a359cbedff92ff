// Flows with known answers, through whole simulations.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

constexpr double pi = 3.14159265358979323846;

FluidFill fill_of(const Config& c, std::array<std::string, 3> velocity = {"0", "0", "0"}) {
  return {c.domain.min, c.domain.max, velocity};
}

double energy(Simulation& s) {
  const auto d = s.diagnostics();
  return reading(d, "fluid_kinetic_energy") + reading(d, "fluid_elastic_energy") +
         reading(d, "fluid_potential_energy");
}

/// A sound wave and a shear wave in an inviscid periodic box; `smoothed`: with what smooths and mends
/// density, and shifts particles.
Config inviscid_box(int n, double dt, bool smoothed = false) {
  Config c = periodic_box(n);
  c.visc.model = "none";
  if (!smoothed) c.density.delta = c.density.void_relaxation = c.pressure.damper = c.shift = 0;
  c.density.cavitation_limit = 0.5;  // out of the waves' way
  c.time.dt = dt;
  c.time.force_dt = true;
  const double k = 2 * pi / (n * c.fluid.dx);
  const std::string arg = std::to_string(k);
  c.fluid.fills = {fill_of(c, {"0.4*sin(" + arg + "*x)+0.3*cos(" + arg + "*y)", "0.2*sin(" + arg + "*z)",
                               "0.1*cos(" + arg + "*x)"})};
  return c;
}

class SlowInviscidBox : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Integrators, SlowInviscidBox, testing::Values("kdk", "ab3"));

TEST_P(SlowInviscidBox, EnergyIsKept) {  // T-8
  Config c = inviscid_box(8, 0.03 * 0.015 / 21);
  c.time.integrator = GetParam();
  auto s = started(c);
  const double start = energy(*s);
  for (int k = 0; k < 10000; ++k) s->step();
  const double change = (energy(*s) - start) / start;
  EXPECT_LT(change, 1e-4);
  EXPECT_GT(change, std::string(GetParam()) == "kdk" ? -1e-4 : -5e-4);  // ab3 damps sound by (w dt)^4
}

class InviscidBox : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Integrators, InviscidBox, testing::Values("kdk", "ab3"));

TEST_P(InviscidBox, WithItsDefaultsNeverGainsEnergy) {
  Config c = inviscid_box(8, 0.25 * 0.015 / 21, true);
  c.time.integrator = GetParam();
  auto s = started(c);
  const double start = energy(*s);
  double last = start;
  for (int k = 0; k < 300; ++k) {
    s->step();
    if (k % 10 == 0) {
      EXPECT_LT(energy(*s), last + 1e-3 * start);
      last = energy(*s);
    }
  }
  EXPECT_LT(last, 0.9 * start);
}

/// The acoustic damper takes a c h k^2 of the energy of sound a second, as a bulk viscosity does, and none of
/// shear.
TEST_P(InviscidBox, DamperTakesEnergyFromSoundAlone) {
  const auto left = [](const char* along, double damper) {
    Config c = inviscid_box(16, 0.25 * 0.015 / 21);
    c.time.integrator = GetParam();
    c.pressure.damper = damper;
    const std::string wave = "0.1*sin(" + std::to_string(2 * pi / 0.16) + "*x)";
    const bool sound = along[0] == 'x';
    c.fluid.fills = {fill_of(c, {sound ? wave : "0", "0", sound ? "0" : wave})};
    auto s = started(c);
    const double start = energy(*s);
    for (int k = 0; k < 40; ++k) s->step();
    return energy(*s) / start;
  };
  EXPECT_GT(left("x", 0), 0.97);
  for (const double a : {0.25, 0.5, 1.0}) {
    const double theory = a * 20 * 0.015 * square(2 * pi / 0.16) * 40 * 0.25 * 0.015 / 21;
    EXPECT_NEAR(-std::log(left("x", a)) / theory, 0.9, 0.15) << "kernel: sound of 10 h";
  }
  EXPECT_NEAR(left("z", 0.5), left("z", 0), 2e-3);
}

/// Four vortices in a closed box with slip, under background pressure and without anything that dissipates:
/// the greatest energy of them over what it was at the start, in a turn of theirs. `work`: of the walls'
/// pressure over that time, of the same.
double most_energy_in_a_closed_box(bool consistent, double& work) {
  Config c = periodic_box(7, 1.0 / 16);
  c.domain.min = {-0.3, -0.3, 0}, c.domain.max = {1.3, 1.3, 7.0 / 16};
  c.domain.periodic = {false, false, true};
  c.fluid.c = 10, c.fluid.vmax = 1, c.fluid.rho0 = 1;
  c.eos.background = 1;
  c.visc.model = "none";
  c.density.delta = c.density.void_relaxation = c.pressure.damper = c.shift = 0;
  c.density.cavitation_limit = 0.5;
  c.wall.energy_consistent = consistent;
  c.wall.suction = true;
  c.fluid.fills = {{{0, 0, 0}, {1, 1, 7.0 / 16}, {"sin(pi*x)*cos(pi*y)", "-cos(pi*x)*sin(pi*y)", "0"}}};
  c.wall.bodies = {test::tank({0, 0, 0}, {1, 1, 7.0 / 16}, "x-x+y-y+")};
  c.wall.bodies[0].slip = "slip";
  c.wall.bodies[0].no_penetration = false;
  auto s = started(c);
  const double start = energy(*s);
  double most = start;
  work = 0;
  for (double t = 0; t < 1.5; t = s->time()) {
    s->step();
    work += reading(s->diagnostics(), "power_wall_pressure") * (s->time() - t) / start;
    most = std::max(most, energy(*s));
  }
  return most / start;
}

TEST(SlowInviscidClosedBox, WallsAreNoSourceOfEnergy) {
  double work = 0;
  EXPECT_LT(most_energy_in_a_closed_box(true, work), 1.02);
  EXPECT_NEAR(work, 0, 0.03);
  EXPECT_GT(most_energy_in_a_closed_box(false, work), 1.3);
  EXPECT_GT(work, 0.3);
}

/// Velocity first, then density from the new velocity: forward Euler would blow the sound wave up within
/// periods.
TEST(InviscidBoxByEuler, StepsKeepASoundWaveInBounds) {
  Config c = inviscid_box(8, 0.25 * 0.015 / 21);
  c.time.integrator = "euler";
  auto s = started(c);
  const double start = energy(*s);
  double most = start;
  for (int k = 0; k < 300; ++k) {
    s->step();
    most = std::max(most, energy(*s));
  }
  EXPECT_LT(most, 1.15 * start);
  EXPECT_GT(energy(*s), 0.85 * start);
}

TEST_P(SlowInviscidBox, SecondOrderInTime) {  // T-8
  std::vector<std::vector<Vec3d>> v;
  for (int halvings : {0, 1, 2}) {
    const int steps = 64 << halvings;
    Config c = inviscid_box(8, 0.0128 / steps);
    c.time.integrator = GetParam();
    auto s = started(c);
    for (int k = 0; k < steps; ++k) s->step();
    v.push_back(vectors(s->snapshot("fluid"), "velocity"));
  }
  double coarse = 0, fine = 0;
  for (std::size_t a = 0; a < v[0].size(); ++a) {
    coarse += norm2(v[0][a] - v[1][a]);
    fine += norm2(v[1][a] - v[2][a]);
  }
  EXPECT_NEAR(std::log2(std::sqrt(coarse / fine)), 2, 0.25);
}

/// Fluid pulled towards a centre swings there and back, and keeps what energy and momentum it may.
TEST(DrivenFluid, SwingsAboutTheCentreThatPullsIt) {
  Config c = periodic_box(8);
  c.domain.periodic = {false, false, true};
  c.domain.min = {-0.1, -0.1, 0}, c.domain.max = {0.1, 0.1, 0.08};
  c.fluid.c = 10;
  c.visc.model = "none";
  c.drive.rate = {20, 0, 0};
  c.drive.centre = {0.02, 0, 0};
  c.fluid.fills = {{{-0.04, -0.04, 0}, {0.04, 0.04, 0.08}, {"0", "0", "0"}}};
  auto s = started(c);
  const double start = energy(*s);
  EXPECT_NEAR(start, 0.512 * 0.5 * 400 * (0.0004 + 0.08 * 0.08 / 12 * (1 - 1.0 / 64)), 1e-6);
  run_until(*s, pi / 40);  // a quarter of a period: the centre of mass is at the centre of the pull
  const auto d = s->diagnostics();
  const double t = s->time();
  EXPECT_NEAR(reading(d, "fluid_momentum_x"), 0.512 * 0.02 * 20 * std::sin(20 * t), 5e-3 * 0.512 * 0.4);
  EXPECT_LT(std::abs(reading(d, "fluid_momentum_y")), 10 * kInvariant * 0.2);
  EXPECT_LT(std::abs(reading(d, "fluid_force_residual_x")), 1e-4 * 0.512 * 8);
  EXPECT_NEAR(energy(*s), start, 0.02 * start);
}

/// Still water over a floor, periodic sideways.
Config column(double height, double dx) {
  Config c = periodic_box(8, dx);
  c.gravity = {0, 0, -9.81};
  c.domain.periodic = {true, true, false};
  c.domain.max.z = 1.5 * height;
  c.fluid.c = 10 * std::sqrt(2 * 9.81 * height);
  c.visc.alpha = 0.02;
  c.density.delta = 0.1;
  FluidFill fill = fill_of(c);
  fill.max.z = height;
  c.fluid.fills = {fill};
  c.wall.bodies = {test::tank(c.domain.min, c.domain.max, "z-")};
  c.wall.rep_D = 5 * 9.81 * height;
  return c;
}

TEST(SlowHydrostatics, PressureGradientAmongFixedGrains) {  // T-9, porosity 0.6
  Config c = column(0.2, 0.02);
  const int across = 9, up = 15;
  const double gap = 0.16 / across;
  c.grain.present = true;
  c.grain.fixed = true;
  c.grain.d = c.grain.d_max = c.grain.d_min = std::cbrt(0.4 * 6 / pi) * gap;
  c.couple.hc = std::max(c.fluid.h(), 2 * c.grain.d);
  std::vector<std::string> warnings;
  auto setup = build_setup(c, warnings);
  for (int k = 0; k < up; ++k)
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i) {
        setup.grains.x.push_back({(i + 0.5) * gap, (j + 0.5) * gap, (k + 0.5) * gap});
        setup.grains.v.push_back({});
        setup.grains.radius.push_back(c.grain.d / 2);
      }
  auto s = started(c, setup);
  run_until(*s, 2);
  EXPECT_NEAR(pressure_line(*s, 0.04, 0.16).slope(), -9810, 2e-2 * 9810);
}

/// A channel between walls at z = 0 and L, 50 dx wide.
Config channel() {
  const double L = 1e-3, dx = L / 50;
  Config c = periodic_box(8, dx);
  c.domain.periodic = {true, true, false};
  c.domain.max.z = L;
  c.fluid.mu = 1e-3;
  c.fluid.c = 1.25e-4 * 2;
  c.wall.rep_D = c.fluid.c * c.fluid.c / 100;
  c.fluid.fills = {fill_of(c)};
  for (const char* face : {"z-", "z+"}) c.wall.bodies.push_back(test::tank(c.domain.min, c.domain.max, face));
  c.wall.bodies[0].name = "floor", c.wall.bodies[1].name = "lid";
  return c;
}

TEST(SlowViscousFlow, PoiseuilleStartUp) {  // T-10
  Config c = channel();
  c.drive.f = {0.1, 0, 0};  // N/m3: 1e-4 m/s2
  auto s = started(c);
  run_until(*s, 0.225);
  const double L = 1e-3, nu = 1e-6, f = 1e-4, t = s->time(), peak = f * L * L / (8 * nu);
  const auto x = vectors(s->snapshot("fluid"), "position");
  const auto v = vectors(s->snapshot("fluid"), "velocity");
  double worst = 0;
  for (std::size_t a = 0; a < x.size(); ++a) {
    const double z = x[a].z;
    double exact = f / (2 * nu) * z * (L - z);
    for (int n = 0; n < 40; ++n) {
      const double k = (2 * n + 1) * pi / L;
      exact -= 4 * f / (nu * L * k * k * k) * std::sin(k * z) * std::exp(-nu * k * k * t);
    }
    worst = std::max(worst, std::abs(v[a].x - exact));
  }
  EXPECT_LT(worst / peak, 2e-2);
}

TEST(SlowViscousFlow, TaylorGreenDecay) {  // T-10, Re = 10
  Config c = periodic_box(50, 0.02);
  c.domain.max.z = 8 * c.fluid.dx;
  c.fluid.rho0 = 1;
  c.fluid.mu = 0.1;
  c.fluid.c = 10;
  const std::string k = std::to_string(2 * pi);
  c.fluid.fills = {
      fill_of(c, {"-cos(" + k + "*x)*sin(" + k + "*y)", "sin(" + k + "*x)*cos(" + k + "*y)", "0"})};
  auto s = started(c);
  const double start = reading(s->diagnostics(), "fluid_kinetic_energy");
  run_until(*s, 0.1);
  const double rate = std::log(start / reading(s->diagnostics(), "fluid_kinetic_energy")) / s->time();
  const double exact = 4 * 0.1 * 4 * pi * pi;
  EXPECT_NEAR(rate, exact, 2e-2 * exact);
}

TEST(WallTorque, IsAboutTheCentreHoweverFarTheWallHasGone) {
  Config c = column(0.16, 0.02);
  WallBody& floor = c.wall.bodies[0];
  floor.slip = "slip";
  floor.motion.kind = "velocity";
  floor.motion.velocity = {4, 0, 0};
  auto s = started(c);
  const auto lever = [&] {
    const auto b = s->body_state(0);
    return reading(b, "torque_by_fluid_y") / reading(b, "force_by_fluid_z");
  };
  EXPECT_NEAR(lever(), -0.08, 1e-3);
  run_until(*s, 0.06);  // one and a half periods
  EXPECT_GT(reading(s->body_state(0), "centre_x"), 0.16);
  EXPECT_NEAR(lever(), -0.08, 5e-3);
}

class SmallSimulation : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Integrators, SmallSimulation, testing::Values("kdk", "ab3"));

TEST_P(SmallSimulation, SameDeckTwiceIsBitEqual) {  // T-46
  Config c = column(0.16, 0.02);
  c.time.integrator = GetParam();
  std::vector<std::byte> first;
  for (int k : {0, 1}) {
    auto s = started(c);
    for (int step = 0; step < 40; ++step) s->step();
    if (k == 0)
      first = bits(*s);
    else
      EXPECT_EQ(first, bits(*s));
  }
}

TEST_P(SmallSimulation, GoesOnFromACheckpointBitForBit) {
  Config c = column(0.16, 0.02);
  c.time.integrator = GetParam();
  for (const double mu : {1e-3, 1.0})       // Pa s; of the latter pressure forces are exact where linear
    for (const char* speed : {"0", "2"}) {  // m/s: lists with and without more skin
      c.fluid.mu = mu;
      c.fluid.fills[0].velocity[0] = speed;
      auto s = started(c);
      for (int step = 0; step < 20; ++step) s->step();
      std::vector<std::string> warnings;
      auto again = make_coupled(c, build_setup(c, warnings));
      again->load(s->save());
      for (int step = 0; step < 20; ++step) s->step(), again->step();
      EXPECT_EQ(bits(*s), bits(*again));
    }
}

TEST(SmallRestart, GoesOnWithShiftingAndAnotherIntegrator) {
  Config c = column(0.16, 0.02);
  c.shift = 0;
  auto s = started(c);
  for (int step = 0; step < 20; ++step) s->step();
  const double before = energy(*s);
  c.shift = 200;
  c.time.integrator = TimeIntegrator::ab3;
  std::vector<std::string> warnings;
  auto again = make_coupled(c, build_setup(c, warnings));
  again->load(s->save());
  for (int step = 0; step < 200; ++step) again->step();
  EXPECT_NEAR(energy(*again), before, 1e-3 * before);
}

/// 3.4 steps is what the narrow skin would bear here, of which fast particles have four times as much.
TEST(SmallLists, OfFastFlowLastThirteenSteps) {
  Config c = column(0.16, 0.02);
  c.fluid.fills[0].velocity[0] = "2";
  c.time.dt = 4.4e-4;
  c.time.force_dt = true;
  auto s = started(c);
  int rebuilt = 0;
  for (int step = 0; step < 40; ++step) rebuilt += s->step().rebuilt;
  EXPECT_GE(rebuilt, 3);
  EXPECT_LE(rebuilt, 5) << "the first lists are narrow";
}

/// Water at rest stays at rest, with hydrostatic pressure, over a floor that slides beneath it without
/// friction.
TEST_P(SmallSimulation, WaterRestsOverASlidingFloor) {
  Config c = column(0.32, 0.02);
  c.time.integrator = GetParam();
  c.wall.bodies[0].slip = "slip";
  c.wall.bodies[0].motion.kind = "velocity";
  c.wall.bodies[0].motion.velocity = {0.5, 0, 0};
  auto s = started(c);
  const double start = energy(*s);
  run_until(*s, 0.5);
  EXPECT_NEAR(energy(*s), start, 2e-3 * start);
  EXPECT_NEAR(pressure_line(*s, 0.06, 0.24).slope(), -9810, 2e-2 * 9810);
  for (const Vec3d& v : vectors(s->snapshot("fluid"), "velocity"))
    EXPECT_LT(norm(v), 0.01 * std::sqrt(9.81 * 0.32));
}

}  // namespace
}  // namespace BL_SOLVER
