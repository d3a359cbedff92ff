// Flow between plates: exact solutions, in units of the lattice.

#include "support.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr int kGap = 10;
constexpr double kTop = 0.05;  // largest velocity

LatticeParameters driven(double tau, double magic) {
  LatticeParameters p = lattice_units(tau, magic);
  p.drive.f = {8 * (tau - 0.5) / 3 * kTop / (kGap * kGap), 0, 0};
  p.walls.resize(2, {MotionLaw({}, 0), {}});
  return p;
}

/// Parabola between walls half-way between nodes.
double parabola(int node) {
  const double s = (node - 0.5) / kGap;
  return 4 * kTop * s * (1 - s);
}

TEST(LatticeChannel, PoiseuilleFlowIsAParabolaAtAnyViscosity) {
  for (const double tau : {0.6, 1.0, 2.0}) {
    LatticeFlow flow(driven(tau, 3.0 / 16), channel_nodes(kGap));
    flow.run(std::int64_t(700 / (tau - 0.5)));
    const auto u = flow.velocity();
    for (int k = 1; k <= kGap; ++k)
      EXPECT_NEAR(u[std::size_t(k)].x, parabola(k), tolerance(1e-9, 1e-5, 1e-5) * kTop) << tau << ' ' << k;
    const double force = flow.solver().wall(0, 0).force.x + flow.solver().wall(1, 0).force.x;
    EXPECT_NEAR(force / (driven(tau, 0.1).drive.f.x * kGap), 1, tolerance(1e-9, 1e-4, 1e-4));
  }
}

/// By (16 magic - 3) / (3 H^2) of the largest velocity, everywhere.
TEST(LatticeChannel, OtherMagicNumbersShiftTheWalls) {
  for (const double tau : {0.6, 2.0}) {
    LatticeFlow flow(driven(tau, 0.25), channel_nodes(kGap));
    flow.run(std::int64_t(700 / (tau - 0.5)));
    const auto u = flow.velocity();
    for (int k = 1; k <= kGap; ++k)
      EXPECT_NEAR(u[std::size_t(k)].x - parabola(k), kTop / (3 * kGap * kGap),
                  tolerance(1e-9, 1e-5, 1e-5) * kTop);
  }
}

TEST(LatticeChannel, CouetteFlowIsLinearThroughTheWallsWhereverTheyLie) {
  for (const double q : {0.1, 0.3, 0.5, 0.7, 0.9, 1.0}) {
    LatticeParameters p = lattice_units(0.8);
    p.walls = {{MotionLaw({}, 0), {}}, {MotionLaw({}, 0), {kTop, 0, 0}}};
    LatticeFlow flow(p, channel_nodes(kGap, q));
    flow.run(4000);
    const auto u = flow.velocity();
    const double gap = kGap - 1 + 2 * q;
    for (int k = 1; k <= kGap; ++k)
      EXPECT_NEAR(u[std::size_t(k)].x / kTop, (k - 1 + q) / gap, tolerance(1e-6, 1e-5, 1e-5))
          << q << ' ' << k;
    const double stress = (0.8 - 0.5) / 3 * kTop / gap;
    EXPECT_NEAR(flow.solver().wall(0, 0).force.x / stress, 1, tolerance(1e-6, 1e-4, 1e-4)) << q;
    EXPECT_NEAR(flow.solver().wall(1, 0).force.x / stress, -1, tolerance(1e-6, 1e-4, 1e-4)) << q;
  }
}

/// From rest, against the series.
TEST(LatticeChannel, PoiseuilleFlowStartsAsInTheSeries) {
  const double tau = 0.8, nu = (tau - 0.5) / 3;
  constexpr int gap = 20;
  LatticeParameters p = driven(tau, 3.0 / 16);
  p.drive.f = {8 * nu * kTop / (gap * gap), 0, 0};
  LatticeFlow flow(p, channel_nodes(gap));
  for (const double scaled : {0.02, 0.05, 0.1, 0.3}) {  // nu t / H^2
    flow.run(std::int64_t(scaled * gap * gap / nu) - std::int64_t(flow.time()));
    const auto u = flow.velocity();
    for (int k = 1; k <= gap; ++k) {
      const double s = (k - 0.5) / gap;
      double exact = 4 * s * (1 - s);
      for (int n = 1; n < 60; n += 2) {
        const double a = n * M_PI;
        exact -= 32 / (a * a * a) * std::sin(a * s) * std::exp(-a * a * nu * flow.time() / (gap * gap));
      }
      EXPECT_NEAR(u[std::size_t(k)].x / kTop, exact, 0.005) << scaled << ' ' << k;
    }
  }
}

/// Stokes' second problem: a plate that oscillates in its plane, the other far away.
TEST(LatticeChannel, FluidFollowsAnOscillatingPlate) {
  const double tau = 1, nu = (tau - 0.5) / 3, depth = 8, omega = 2 * nu / (depth * depth);
  MotionConfig motion;
  motion.kind = MotionKind::oscillation;
  motion.amplitude = {kTop / omega, 0, 0};
  motion.frequency = omega / (2 * M_PI);
  LatticeParameters p = lattice_units(tau);
  p.walls = {{MotionLaw(motion, 1e9), {}}, {MotionLaw({}, 0), {}}};
  LatticeFlow flow(p, channel_nodes(64));
  flow.run(std::int64_t(8 * 2 * M_PI / omega));
  for (int phase = 0; phase < 4; ++phase) {
    flow.run(std::int64_t(0.5 * M_PI / omega));
    const auto u = flow.velocity();
    for (int k = 1; k <= 40; ++k) {
      const double z = (k - 0.5) / depth;
      EXPECT_NEAR(u[std::size_t(k)].x / kTop, std::exp(-z) * std::cos(omega * flow.time() - z), 0.01)
          << phase << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace BL_SOLVER
