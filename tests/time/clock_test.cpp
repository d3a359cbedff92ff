// Which limit a step takes.

#include "src/time/clock.hpp"

#include <gtest/gtest.h>

namespace bedload {
namespace {

TEST(Clock, TakesTheLeastLimitAndGrowsByFivePercentAtMost) {
  Clock clock{TimeConfig{}};
  Limit binding{};
  EXPECT_EQ(clock.next_dt({{Limit::cfl, 2e-3}, {Limit::body, 1e-3}}, binding), 1e-3);
  EXPECT_EQ(binding, Limit::body);
  clock.last_dt = 1e-3;
  EXPECT_DOUBLE_EQ(clock.next_dt({{Limit::cfl, 2e-3}, {Limit::body, 1.06e-3}}, binding), 1.05e-3);
  EXPECT_EQ(binding, Limit::growth);
  EXPECT_EQ(clock.next_dt({{Limit::cfl, 2e-3}, {Limit::body, 1.04e-3}}, binding), 1.04e-3);
  EXPECT_EQ(binding, Limit::body);
}

TEST(Clock, RefusesAFixedStepAboveALimitUnlessForced) {
  TimeConfig fixed;
  fixed.dt = 1e-3;
  Limit binding{};
  EXPECT_EQ(Clock(fixed).next_dt({{Limit::cfl, 1e-3}}, binding), 1e-3);
  EXPECT_EQ(binding, Limit::fixed);
  EXPECT_THROW(Clock(fixed).next_dt({{Limit::cfl, 0.99e-3}}, binding), KeyError);
  fixed.force_dt = true;
  EXPECT_EQ(Clock(fixed).next_dt({{Limit::cfl, 0.99e-3}}, binding), 1e-3);
}

}  // namespace
}  // namespace bedload
