// Forces on the wall particles of a body, and their levers.

#include <gtest/gtest.h>

#include "kernels/bodies/body_kicks.hpp"
#include "kernels/bodies/clumps.hpp"
#include "kernels/fluid/body_pressure.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << "xyz"[k];
}

/// Body 1, a quarter turn about z on, its reference point from (1, 0, 0) to (3, 1, 0); body 0 as it was.
struct Turned {
  std::vector<std::uint32_t> body{1, 0, 1};
  std::vector<Vec3d> x0{{1.5, 0, 0}, {9, 9, 9}, {1, 0.5, 0.25}};
  std::vector<BodyPose> poses{{}, {}};
  Turned() {
    poses[1].centre = {1, 0, 0};
    poses[1].translation = {2, 1, 0};
    poses[1].rotation = Quat<double>::from_rotation({0, 0, M_PI / 2});
  }
  BodyParticles particles() { return {1, {body.data(), 3}, {x0.data(), 3}, poses.data()}; }
};

TEST(BodyLoads, TurnABodyAboutWhereItIs) {
  Turned t;
  std::vector<Vec3d> force{{0, 2, 0}, {100, 100, 100}, {0, 0, 4}};
  const WallLoadReduction loads{t.particles(), {force.data(), 3}};
  LoadSum sum = loads.identity();
  for (Index w = 0; w < 3; ++w) loads.combine(sum, loads(w));
  expect_near(sum.force(), {0, 2, 4}, 1e-12);
  // arms (0, 0.5, 0) and (-0.5, 0, 0.25)
  expect_near(sum.torque(), Vec3d{0, 0, 0} + Vec3d{0, 2, 0}, 1e-12);
}

TEST(BodyLoads, TouchesOfABodyAddUpAndOthersDoNot) {
  std::vector<ContactLoad> slots(4);
  std::vector<Index> counts(2);
  const ContactLoads loads{slots.data(), counts.data(), 2, 2};
  loads.add(0, {{1, 0, 0}, {0, 0, 1}, 3});
  loads.add(0, {{0, 5, 0}, {0, 5, 0}, 2});
  loads.add(0, {{2, 0, 0}, {1, 0, 0}, 3});
  loads.add(0, {{7, 7, 7}, {7, 7, 7}, 1});  // more bodies than there is space for
  loads.add(1, {{0, 0, 4}, {}, 3});
  EXPECT_EQ(counts[0], 2u);
  const ContactLoadReduction of{loads, 3};
  LoadSum sum = of.identity();
  for (Index i = 0; i < 2; ++i) of.combine(sum, of(i));
  expect_near(sum.force(), {3, 0, 4}, 0);
  expect_near(sum.torque(), {1, 0, 1}, 0);
}

TEST(BodyLoads, AClumpTakesTheLeversOfItsGrains) {
  std::vector<Vec3d> x{{}}, v{{}}, spin{{}}, arm{{2, 0, 0}, {0, 1, 0}, {0, 0, 9}};
  std::vector<Vec4<double>> rotation{to_vec4(Quat<double>::from_rotation({0, 0, M_PI / 2}))};
  std::vector<std::uint32_t> clump{1, 1, 0};
  std::vector<Real3> force{{1, 0, 0}, {0, 0, 2}, {9, 9, 9}}, torque{{0, 0, 3}, {}, {9, 9, 9}},
      more{{1, 0, 0}, {}, {9, 9, 9}};
  const auto all = [](auto& of) { return Span(of.data(), Index(of.size())); };
  const ClumpLoadReduction loads{.all = {.kinds = nullptr,
                                         .offsets = nullptr,
                                         .kind = {},
                                         .size = {},
                                         .x = all(x),
                                         .v = all(v),
                                         .angular_momentum = all(spin),
                                         .rotation = all(rotation),
                                         .clump = all(clump),
                                         .arm = all(arm)},
                                 .of = 0,
                                 .force = all(force),
                                 .torque = all(torque),
                                 .more = all(more),
                                 .per_torque = 0.5};
  LoadSum sum = loads.identity();
  for (Index i = 0; i < 3; ++i) loads.combine(sum, loads(i));
  expect_near(sum.force(), {2, 0, 2}, 1e-12);
  // levers (0, 2, 0) and (-1, 0, 0); torque of the grains times 0.5
  expect_near(sum.torque(), Vec3d{0, 0, -4} + Vec3d{0, 2, 0} + Vec3d{0, 0, 1.5}, 1e-12);
}

/// P + g . d about the reference point, from the wet particles of the body.
TEST(BodyLoads, FitFindsALinearPressure) {
  BodyPressureSums sums = BodyPressureSums::zero();
  const Vec3d g{30, -20, -9810};
  const Vec3d at[] = {{0.1, 0, 0},  {-0.1, 0.02, 0}, {0, 0.1, 0.03},
                      {0, -0.1, 0}, {0.02, 0, 0.1},  {0, 0, -0.1}};
  for (const Vec3d& d : at) sums.add(d, 5000 + dot(g, d));
  const BodyPressure fit = sums.fit();
  EXPECT_NEAR(fit.P, 5000, 1e-8);
  expect_near(fit.g, g, 1e-7);
  BodyPressureSums line = BodyPressureSums::zero();  // says nothing across
  for (const double d : {-0.1, 0.0, 0.1}) line.add({d, 0, 0}, 100 + d);
  EXPECT_NEAR(line.fit().P, 100, 1e-9);
  EXPECT_EQ(norm(line.fit().g), 0);
}

/// By the volume that pairs see from where the body is wet.
TEST(BodyLoads, PressureIsCorrectedWhereFluidIsAllAround) {
  const EnclosedSolid solid{1, 0.002, {0.1, 0, 0}};
  std::vector<BodyPose> poses(2);
  const std::vector<BodyPressure> fitted{{}, {5000, {0, 0, -9810}}};
  const Vec3d by_pairs{3, 0, 15};
  const auto added = [&](double seen, double weight, int dimensions) {
    PairsOfBody pairs{LoadSum::zero(), 10, 10 * weight, {0.5, 0, 0}, 0.05 + dimensions * 0.002 * seen};
    pairs.load.add(by_pairs, {});
    std::vector<LoadSum> out(2, LoadSum::zero());
    CorrectBody{.solids = {&solid, 1},
                .poses = poses.data(),
                .fitted = {fitted.data(), 2},
                .pairs = {&pairs, 1},
                .dimensions = dimensions,
                .added = {out.data(), 2}}(0);
    return out[1];
  };
  const Vec3d whole{-3, 0, 0.002 * 9810 - 15};
  for (const int dimensions : {2, 3}) {
    expect_near(added(1.1, 1, dimensions).force(), whole, 1e-9);
    expect_near(added(0.865, 1, dimensions).force(), 0.5 * whole, 1e-9);
    expect_near(added(5.0 / 6, 1, dimensions).force(), {}, 1e-9);
    expect_near(added(-1, 1, dimensions).force(), {}, 1e-9);
    expect_near(added(1, 0.75, dimensions).force(), {}, 1e-9);
  }
  expect_near(added(-1, 1, 0).force(), whole, 1e-9);
  expect_near(added(1, 1, 3).torque(), {0, -0.1 * 0.002 * 9810, 0}, 1e-9);
}

}  // namespace
}  // namespace BL_SOLVER
