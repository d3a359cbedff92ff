#include "bench_rows.hpp"

#include <fmt/format.h>

#include <cmath>

namespace bedload {
namespace {

const std::vector<std::string> kPeers = {"fluid.h_over_dx=1.3", "density.delta=0",
                                         "density.void_relaxation=0", "shift.A=0", "pressure.damper=0"};

/// A column of 146 x 292 mm in a tank 584 mm long and high; the width sets the size.
constexpr const char* kDamBreak = R"([domain]
min = [-0.04, -0.04, -0.04]
max = [0.624, {1}, 1.2]
[fluid]
dx = 0.004
[[fluid.fill]]
min = [0, 0, 0]
max = [0.146, {0}, 0.292]
[visc]
alpha = 0.02
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.584, {0}, 0.584]
faces = ["x-", "x+", "y-", "y+", "z-"]
[time]
end = 10
[out]
every = 1
)";

/// Equal frictional spheres that settle in a box.
constexpr const char* kSpheres = R"([domain]
min = [-0.01, -0.01, -0.01]
max = [{1}, {1}, {3}]
[grain]
d = 0.0027
[[grain.fill]]
min = [0, 0, 0]
max = [{0}, {0}, {2}]
count = {4}
[[wall.body]]
name = "box"
shape = "tank"
type = "grains_only"
min = [0, 0, 0]
max = [{0}, {0}, {2}]
faces = ["x-", "x+", "y-", "y+", "z-"]
[time]
end = 10
[out]
every = 1
)";

/// Water in a box over and in a bed of glass beads.
constexpr const char* kCoupled = R"([domain]
min = [-0.03, -0.03, -0.03]
max = [{1}, {1}, {3}]
[fluid]
dx = 0.003
[[fluid.fill]]
min = [0, 0, 0]
max = [{0}, {0}, {2}]
[visc]
alpha = 0.02
[grain]
d = 0.0027
{6}
[[grain.fill]]
min = [0, 0, 0]
max = [{0}, {0}, {4}]
count = {5}
[[wall.body]]
name = "box"
shape = "tank"
min = [0, 0, 0]
max = [{0}, {0}, {3}]
faces = ["x-", "x+", "y-", "y+", "z-"]
[time]
end = 10
[out]
every = 1
)";

/// Of a box `side` wide and long that `count` beads fill to 35 %, m.
double bed_height(int count, double side) {
  return count * 3.14159265 / 6 * std::pow(0.0027, 3) / 0.35 / (side * side);
}

BenchRow spheres(const std::string& name, int count, double side) {
  const double height = bed_height(count, side);
  return {name, fmt::format(kSpheres, side, side + 0.01, height, height + 0.1, count), {}};
}

BenchRow coupled(const std::string& name, double side, double depth, int count, bool settle) {
  return {name,
          fmt::format(kCoupled, side, side + 0.03, depth, depth + 0.1, bed_height(count, side), count,
                      settle ? "settle = true\nsettle_time = 0.15" : ""),
          kPeers};
}

}  // namespace

BenchRow widened_dam_break(const std::string& name, double width) {
  std::vector<std::string> settings = kPeers;
  settings.push_back("time.integrator=ab3");
  return {name, fmt::format(kDamBreak, width, width + 0.04), settings};
}

std::vector<BenchRow> bench_rows() {
  return {widened_dam_break("0.1M", 0.152),
          widened_dam_break("1M", 1.62),
          widened_dam_break("5M", 8.1),
          widened_dam_break("8M", 12.8),
          widened_dam_break("14M", 22.6),
          spheres("spheres-8.8k", 8800, 0.08),
          spheres("spheres-1M", 1000000, 0.3),
          coupled("coupled", 0.12, 0.189, 10000, true),
          coupled("coupled-10M", 0.6, 0.75, 2000000, false)};
}

}  // namespace bedload
