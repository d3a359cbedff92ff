// Kicks, drift and state of one fluid particle, by hand.

#include <gtest/gtest.h>

#include "kernels/integrate/fluid_kicks.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kKick = 0.02, kRounding = tolerance(1e-12, 1e-6, 1e-6);
const Frame kFrame{{-4, -4, -4}, {4, 4, 4}, false, false, false};

/// One particle that moves at v and is accelerated.
struct Lone {
  std::vector<Real3> acc{{1, -2, 3}}, reaction{{Real(0.5), 0, -1}}, beside{{0, Real(0.25), 0}};
  std::vector<VelocityDensity<>> v_rho{{{4, 5, -6}, 1000}}, flux{{{2, 1, -3}, 1000}};
  std::vector<EosState<>> eos_state{{}};
  std::vector<FluidPosition> x{as_position<FluidPosition>(kFrame, {1, 0.5, -0.25})};
  std::vector<PairPosition> xp{pair_position(kFrame, {}, 7)}, xp_mid = xp;
  std::vector<Real> s{Real(0.01)}, mass{3}, eps{Real(0.6)}, p_rho2{0}, continuity{-2}, rate{Real(0.5)};

  template <class T>
  static Span<T> all(std::vector<T>& of) {
    return {of.data(), 1};
  }
  template <class T>
  static Span<const T> read(const std::vector<T>& of) {
    return {of.data(), 1};
  }
  FluidMotion motion() { return {kFrame, {}, all(x), all(v_rho)}; }
  StatePass state() {
    return {.fluid = motion(),
            .eos = {Real(1e6), 7, 0, 1000, false},
            .damping = 250,
            .compression_rate = read(continuity),
            .history = {read(rate), {}, {}, 0.01, 0, 0},
            .kick = Real(kKick),
            .acc = read(acc),
            .reaction = read(reaction),
            .compression = all(s),
            .mass = read(mass),
            .eps = read(eps),
            .flux = all(flux),
            .eos_state = all(eos_state),
            .p_rho2 = all(p_rho2)};
  }
  KickDriftPass kick_drift(double drift, double back) {
    return {.fluid = motion(),
            .copies = {all(xp), all(xp_mid), {}},
            .kick = Real(kKick),
            .drift = Real(drift),
            .back = Real(back),
            .acc = read(acc),
            .reaction = read(reaction),
            .beside = read(beside),
            .edges = {}};
  }
};

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << "xyz"[k];
}

const Vec3d kAcc{1.5, -2, 2};  // acc + reaction

TEST(FluidState, FluxGainsWhatTheVelocityGainsTimesThePorosity) {
  Lone p;
  p.state()(0);
  expect_near(Vec3d(p.v_rho[0].v), Vec3d{4, 5, -6} + kKick * kAcc, 10 * kRounding);
  expect_near(Vec3d(p.flux[0].v), Vec3d{2, 1, -3} + 0.6 * kKick * kAcc, 10 * kRounding);
  EXPECT_EQ(p.flux[0].rho, p.v_rho[0].rho);
}

TEST(FluidState, FollowsFromTheCompressionAndTheDamper) {
  Lone p;
  p.state()(0);
  const double s = 0.01 + 0.01 * 0.5, rho = 1000 * (1 + s);
  EXPECT_NEAR(p.s[0], s, kRounding);
  EXPECT_NEAR(p.v_rho[0].rho, rho, 1e3 * kRounding);
  const double pressure = 1e6 * (std::pow(1 + s, 7) - 1) - 250 * 2;
  EXPECT_NEAR(p.eos_state[0].p_over_rho2 * rho * rho, pressure, 3e6 * kRounding);
  EXPECT_EQ(p.p_rho2[0], p.eos_state[0].p_over_rho2);
  EXPECT_NEAR(p.eos_state[0].mass_over_eps, 3 / 0.6, 10 * kRounding);
  EXPECT_NEAR(p.eos_state[0].rho, rho, 1e3 * kRounding);
  EXPECT_NEAR(p.eos_state[0].eps, 0.6, kRounding);
}

TEST(FluidState, NoFluidIsThinnerThanHalf) {
  Lone p;
  p.s[0] = Real(-0.499), p.rate[0] = -5;
  p.state()(0);
  EXPECT_EQ(p.s[0], Real(-0.5));
}

TEST(FluidKick, DriftsWithTheKickedVelocityAndWhatMovesItBeside) {
  Lone p;
  p.kick_drift(0.1, 0)(0);
  const Vec3d v = Vec3d{4, 5, -6} + kKick * kAcc;
  const double near = tolerance(1e-12, 1e-6, 8 * 2e-7);
  expect_near(Vec3d(p.v_rho[0].v), v, 10 * kRounding);
  expect_near(coordinates(kFrame, p.x[0]), Vec3d{1, 0.5, -0.25} + 0.1 * (v + Vec3d{0, 0.25, 0}), near);
}

TEST(FluidKick, WithoutDriftNothingMoves) {
  Lone p;
  p.kick_drift(0, 0)(0);
  expect_near(Vec3d(p.v_rho[0].v), Vec3d{4, 5, -6} + kKick * kAcc, 10 * kRounding);
  expect_near(coordinates(kFrame, p.x[0]), {1, 0.5, -0.25}, tolerance(0, 0, 1e-6));
}

/// For pair loops: where the particle is, and where it was in the middle of the step, a time `back` before.
TEST(FluidKick, PacksPositionsOfTheEndAndOfTheMiddleOfTheStep) {
  Lone p;
  p.kick_drift(0.1, 0.05)(0);
  const Vec3d v(p.v_rho[0].v), end = coordinates(kFrame, p.x[0]);
  const auto apart = [&](const PairPosition& packed, const Vec3d& at) {
    return norm(Real3(kFrame.separation(packed, pair_position(kFrame, at, 0))));
  };
  EXPECT_LT(apart(p.xp[0], end), tolerance(1e-12, 1e-5, 1e-5));
  EXPECT_LT(apart(p.xp_mid[0], end - 0.05 * v), tolerance(1e-12, 1e-5, 1e-5));
  EXPECT_EQ(p.xp[0].weight, 7);
  EXPECT_EQ(p.xp_mid[0].weight, 7);
}

}  // namespace
}  // namespace BL_SOLVER
