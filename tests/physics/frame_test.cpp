// A moving frame shows what is seen from the lab where the walls move instead.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

/// From rest without a jerk, up to 7.9 m/s2 at 10 Hz.
MotionConfig shaking() {
  MotionConfig m;
  m.kind = "formula";
  m.displacement = {"0.002*(62.8*t-sin(62.8*t))", "0", "0.001*(62.8*t-sin(62.8*t))"};
  return m;
}

/// A tank half full, periodic across, shaken.
Config tank(const std::string& integrator) {
  Config c = periodic_box(8, 0.01);
  c.gravity = {0, 0, -9.81};
  c.domain.periodic = {false, true, false};
  c.domain.min = {-0.05, 0, -0.05};
  c.domain.max = {0.17, 0.08, 0.17};
  c.fluid.c = 15;
  c.visc.alpha = 0.02;
  c.density.delta = 0.1;
  c.wall.rep_D = 4;
  c.time.end = 0.1;
  c.time.integrator = integrator;
  c.time.dt = 1e-4;
  c.fluid.fills = {{{0, 0, 0}, {0.12, 0.08, 0.06}, {"0", "0", "0"}}};
  c.wall.bodies = {test::tank({0, 0, 0}, {0.12, 0.08, 0.12}, "x-x+z-z+")};
  return c;
}

class ShakenTank : public testing::TestWithParam<const char*> {};

TEST_P(ShakenTank, FluidMovesAsSeenFromTheLab) {
  Config seen = tank(GetParam());
  seen.density.delta = 0;  // its hydrostatic slope is gravity's in the lab, the effective one's in the frame
  Config lab = seen;
  seen.frame.motion = shaking();
  lab.wall.bodies[0].motion = shaking();
  auto a = started(seen), b = started(lab);
  for (int k = 0; k < 400; ++k) a->step(), b->step();
  const RigidMotion frame = MotionLaw(shaking(), 0.1).at(a->time());
  const auto xa = vectors(a->snapshot("fluid"), "position"), xb = vectors(b->snapshot("fluid"), "position");
  const auto va = vectors(a->snapshot("fluid"), "velocity"), vb = vectors(b->snapshot("fluid"), "velocity");
  const auto pa = scalars(a->snapshot("fluid"), "pressure"), pb = scalars(b->snapshot("fluid"), "pressure");
  double sloshed = 0, off = 0, v_off = 0, p_off = 0, p_top = 0;
  const auto x0 = vectors(started(seen)->snapshot("fluid"), "position");
  for (std::size_t i = 0; i < xa.size(); ++i) {
    sloshed = std::max(sloshed, norm(xa[i] - x0[i]));
    off = std::max(off, norm(xb[i] - frame.translation - xa[i]));
    v_off = std::max(v_off, norm(vb[i] - frame.v - va[i]));
    p_off = std::max(p_off, std::abs(pb[i] - pa[i]));
    p_top = std::max(p_top, pa[i]);
  }
  EXPECT_GT(sloshed, 1e-3) << "the tank is meant to shake its water";
  // second order in time, of which (w dt)^2 = 4e-5 is left; Euler is of first order
  const double fraction = std::string(GetParam()) != "euler" ? tolerance(1e-4, 1e-4, 1e-3) : 2e-2;
  EXPECT_LT(off, fraction * sloshed);
  EXPECT_LT(v_off, fraction * 0.14);
  EXPECT_LT(p_off, 2 * fraction * p_top);
}

INSTANTIATE_TEST_SUITE_P(Integrators, ShakenTank, testing::Values("kdk", "ab3", "euler"));

TEST(ShakenTankLoads, CloseTheMomentumBalance) {
  Config c = tank("kdk");
  c.frame.motion = shaking();
  auto s = started(c);
  for (int k = 0; k < 300; ++k) s->step();
  const auto d = s->diagnostics();
  const double weight = reading(d, "fluid_mass") * 9.81;
  for (const char* axis : {"x", "z"})
    EXPECT_LT(std::abs(reading(d, std::string("fluid_force_residual_") + axis)), 20 * kInvariant * weight);
}

TEST(ShakenTankRestart, GoesOnBitForBit) {
  Config c = tank("kdk");
  c.frame.motion = shaking();
  std::vector<std::string> warnings;
  const bedload::Setup setup = build_setup(c, warnings);
  auto whole = started(c, setup);
  for (int k = 0; k < 30; ++k) whole->step();
  auto second = make_coupled(c, setup);
  second->load(whole->save());
  for (int k = 0; k < 30; ++k) whole->step(), second->step();
  EXPECT_EQ(bits(*whole), bits(*second));
}

TEST(ShakenBox, AFullOneStaysStillAndCarriesThePressure) {
  // free fall along a closed box filled to the brim: g - a_frame = 0.3 g
  Config c = tank("kdk");
  c.fluid.fills[0].max.z = 0.12;
  c.frame.motion.kind = "formula";
  c.frame.motion.displacement = {"0", "0", "-0.5*0.7*9.81*t^2"};
  auto s = started(c);
  for (int k = 0; k < 500; ++k) s->step();
  const auto x = vectors(s->snapshot("fluid"), "position");
  const auto p = scalars(s->snapshot("fluid"), "pressure");
  double n = 0, z1 = 0, p1 = 0, zz = 0, zp = 0;
  for (std::size_t a = 0; a < x.size(); ++a)
    n += 1, z1 += x[a].z, p1 += p[a], zz += x[a].z * x[a].z, zp += x[a].z * p[a];
  EXPECT_NEAR((n * zp - z1 * p1) / (n * zz - z1 * z1), -0.3 * 9810, 0.05 * 0.3 * 9810);
  EXPECT_LT(reading(s->diagnostics(), "fluid_speed_max"), 0.01);
}

/// A grain in flight, in a frame shaken harder than gravity.
TEST(ShakenGrain, FliesAsSeenFromTheLab) {
  Config c;
  c.domain.min = {-0.05, 0, 0};
  c.domain.max = {0.05, 0.04, 0.1};
  c.grain.present = true;
  c.grain.d = c.grain.d_min = c.grain.d_max = 2e-3;
  c.grain.E = 1e5;  // nothing to touch: few substeps
  c.time.end = 0.1;
  c.time.dt = 1e-3;  // each step makes many substeps
  c.time.force_dt = true;
  c.frame.motion.kind = "oscillation";
  c.frame.motion.amplitude = {7.1e-3, 0, 2e-3};
  c.frame.motion.frequency = 4.06;
  c.frame.motion.add = {shaking()};
  bedload::Setup setup;
  setup.grains.x = {{0.01, 0.02, 0.03}};
  setup.grains.v = {{0.3, 0, 0.5}};
  setup.grains.radius = {1e-3};
  auto s = started(c, setup);
  const MotionLaw law(c.frame.motion, c.time.end);
  const Vec3d lab = Vec3d{0.3, 0, 0.5} + law.at(0).v;
  for (int k = 0; k < 100; ++k) s->step();
  const double t = s->time();
  const Vec3d x = Vec3d{0.01, 0.02, 0.03} + lab * t + c.gravity * (t * t / 2) - law.at(t).translation;
  const Vec3d v = lab + c.gravity * t - law.at(t).v;
  const auto store = s->snapshot("grains");
  // velocity Verlet leaves (w tau)^2 / 12 of a few millimetres
  EXPECT_LT(norm(vectors(store, "position")[0] - x), tolerance(3e-8, 1e-7, 1e-7));
  EXPECT_LT(norm(vectors(store, "velocity")[0] - v), tolerance(1e-7, 1e-6, 1e-6));
}

}  // namespace
}  // namespace BL_SOLVER
