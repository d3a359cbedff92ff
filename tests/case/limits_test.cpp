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

TEST(GrainLimits, AreNoneForGrainsThatNeverMove) {
  Config c = bead();
  c.grain.fixed = true;
  EXPECT_TRUE(grain_limits(c).empty());
}

}  // namespace
}  // namespace bedload::test
