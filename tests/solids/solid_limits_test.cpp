#include <gtest/gtest.h>

#include <map>

#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

std::map<Limit, double> limits(const GrainBench& b) {
  std::map<Limit, double> out;
  for (const auto& l : b.solver->limits(b.solver->watch(*b.grains))) out[l.limit] = l.seconds;
  return out;
}

TEST(SolidLimits, RayleighTimeOfThePapersGrain) {
  GrainBench b;
  b.config.time.rayleigh = 1;
  b.add({0, 0, 0});
  b.start();
  EXPECT_NEAR(limits(b)[Limit::rayleigh] / 3.6945e-5, 1, 1e-4);
}

TEST(SolidLimits, ContactTimeUsesTheFastestGrainAndAtLeastFreeFallOverADiameter) {
  GrainBench b;
  b.config.gravity = {0, 0, -9.81};
  b.add({0, 0, 0}, {0.05, 0, 0});
  b.start();
  EXPECT_NEAR(limits(b)[Limit::contact] / (0.04 * b.contact_time(std::sqrt(9.81 * 2.7e-3))), 1, 1e-3);
  GrainBench fast;
  fast.add({0, 0, 0}, {0.5, 0, 0});
  fast.start();
  EXPECT_NEAR(limits(fast)[Limit::contact] / (0.04 * fast.contact_time(1.0)), 1, 1e-3);
}

TEST(SolidLimits, LinearSpringAndRollingLimits) {
  GrainBench b;
  b.config.contact.normal = NormalLaw::linear, b.config.contact.tangential = SlidingLaw::linear;
  b.config.contact.rolling = "epsd";
  b.config.contact.k = 1e3;
  b.config.grain.mu_r = 1;
  b.config.grain.e = 1;
  b.add({0, 0, 0});
  b.start();
  EXPECT_NEAR(limits(b)[Limit::contact] / (0.04 * M_PI * std::sqrt(0.5 * b.mass() / 1e3)), 1, 1e-6);
  const double I_r = 0.7 * b.mass() * b.R() * b.R(), k_r = 2.25 * 1e3 * b.R() * b.R() / 4;
  EXPECT_NEAR(limits(b)[Limit::rolling] / (0.2 * std::sqrt(I_r / k_r)), 1, 1e-6);
  const StepLimit s = b.solver->stable_dt(*b.grains);
  double least = 1;
  for (const auto& [limit, seconds] : limits(b)) least = std::min(least, seconds);
  EXPECT_EQ(s.seconds, least);
  EXPECT_EQ(limits(b)[s.limit], least);
}

TEST(SolidLimits, TheSmallestGrainDecides) {
  GrainBench b;
  b.config.time.rayleigh = 1;
  b.add({0, 0, 0});
  b.add({0.01, 0, 0}, {}, {}, 0.5e-3);
  b.start();
  EXPECT_NEAR(limits(b)[Limit::rayleigh] / (3.6945e-5 * 0.5 / 1.35), 1, 1e-4);
}

}  // namespace
}  // namespace BL_SOLVER
