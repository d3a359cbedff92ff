// What fluid gives one wall particle, and single layers the fluid, by hand.

#include <gtest/gtest.h>

#include "kernels/fluid/layer_force.hpp"
#include "kernels/fluid/wall_pass.hpp"
#include "kernels/smoothing/wendland_c2.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kRounding = tolerance(1e-12, 1e-6, 1e-6);

/// A wall particle at the origin below one of fluid at 2 kPa, at (0.02, 0, 0.05) m.
struct Below {
  WendlandC2 w{0.05};
  Vec3d at{0.02, 0, 0.05};
  std::vector<VelocityDensity<>> flux{{{1, 2, 3}, 1000}};
  std::vector<EosState<>> eos_state{{1, Real(2e3 / 1e6), 1000, 1}};
  std::vector<Real3> kick{{}};
  std::vector<Vec3d> x0{{}};
  std::vector<std::uint32_t> body{0};
  std::vector<BodyPose> pose{{}};
  std::vector<VelocityDensity<>> v_rho{{}};
  std::vector<NoSlip<>> no_slip{{}};
  std::vector<WallState<>> state{{}};
  std::vector<Real> compression{0};
  Vec3d gravity;

  Below() { pose[0].volume = 1e-3; }
  template <class T>
  static Span<T> all(std::vector<T>& of) {
    return {of.data(), 1};
  }
  /// Pressure of the wall particle, Pa.
  double pressure(double rate) {
    const WallPass<WendlandC2> pass{.w = w,
                                    .eos = {Real(1e7), 7, 0, 1000, false},
                                    .fluid = {all(flux), all(eos_state)},
                                    .drag_kick = all(kick),
                                    .rate = Real(rate),
                                    .x0 = all(x0),
                                    .bodies = {all(body), all(pose)},
                                    .gravity = Real3(gravity),
                                    .least_sum = Real(1e-3),
                                    .v_rho = all(v_rho),
                                    .no_slip = all(no_slip),
                                    .state = all(state),
                                    .compression = all(compression)};
    auto sum = pass.start(0);
    const Real3 r = Real3(-at);
    pass.pair(sum, r, norm2(r), Real(0), flux[0], eos_state[0], kick[0]);
    pass.finish(0, sum);
    return double(state[0].p_over_rho2) * square(double(v_rho[0].rho));
  }
};

/// V_w D_w / W of one particle of fluid; nothing of frozen walls, of openings, of dry ones and where hardly
/// any fluid is.
TEST(WallWorkPass, IsWhatThePressureOfTheWallDoesAsTheFluidLeaves) {
  Below b;
  b.v_rho[0] = {{Real(0.5), 0, 0}, 1040};
  b.state[0] = {.mass = Real(1.04e-3), .rho = 1040};
  std::vector<Real> work{7};
  const auto found = [&](double least_sum) {
    const WallWorkPass<WendlandC2> pass{.w = b.w,
                                        .least_sum = Real(least_sum),
                                        .fluid = {Below::all(b.flux), {}},
                                        .walls = {Below::all(b.v_rho), Below::all(b.state), {}},
                                        .bodies = {Below::all(b.body), Below::all(b.pose)},
                                        .work = Below::all(work)};
    auto sum = pass.start(0);
    const Real3 r = Real3(-b.at);
    pass.pair(sum, r, norm2(r), Real(2e-3), b.flux[0]);
    pass.finish(0, sum);
    return double(work[0]);
  };
  const Real distance = Real(std::sqrt(norm2(b.at)));
  const double apart = dot(Vec3d{0.5 - 1, -2, -3}, -1.0 * b.at);
  const double expected = 1e-6 * 2e-6 * double(b.w.F(distance)) * apart / double(b.w.W(distance));
  EXPECT_NEAR(found(1e-3), expected, 10 * kRounding * std::abs(expected));
  EXPECT_EQ(found(1e9), 0);
  b.pose[0].kind = WallKind::frozen;
  EXPECT_EQ(found(1e-3), 0);
  b.pose[0].kind = WallKind::extrapolated, b.pose[0].flows = 1;
  EXPECT_EQ(found(1e-3), 0);
  b.pose[0].flows = 0, b.state[0] = {.rho = 1000};
  EXPECT_EQ(found(1e-3), 0);
}

/// What drag does to the fluid in a step acts on the wall as gravity does: grains that settle press it down.
TEST(WallPass, DragOfTheStepActsAsGravity) {
  Below plain;
  EXPECT_NEAR(plain.pressure(200), 2000, 2e4 * kRounding);
  Below pulled;
  pulled.gravity = {3, 0, -9};
  EXPECT_NEAR(pulled.pressure(0), 2000 + 1000 * (9 * 0.05 - 3 * 0.02), 2e4 * kRounding);
  Below dragged;
  dragged.kick = {{Real(0.015), 0, Real(-0.045)}};  // in 5 ms
  EXPECT_NEAR(dragged.pressure(200), 2000 + 1000 * (9 * 0.05 - 3 * 0.02), 2e4 * kRounding);
  EXPECT_NEAR(dragged.pressure(0), 2000, 2e4 * kRounding) << "without grains";
}

TEST(WallPass, WallsMirrorTheVelocityUnlessFluidSlips) {
  Below b;
  b.pose[0].v = {Real(0.5), 0, 0};
  b.pressure(0);
  EXPECT_NEAR(b.no_slip[0].v.x, 2 * 0.5 - 1, 10 * kRounding);
  EXPECT_NEAR(b.no_slip[0].v.y, -2, 10 * kRounding);
  EXPECT_EQ(b.no_slip[0].mass, b.state[0].mass);
  b.pose[0].slip = 1;
  b.pressure(0);
  EXPECT_EQ(b.no_slip[0].mass, 0);
}

/// Push and damping of a single layer on fluid at (0.03, 0, 0.04) m that nears it at 1 m/s.
auto layer_gives(double cap, WallKind kind = WallKind::single_layer, std::uint32_t present = 1) {
  std::vector<LayerLaw> law{{{Real(2), Real(0.1), Real(1e30)}, {}}};
  std::vector<BodyPose> pose(1);
  pose[0].kind = kind, pose[0].present = present, pose[0].volume = 1e-3;
  const LayerForces<WendlandC2> forces{
      WendlandC2(0.05), {Real(0.2), 0, 20, Real(0.05)}, {law.data(), 1}, Real(cap), {pose.data(), 1}};
  const Real3 r{Real(0.03), 0, Real(0.04)};
  return forces({{Real(-0.6), 0, Real(-0.8)}, 1000}, {{}, 1000}, 0, r, norm2(r));
}

TEST(SingleLayer, PushesAlongTheLineOfCentresAsFarAsTheCap) {
  const double whole = 2 * (16 - 4) / 0.05;  // 480 m/s2
  for (const double cap : {1e30, 500.0, 100.0}) {
    const Vec3d push(layer_gives(cap).push);
    const double size = std::min(whole, cap);
    EXPECT_NEAR(push.x, 0.6 * size, 1e-5 * size) << cap;
    EXPECT_EQ(push.y, 0);
    EXPECT_NEAR(push.z, 0.8 * size, 1e-5 * size) << cap;
  }
}

TEST(SingleLayer, DampsByItsMassAndWhatIsNoLayerGivesNothing) {
  const auto given = layer_gives(100);
  // alpha c h / rho M F (v . r) / (r2 + 0.01 h2), M = rho0 V
  const double F = WendlandC2(0.05).F(Real(0.05)), v_r = -0.05;
  const double damping = -1.0 * F * 0.2 * 20 * 0.05 * v_r / (0.0025 * 1.01) / 1000;
  EXPECT_NEAR(given.damping.x / (damping * 0.03), 1, 1e-5);
  EXPECT_NEAR(given.damping.z / (damping * 0.04), 1, 1e-5);
  EXPECT_GT(damping, 0);
  for (const auto& none :
       {layer_gives(100, WallKind::extrapolated), layer_gives(100, WallKind::single_layer, 0)}) {
    EXPECT_EQ(norm(none.push), 0);
    EXPECT_EQ(norm(none.damping), 0);
  }
}

}  // namespace
}  // namespace BL_SOLVER
