#include "benchmarks.hpp"

#include <fmt/format.h>

#include <cmath>

namespace bedload {
namespace {

/// Settings of the programs that published timings are from.
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

/// Equal frictional spheres in an open box, with or without water.
constexpr const char* kBeads = R"([domain]
min = [-{margin}, -{margin}, -{margin}]
max = [{outside}, {outside}, {top}]
{fluid}[grain]
d = 0.0027
{grain}[[grain.fill]]
min = [0, 0, 0]
max = [{side}, {side}, {bed}]
count = {count}
[[wall.body]]
name = "box"
shape = "tank"
{wall}min = [0, 0, 0]
max = [{side}, {side}, {rim}]
faces = ["x-", "x+", "y-", "y+", "z-"]
[time]
end = 10
[out]
every = 1
)";

struct Beads {
  int count;
  double side;           ///< of the square floor, m
  double margin = 0.01;  ///< from the box to the sides of the domain, m
  double depth = 0;      ///< of water, m
  std::string grain = {}, wall = {};
};

std::string case_text(const Beads& b) {
  using fmt::arg;
  const double bed = b.count * 3.14159265 / 6 * std::pow(0.0027, 3) / 0.35 / (b.side * b.side);  // at 35 %
  const bool wet = b.depth > 0;
  const double top = (wet ? b.depth : bed) + 0.1;
  const std::string fluid =
      wet ? fmt::format(
                "[fluid]\ndx = 0.003\n[[fluid.fill]]\nmin = [0, 0, 0]\nmax = [{0}, {0}, {1}]\n[visc]\n"
                "alpha = 0.02\n",
                b.side, b.depth)
          : "";
  return fmt::format(kBeads, arg("margin", b.margin), arg("outside", b.side + b.margin), arg("top", top),
                     arg("fluid", fluid), arg("grain", b.grain), arg("side", b.side), arg("bed", bed),
                     arg("count", b.count), arg("wall", b.wall), arg("rim", wet ? top : bed));
}

Benchmark spheres(const std::string& name, int count, double side, bool settle) {
  return {name,
          case_text({.count = count,
                     .side = side,
                     .grain = settle ? "settle = true\nsettle_time = 0.35\n" : "",
                     .wall = "type = \"grains_only\"\n"}),
          {}};
}

Benchmark coupled(const std::string& name, double side, double depth, int count, bool settle) {
  return {name,
          case_text({.count = count,
                     .side = side,
                     .margin = 0.03,
                     .depth = depth,
                     .grain = settle ? "settle = true\nsettle_time = 0.15\n" : ""}),
          kPeers};
}

}  // namespace

Benchmark widened_dam_break(const std::string& name, double width) {
  std::vector<std::string> settings = kPeers;
  settings.push_back("time.integrator=ab3");
  return {name, fmt::format(kDamBreak, width, width + 0.04), settings};
}

std::vector<Benchmark> benchmarks() {
  return {widened_dam_break("0.1M", 0.152),
          widened_dam_break("1M", 1.62),
          widened_dam_break("5M", 8.1),
          widened_dam_break("8M", 12.8),
          widened_dam_break("14M", 22.6),
          spheres("spheres-8.8k", 8800, 0.08, false),
          spheres("spheres-1M", 1000000, 0.3, false),
          spheres("settled-8.8k", 8800, 0.08, true),
          spheres("settled-1M", 1000000, 0.3, true),
          coupled("coupled", 0.12, 0.189, 10000, true),
          coupled("coupled-10M", 0.6, 0.75, 2000000, false)};
}

}  // namespace bedload
