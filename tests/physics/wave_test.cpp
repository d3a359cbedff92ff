// Waves of paddles, as high as asked for.

#include <algorithm>

#include "tests/boundaries/support.hpp"

namespace BL_SOLVER {
namespace {

/// Water 0.2 m deep before a paddle, 12 spacings; waves of 1 s are 1.2 m long.
std::string flume(const std::string& motion) {
  return R"(
[domain]
min = [-0.1, 0, 0]
max = [2, 0.01, 0.4]
two_d = true
[fluid]
dx = 0.01666666667
[[fluid.fill]]
min = [0, 0, 0]
max = [2, 0.01, 0.2]
[[wall.body]]
name = "tank"
shape = "tank"
min = [-0.1, 0, 0]
max = [2, 0.01, 0.4]
faces = ["x-", "x+", "z-", "z+"]
[[wall.body]]
name = "paddle"
shape = "box"
min = [-0.07, 0, 0]
max = [0, 0.01, 0.36]
[wall.body.motion]
wave_height = 0.06
wave_period = 1
wave_depth = 0.2
)" + motion +
         R"([time]
end = 4
[out]
every = 4
)";
}

/// From the lowest to the highest surface at x = 0.6 m in one period, before waves are reflected to there.
double height_of_waves(const std::string& motion) {
  const auto s = started(flume(motion));
  ProbeConfig gauge;
  gauge.name = "gauge", gauge.type = "height";
  gauge.at = {0.6, 0.005, 0};
  run_until(*s, 1.6);
  double low = 1, high = 0;
  while (s->time() < 2.6) {
    for (int n = 0; n < 10; ++n) s->step();
    const double level = reading(s->measure(gauge), "column_depth");
    low = std::min(low, level), high = std::max(high, level);
  }
  return high - low;
}

TEST(SlowWavePaddles, PistonsMakeWavesOfTheHeightAskedFor) {
  EXPECT_NEAR(height_of_waves("kind = \"piston\"\n"), 0.06, 0.009);
}

TEST(SlowWavePaddles, FlapsMakeWavesOfTheHeightAskedFor) {
  EXPECT_NEAR(height_of_waves("kind = \"flap\"\ncentre = [0, 0, 0]\n"), 0.06, 0.009);
}

}  // namespace
}  // namespace BL_SOLVER
