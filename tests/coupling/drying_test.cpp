// A grain that leaves the fluid, and grains with hardly any fluid around.
#include <gtest/gtest.h>

#include "tests/support/coupled_box.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

struct Exchange {
  double K, K_rot, force, wetness, reaction;
};

/// One grain at height z (m) over fluid whose surface is at z = 0.5.
Exchange grain_at(double z) {
  Config c = unit_box(0.1, 20);
  Cloud fluid = fluid_at(lattice({0.25, 0.25, 0.2}, {0.75, 0.75, 0.5}, 0.05), 0.05, 1000, 1);
  for (auto& t : fluid.stress_acceleration) t = {0, 0, 9.81};
  CoupledBox box(c, fluid, {{{0.5, 0.5, z}}, {{0, 0, -1}}, {{0, 2, 0}}, {0.03}});
  box.coupling.porosity(box.fluid, box.grains, {}, 0);
  box.coupling.push(box.fluid, box.grains, 0, true);
  box.coupling.gather(box.fluid, box.grains, {}, 1e-4);
  const double K = box.grains.drag_coefficient.values()[0];
  const Real3 w = box.grains.fluid_velocity.values()[0] - box.grains.v.values()[0];
  box.grains.impulse.assign({Real(1e-4 * K) * w});
  box.grains.spin_impulse.buffer().zero();
  box.coupling.react(box.fluid, box.grains, 1e-4);
  double reaction = 0;
  for (const Real3& r : box.fluid.reaction.values()) reaction += norm(r);
  for (const auto& a : box.fluid.v_rho.values()) reaction += norm(a.v);
  EXPECT_TRUE(std::isfinite(norm(w)));
  return {K, box.grains.rot_drag_coefficient.values()[0], norm(box.grains.fluid_force.values()[0]),
          box.grains.wetness.values()[0], reaction};
}

TEST(Drying, IsContinuousAndEndsAtExactlyNothing) {
  const Exchange deep = grain_at(0.35), surface = grain_at(0.5);
  EXPECT_EQ(deep.wetness, 1);
  EXPECT_NEAR(surface.wetness, 0.5, 0.02);
  // fluid that fills less than couple.S_dry of the kernel gives no drag, but the part of its weight that it
  // is
  const double dry = unit_box(0.1, 20).couple.S_dry, reach = 2 * 0.1, highest = 0.5 - 0.05 / 2;
  Exchange last = deep;
  bool dried = false;
  for (double z = 0.35; z < 0.8; z += 0.005) {
    const Exchange now = grain_at(z);
    // the kernel takes up at most 1.4 / h of itself per height, the wetness 1/0.9 of that
    const double jump = 0.005 * 1.4 / 0.1 / 0.9 * 1.1;
    EXPECT_NEAR(now.K, last.K, jump * deep.K) << z;
    EXPECT_NEAR(now.force, last.force, jump * deep.force) << z;
    EXPECT_LE(now.wetness, last.wetness + kInvariant) << z;
    if (now.wetness == 0) {
      dried = true;
      EXPECT_EQ(now.K, 0);
      EXPECT_EQ(now.K_rot, 0);
      EXPECT_LE(now.force, dry * deep.force);
      EXPECT_EQ(now.force > 0, z < highest + reach) << z;
      EXPECT_EQ(now.reaction, 0);
    }
    last = now;
  }
  EXPECT_TRUE(dried);
  EXPECT_EQ(last.force, 0);
}

/// Archimedes: also of grains at walls, beyond which there is no fluid, and in corners.
TEST(Drying, ABedThatStandsOutOfTheWaterIsLiftedByWhatIsUnderIt) {
  const double lo = 0.2, hi = 0.8, level = 0.5, d = 0.03;
  Config c = unit_box(0.1, 20);
  c.couple.mode = "one_way";
  c.wall.bodies = {test::tank({lo, lo, lo}, {hi, hi, hi})};
  Cloud fluid = fluid_at(lattice({lo, lo, lo}, {hi, hi, level}, 0.025), 0.025, 1000, 1);
  for (auto& t : fluid.stress_acceleration) t = {0, 0, 9.81};
  Pebbles grains{lattice({lo, lo, lo}, {hi, hi, hi}, 0.04), {}, {}, {}};
  const std::size_t n = grains.x.size();
  grains.v.resize(n);
  grains.omega.resize(n);
  grains.radius.assign(n, d / 2);
  CoupledBox box(c, fluid, grains);
  Buffer<BodyPose> poses;
  poses.assign(std::vector<BodyPose>(1));
  box.coupling.porosity(box.fluid, box.grains, poses, 0);
  box.coupling.push(box.fluid, box.grains, 0, true);
  box.coupling.gather(box.fluid, box.grains, poses, 1e-4);
  const auto x = box.grains.x.values();
  const auto wet = box.grains.wetness.values();
  double lift = 0, under = 0;
  for (std::size_t j = 0; j < n; ++j) {
    lift += box.grains.fluid_force.values()[j].z;
    under += (x[j].z < level) + 0.5 * (x[j].z == level);
    if (x[j].z < level - 0.15) {
      EXPECT_GT(wet[j], 0.97) << x[j].x << " " << x[j].y << " " << x[j].z;
    }
  }
  const double expected = under * M_PI / 6 * d * d * d * 9810;
  EXPECT_NEAR(lift, expected, 0.01 * expected);
  box.relist(true, nullptr, poses);  // walls at rest: only grains beside them are asked
  box.coupling.porosity(box.fluid, box.grains, poses, 0);
  box.coupling.gather(box.fluid, box.grains, poses, 1e-4);
  EXPECT_EQ(box.grains.wetness.values(), wet);
}

TEST(Drying, AGrainWithoutAnyFluidFeelsNothing) {
  const Exchange far = grain_at(0.9);
  EXPECT_EQ(far.wetness, 0);
  EXPECT_EQ(far.K, 0);
  EXPECT_EQ(far.force, 0);
  EXPECT_EQ(far.reaction, 0);
}

TEST(Drying, ACoupleNeedsASpreadOfFluid) {
  // one, two in line and three in a plane through the grain: no rotation is defined by the first two
  const std::vector<Vec3d> places[] = {{{0.52, 0.5, 0.5}},
                                       {{0.52, 0.51, 0.5}, {0.46, 0.48, 0.5}},
                                       {{0.55, 0.5, 0.5}, {0.46, 0.53, 0.5}, {0.48, 0.46, 0.5}}};
  for (const auto& x : places) {
    Cloud fluid = fluid_at(x, 0.12, 1000, 1);
    for (std::size_t a = 0; a < x.size(); ++a) fluid.v[a] = {0.5 + a, 1, -1.0 * a};
    CoupledBox box(unit_box(0.1, 20), fluid, {{{0.5, 0.5, 0.5}}, {{0, 0, -1}}, {{0, 2, 0}}, {0.03}});
    box.coupling.gather(box.fluid, box.grains, {}, 1e-4);
    EXPECT_GT(box.grains.wetness.values()[0], 0);
    EXPECT_EQ(box.grains.rot_drag_coefficient.values()[0] > 0, x.size() == 3);
    box.grains.impulse.assign({Real3(1, 2, 3)});
    box.grains.spin_impulse.buffer().zero();
    const auto before = box.fluid.v_rho.values();
    box.coupling.react(box.fluid, box.grains, 1e-4);
    const auto after = box.fluid.v_rho.values();
    Vec3d change;
    for (std::size_t a = 0; a < x.size(); ++a)
      change += (Vec3d(after[a].v) - Vec3d(before[a].v)) * double(box.fluid.mass.values()[a]);
    EXPECT_LT(norm(change + Vec3d(1, 2, 3)), 20 * kInvariant);
  }
}

}  // namespace
}  // namespace BL_SOLVER
