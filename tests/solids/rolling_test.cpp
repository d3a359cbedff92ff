// A sphere on a plane: sliding, rolling, stopping, resting.
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kG = 9.81;

/// A grain at rest on the plane z = 0, which gravity meets at the angle theta.
struct OnPlane : GrainBench {
  explicit OnPlane(double theta = 0, double speed = 0, double spin = 0) {
    config.gravity = {kG * std::sin(theta), 0, -kG * std::cos(theta)};
    plane({0, 0, 0}, {0, 0, 1});
    add({0, 0, R() - resting_overlap(mass() * kG * std::cos(theta))}, {speed, 0, 0}, {0, spin, 0});
  }
  /// The rolling couple about y over its limit.
  double couple() const {
    const double f_t = force().x, limit = config.grain.mu_r * R() * force().z;
    return (torque().y + R() * f_t) / limit;  // torque = - R n x F_t + M
  }
};

TEST(Rolling, SlidingSphereEndsInPureRolling) {
  const double v0 = 0.1;
  OnPlane b(0, v0);
  b.start();
  const double dt = 1e-6, expected = 2 * v0 / (7 * b.config.grain.mu * kG);
  double t = 0;
  while (t < 2 * expected && b.velocity().x - b.spin().y * b.R() > 2e-3 * v0) b.run(dt, 10), t += 10 * dt;
  EXPECT_NEAR(t / expected, 1, 5e-3);
  b.run(dt, 1000);
  EXPECT_NEAR(b.velocity().x / v0, 5.0 / 7, 5e-3 * 5 / 7);
}

TEST(Rolling, RollsDownAnInclineAtFiveSevenths) {
  const double theta = std::atan(0.9 * 3.5 * 0.3);  // just below 7 mu / 2
  OnPlane b(theta);
  b.start();
  b.run(5e-6, 2000);
  const double v1 = b.velocity().x;
  b.run(5e-6, 4000);
  EXPECT_NEAR((b.velocity().x - v1) / 0.02 / (5.0 / 7 * kG * std::sin(theta)), 1, 1e-2);
}

TEST(Rolling, ElasticPlasticCoupleHoldsSlopesBelowItsCoefficient) {
  for (double slope : {0.18, 0.25}) {
    OnPlane b(std::atan(slope));
    b.config.contact.rolling = "epsd";
    b.config.grain.mu_r = 0.2;
    b.start();
    b.run(5e-6, 20000);
    if (slope < 0.2) {
      EXPECT_LT(norm(b.velocity()), 1e-6);
      EXPECT_LT(b.position().x, 0.01 * b.R());
    } else {
      EXPECT_GT(b.velocity().x, 1e-2);
    }
  }
}

TEST(Rolling, StopsAfterTheDistanceOfItsRollingFriction) {
  const double v0 = 0.1;
  OnPlane b(0, v0, v0 / (1.35e-3));
  b.config.contact.rolling = "epsd";
  b.config.grain.mu_r = 0.05;
  b.start();
  b.run(1e-5, 32000);
  EXPECT_LT(norm(b.velocity()), 1e-5);
  EXPECT_NEAR(b.position().x / (0.7 * v0 * v0 / (b.config.grain.mu_r * kG)), 1, 3e-2);
}

/// Root mean square of the rolling couple of a grain that came to rest, over its limit.
double resting_couple(const char* law, bool cap) {
  OnPlane b(0, 5e-3, 5e-3 / 1.35e-3);
  b.config.contact.rolling = law;
  b.config.contact.cap_rolling = cap;
  b.config.grain.mu_r = 0.05;
  b.start();
  b.run(1e-5, 30000);
  double sum = 0;
  for (int k = 0; k < 100; ++k) {
    b.run(1e-5, 1);
    sum += b.couple() * b.couple();
  }
  return std::sqrt(sum / 100);
}

TEST(Rolling, RestingGrainFeelsNoRollingCouple) {
  EXPECT_LT(resting_couple("epsd", true), 1e-3);
  EXPECT_LT(resting_couple("cdt", true), 1e-3);
}

TEST(Rolling, UncappedConstantCoupleBuzzesAtItsLimit) {
  const double couple = resting_couple("cdt", false);
  EXPECT_GT(couple, 0.8);
  EXPECT_LT(couple, 1.05);
}

TEST(Rolling, BeltDragsTheGrainUntilItRolls) {
  // the wall moves: slip acts until v + omega R = V, at v = 2/7 V
  OnPlane b;
  const double V = 0.1;
  b.motion = [&](int, double t) {
    BodyPose pose;
    pose.translation = {V * t, 0, 0};
    pose.v = {V, 0, 0};
    return pose;
  };
  b.start();
  b.run(2e-6, 10000);
  EXPECT_NEAR(b.velocity().x / V, 2.0 / 7, 2e-3);
  EXPECT_NEAR(-b.spin().y * b.R() / V, 5.0 / 7, 5e-3);
}

}  // namespace
}  // namespace BL_SOLVER
