// Fluid that comes into a plane flow and leaves it, beside the same in a slab of eight layers.

#include <cmath>

#include "tests/boundaries/support.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kWidth = 0.08, kRate = 0.0032, kLayer = 64e-3;  // m, m3/s, kg
constexpr int kLayers = 8;                                       // of the slab

/// A channel of 0.08 m between two walls; inlet at x = 0, outlet from x = 0.2 on.
std::string channel(bool plane) {
  return std::string(R"(gravity = [0, 0, 0]
[domain]
min = [-0.06, 0, -0.05]
max = [0.3, 0.08, 0.13]
)") + (plane ? "two_d = true" : "periodic = [false, true, false]") +
         R"(
[fluid]
dx = 0.01
vmax = 1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.2, 0.08, 0.08]
velocity = [0.5, 0, 0]
[[inlet]]
name = "feed"
shape = "rectangle"
centre = [0, )" +
         (plane ? "3" : "0.04") + R"(, 0.04]
direction = [1, 0, 0]
half_a = [0, )" +
         (plane ? "-7" : "0.04") + R"(, 0]
half_b = [0, 0, 0.04]
rate = 0.0032
ramp = 1e-6
[[outlet]]
name = "end"
shape = "plane"
point = [0.2, 0, 0]
normal = [1, 0, 0]
[[wall.body]]
name = "channel"
shape = "tank"
slip = "slip"
min = [-0.06, 0, 0]
max = [0.3, 0.08, 0.08]
faces = ["z-", "z+"]
[time]
end = 1
[out]
every = 1
)";
}

TEST(PlaneInlet, LetsInTheVolumeOfItsRate) {
  auto s = started(channel(true));
  const double initial = reading(*s, "fluid_mass");
  EXPECT_NEAR(initial, 1000 * 0.2 * kWidth * kWidth, 1e-6);
  run_until(*s, 0.3);
  const auto d = s->diagnostics();
  const double in = reading(d, "inlet_feed_mass"), asked = 1000 * kRate * s->time();
  EXPECT_NEAR(reading(d, "inlet_feed_volume"), kRate * s->time(), 1e-8);
  EXPECT_NEAR(in, asked, 0.51 * kLayer);
  EXPECT_NEAR(std::fmod(in / kLayer + 0.5, 1), 0.5, 1e-9) << "whole layers";
  EXPECT_NEAR(initial + in,
              reading(d, "fluid_mass") + reading(d, "outlet_end_fluid_mass") + reading(d, "lost_fluid_mass"),
              tolerance(1e-9, 1e-6, 1e-6) * (initial + in));
  EXPECT_EQ(reading(d, "lost_fluid_count"), 0);
  const HostStore fluid = s->snapshot("fluid");
  const HostArray& x = *fluid.find("position");
  const auto* v = fluid.find("velocity")->as<Real>();
  double worst = 0;
  for (std::size_t a = 0; a < fluid.count; ++a) {
    const double y = x.type == Scalar::f64 ? x.as<double>()[3 * a + 1] : x.as<float>()[3 * a + 1];
    EXPECT_NEAR(y, kWidth / 2, 1e-6);
    worst = std::max(worst, std::abs(v[3 * a] / 0.5 - 1));
  }
  EXPECT_LT(worst, 0.05) << "runs on uniformly";
}

TEST(PlaneInlet, IsOneLayerOfThatOfASlab) {
  auto plane = started(channel(true)), slab = started(channel(false));
  for (const double t : {0.1, 0.2, 0.4}) {
    run_until(*plane, t), run_until(*slab, t);
    const auto p = plane->diagnostics(), s = slab->diagnostics();
    for (const char* what : {"fluid_count", "outlet_end_fluid_count"})
      EXPECT_NEAR(kLayers * reading(p, what), reading(s, what), 64) << what << ": a layer of the inlet";
    for (const char* what : {"fluid_mass", "inlet_feed_mass", "outlet_end_fluid_mass"})
      EXPECT_NEAR(reading(p, what), reading(s, what), 1.01 * kLayer) << what;
    EXPECT_NEAR(reading(p, "fluid_momentum_x") / reading(s, "fluid_momentum_x"), 1, 0.05);
  }
}

/// What waits in the orifice sets water that rests before it going as in the slab.
TEST(PlaneInlet, PushesTheWaterBeforeItAsThatOfASlab) {
  const auto from_rest = [](bool plane) {
    std::string text = channel(plane);
    for (const std::string away : {"velocity = [0.5, 0, 0]\n", "ramp = 1e-6\n"})
      text.erase(text.find(away), away.size());
    return started(text);
  };
  auto plane = from_rest(true), slab = from_rest(false);
  for (const double t : {0.01, 0.02, 0.03}) {
    run_until(*plane, t), run_until(*slab, t);
    for (const char* what : {"fluid_momentum_x", "fluid_kinetic_energy", "pressure_max"})
      EXPECT_NEAR(reading(*plane, what) / reading(*slab, what), 1, 0.05) << what << " at " << t;
  }
}

TEST(PlaneInlet, AndABodyGoOnBitForBitAfterARestart) {
  const Config config = config_of(channel(true) + R"([[wall.body]]
name = "log"
shape = "box"
min = [0.06, 0, 0.03]
max = [0.11, 0, 0.06]
[wall.body.free]
density = 700
velocity = [0.5, 0, 0.1]
spin = [0, 3, 0]
)");
  auto s = started(config);
  run_until(*s, 0.06);
  ASSERT_GT(reading(*s, "inlet_feed_mass"), 0);
  ASSERT_GT(std::abs(reading(s->body_state(1), "force_by_fluid_x")), 0);
  expect_restart_is_bit_equal(*s, config, 100);
}

}  // namespace
}  // namespace BL_SOLVER
