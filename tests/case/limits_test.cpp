#include "bedload/case/limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bedload/case/config.hpp"
#include "bedload/case/parameters.hpp"

namespace bedload::test {
namespace {

/// A glass bead of 2.7 mm as in He et al. 2018; gravity makes sqrt(2 g R) = 0.1 m/s.
Config bead() {
  Config c;
  c.grain.present = true;
  c.grain.d_min = c.grain.d_max = 0.0027;
  c.gravity = {0, 0, -0.01 / 0.0027};
  return c;
}

TEST(Limits, NameKeysThatExist) {
  const auto rows = parameter_table();
  for (const NamedLimit& limit : kLimits)
    EXPECT_TRUE(limit.key.empty() ||
                std::ranges::any_of(rows, [&](const ParameterRow& row) { return row.key == limit.key; }))
        << limit.key;
}

TEST(GrainLimits, ReproduceTheReferenceTimesOfABead) {
  const Config c = bead();
  const auto limits = grain_limits(c);
  ASSERT_EQ(limits.size(), 3u);
  EXPECT_EQ(limits[0].limit, Limit::rayleigh);
  EXPECT_NEAR(limits[0].seconds / c.time.rayleigh, 3.6945e-5, 4e-9);
  EXPECT_EQ(limits[1].limit, Limit::contact);
  EXPECT_NEAR(limits[1].seconds / c.time.contact, 1.737e-4, 2e-7);
  EXPECT_EQ(limits[2].limit, Limit::rolling);
  EXPECT_FALSE(limits[0].binds);
  EXPECT_TRUE(limits[1].binds);
}

TEST(GrainLimits, LinearContactsLastHalfAPeriod) {
  Config c = bead();
  c.contact.normal = "linear";
  c.contact.k = 1e4;
  c.grain.e = 1;
  const double m = 2500 * 3.14159265 / 6 * 0.0027 * 0.0027 * 0.0027 / 2;
  EXPECT_NEAR(grain_limits(c)[1].seconds, 0.04 * 3.14159265 * std::sqrt(m / 1e4), 1e-12);
}

TEST(GrainLimits, AreShorterOnAHarderWall) {
  Config c = bead();
  const double among = grain_limits(c)[1].seconds;
  c.wall.bodies.emplace_back();
  EXPECT_EQ(grain_limits(c)[1].seconds, among);
  c.wall.bodies[0].E = 1e12;
  // twice the E*, R* and four times m^2 of a pair: (4 / 2 / 4)^(1/5)
  EXPECT_NEAR(grain_limits(c)[1].seconds / among, std::pow(0.5, 0.2), 1e-3);
  c.wall.bodies[0].E = 1e5;
  EXPECT_EQ(grain_limits(c)[1].seconds, among);
}

/// 0.2 (I / k_r)^(1/2), k_r = 2.25 S (mu_r R)^2 with the stiffness S of an impact.
double rolling(double mass, double R, double E, double mu_r, double inertia, double speed) {
  const double overlap = std::pow(15 * mass * speed * speed / (16 * E * std::sqrt(R)), 0.4);
  return 0.2 * std::sqrt(inertia / (2.25 * 2 * E * std::sqrt(R * overlap) * mu_r * mu_r * R * R));
}

TEST(GrainLimits, RollingGoesByTheSofterPartnersInSeries) {
  Config c = bead();
  c.grain.mu_r = 0.2;
  const double R = 0.00135, m = 2500 * 4 * 3.14159265358979 / 3 * R * R * R, I = 1.4 * m * R * R;
  const double E = c.grain.E / (1 - c.grain.nu * c.grain.nu), speed = std::sqrt(norm(c.gravity) * 2 * R);
  const double among = rolling(m / 2, R / 2, E / 2, 0.2, I / 2, speed);
  EXPECT_NEAR(grain_limits(c)[2].seconds / among, 1, 1e-9);
  WallBody& wall = c.wall.bodies.emplace_back();
  wall.E = 2 * c.grain.E, wall.mu_r = 0.5;
  EXPECT_NEAR(grain_limits(c)[2].seconds / rolling(m, R, E / 1.5, 0.5, I, speed), 1, 1e-9);
  wall.mu_r = std::numeric_limits<double>::quiet_NaN();  // that of the grains
  EXPECT_NEAR(grain_limits(c)[2].seconds / std::min(among, rolling(m, R, E / 1.5, 0.2, I, speed)), 1, 1e-9);
}

TEST(GrainLimits, AreNoneForGrainsThatNeverMove) {
  Config c = bead();
  c.grain.fixed = true;
  EXPECT_TRUE(grain_limits(c).empty());
}

}  // namespace
}  // namespace bedload::test
