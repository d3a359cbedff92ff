#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "tests/support/free_body.hpp"
#include "tests/support/grain_bench.hpp"

namespace bedload::inline BL_VARIANT {
namespace {

std::map<std::string, double> limits(const GrainBench& b) {
  std::map<std::string, double> out;
  for (const auto& l : b.solver->limits(b.solver->watch(*b.grains))) out[l.name] = l.seconds;
  return out;
}

TEST(SolidLimits, RayleighTimeOfThePapersGrain) {
  GrainBench b;
  b.config.time.rayleigh = 1;
  b.add({0, 0, 0});
  b.start();
  EXPECT_NEAR(limits(b)["rayleigh"] / 3.6945e-5, 1, 1e-4);
}

TEST(SolidLimits, ContactTimeUsesTheFastestGrainAndAtLeastFreeFallOverADiameter) {
  GrainBench b;
  b.config.gravity = {0, 0, -9.81};
  b.add({0, 0, 0}, {0.05, 0, 0});
  b.start();
  EXPECT_NEAR(limits(b)["contact"] / (0.04 * b.contact_time(std::sqrt(9.81 * 2.7e-3))), 1, 1e-3);
  GrainBench fast;
  fast.add({0, 0, 0}, {0.5, 0, 0});
  fast.start();
  EXPECT_NEAR(limits(fast)["contact"] / (0.04 * fast.contact_time(1.0)), 1, 1e-3);
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
  EXPECT_NEAR(limits(b)["contact"] / (0.04 * M_PI * std::sqrt(0.5 * b.mass() / 1e3)), 1, 1e-6);
  const double I_r = 0.7 * b.mass() * b.R() * b.R(), k_r = 2.25 * 1e3 * b.R() * b.R() / 4;
  EXPECT_NEAR(limits(b)["rolling"] / (0.2 * std::sqrt(I_r / k_r)), 1, 1e-6);
  const StableStep s = b.solver->stable_dt(*b.grains);
  double least = 1;
  for (const auto& [name, seconds] : limits(b)) least = std::min(least, seconds);
  EXPECT_EQ(s.seconds, least);
  EXPECT_EQ(limits(b)[std::string(s.limit)], least);
}

/// A run of grains alone names what binds its steps.
TEST(SolidLimits, AreNamedByTheStepsThatTheyBind) {
  const auto binding = [](const std::function<void(Config&)>& set, double speed = 0.01) {
    Config c = void_case();
    c.gravity = {0, 0, -9.81};
    c.grain.present = true;
    c.grain.d = c.grain.d_min = c.grain.d_max = 2.7e-3;
    set(c);
    bedload::Setup setup;
    setup.grains.x = {{0, 0, 0}, {0.1, 0, 0}};
    setup.grains.v = {{0, 0, speed}, {}};
    setup.grains.radius = {1.35e-3, 1.35e-3};
    auto s = started(c, setup);
    return std::string(s->step().limit);
  };
  EXPECT_EQ(binding([](Config&) {}), "contact");
  EXPECT_EQ(binding([](Config& c) { c.time.rayleigh = 1e-3; }), "rayleigh");
  EXPECT_EQ(binding([](Config& c) {
              c.contact.rolling = "epsd";
              c.grain.mu_r = 1000;
            }),
            "rolling");
  EXPECT_EQ(binding([](Config&) {}, 1000), "travel");
}

TEST(SolidLimits, TheSmallestGrainDecides) {
  GrainBench b;
  b.config.time.rayleigh = 1;
  b.add({0, 0, 0});
  b.add({0.01, 0, 0}, {}, {}, 0.5e-3);
  b.start();
  EXPECT_NEAR(limits(b)["rayleigh"] / (3.6945e-5 * 0.5 / 1.35), 1, 1e-4);
}

}  // namespace
}  // namespace bedload::inline BL_VARIANT
