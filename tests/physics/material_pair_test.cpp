// Blocks of three materials on one wall: each slides where the slope exceeds the friction of its pair.

#include <gtest/gtest.h>

#include "tests/support/free_body.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kG = 9.81, kFriction[] = {0.2, 0.35, 0.5};

/// Speeds of the blocks after 0.1 s on a plane whose slope is tan(theta).
std::vector<double> speeds(double slope) {
  constexpr double d = 2e-3;
  Config c = void_case();
  c.domain.min = {-0.1, -0.1, -0.1}, c.domain.max = {0.1, 0.1, 0.1};
  const double theta = std::atan(slope);
  c.gravity = {kG * std::sin(theta), 0, -kG * std::cos(theta)};
  c.wall.bodies = {ground()};
  c.grain.present = true;
  c.grain.d = c.grain.d_min = c.grain.d_max = d;
  c.grain.mu = 1, c.grain.e = 0.2;
  c.grain.materials = {{"steel"}, {"rubber"}};
  c.grain.fills.resize(3);
  bedload::Setup setup;
  const char* const names[] = {"", "steel", "rubber"};
  for (std::uint32_t k = 0; k < 3; ++k) {
    GrainFill& fill = c.grain.fills[k];
    fill.material = names[k];
    fill.rigid.present = true, fill.rigid.turn = "none";
    ContactPair pair{{k == 0 ? "grain" : names[k], "plane"}};
    pair.mu = kFriction[k];
    c.contact.pairs.push_back(pair);
    for (const double x : {0.0, 1.0})
      for (const double y : {0.0, 1.0}) {
        setup.grains.x.push_back({x * d, y * d + 0.02 * k, d / 2});
        setup.grains.v.push_back({});
        setup.grains.radius.push_back(d / 2);
        setup.grains.fill.push_back(k);
      }
  }
  auto s = started(c, setup);
  run_until(*s, 0.1);
  std::vector<double> out;
  for (int k = 0; k < 3; ++k) out.push_back(reading(s->body_state(k + 1), "velocity_x"));
  return out;
}

TEST(MaterialPairs, SlideWhereTheSlopeExceedsTheirFriction) {
  for (int k = 0; k < 3; ++k) {
    const double mu = kFriction[k];
    const std::vector<double> holds = speeds(0.995 * mu), slides = speeds(1.005 * mu);
    for (int other = k; other < 3; ++other) EXPECT_LT(std::abs(holds[other]), 1e-4) << k << ", " << other;
    for (int other = k + 1; other < 3; ++other)
      EXPECT_LT(std::abs(slides[other]), 1e-4) << k << ", " << other;
    EXPECT_NEAR(slides[k] / (0.1 * kG * 0.005 * mu * std::cos(std::atan(mu))), 1, 0.1) << k;
  }
}

}  // namespace
}  // namespace BL_SOLVER
