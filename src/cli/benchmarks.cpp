#include "benchmarks.hpp"

#include <fmt/format.h>

#include <algorithm>
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

/// Frictional spheres in an open box, with or without water.
constexpr const char* kBeads = R"([domain]
min = [{low}, {low}, -{below}]
max = [{outside}, {beyond}, {top}]
{periodic}{fluid}[grain]
d = {d}
{grain}{large}[[grain.fill]]
min = [0, 0, 0]
max = [{side}, {across}, {bed}]
count = {count}
{shape}[[wall.body]]
name = "box"
shape = "tank"
{wall}min = [0, 0, 0]
max = [{side}, {across}, {rim}]
faces = [{sides}"z-"]
[time]
end = 10
[out]
every = 1
)";

/// Fluid in a lattice_cube(), driven along x.
constexpr const char* kNodes = R"(mu = 0.001
vmax = 0.01
[drive]
f = [10, 0, 0]
{grains}[time]
end = 10
[out]
every = 1
)";

/// Spheres in it, ten nodes across.
constexpr const char* kResolved = R"([contact]
normal = "linear"
k = 0.05
[grain]
d = 0.001
E = 1e4
[[grain.fill]]
min = [0, 0, 0]
max = [{side}, {side}, {side}]
packing_fraction = {fraction}
)";

constexpr double kBead = 0.0027;  // diameter, m
constexpr const char* kDry = "type = \"grains_only\"\n";

struct Beads {
  int count;
  double side;           ///< of the floor, m
  double times = 1;      ///< its other side over that one
  double margin = 0.01;  ///< from the box to the sides of the domain, m
  double depth = 0;      ///< of water, m
  bool open = false;     ///< without side walls, periodic
  std::string grain = {}, wall = {};
  int ratio = 1, large = 0;  ///< diameter of large grains over that of the others; how many there are besides
  bool lattice = false;      ///< the large ones are side by side on the floor, fixed
  double highest = 0;        ///< of the large ones, m; 0: as all
  std::string shape = {};    ///< of grains that are clumps
  double fraction = 0.35;    ///< of the volume that they are thrown into
  double d = kBead, dx = 0.003;  ///< m
};

double volume_of(const Beads& b, double count, double large) {
  return (count + large * std::pow(b.ratio, 3)) * 3.14159265 / 6 * std::pow(b.d, 3);
}

/// Of the large grains.
std::string fill_text(const Beads& b, double bed) {
  if (b.large == 0) return "";
  const double d = b.ratio * b.d;
  const std::string sizes = fmt::format("sizes = [{{ d = {:.6g} }}]\n", d);
  if (!b.lattice)
    return fmt::format("[[grain.fill]]\nmin = [0, 0, 0]\nmax = [{0}, {0}, {1}]\ncount = {2}\n{3}", b.side,
                       b.highest > 0 ? b.highest : bed, b.large, sizes);
  std::string positions;
  const int across = int(std::lround(std::sqrt(b.large)));
  const double pitch = b.side / across;
  for (int n = 0; n < b.large; ++n)
    positions += fmt::format("[{:.6g}, {:.6g}, {:.6g}],\n", pitch * (n % across + 0.5),
                             pitch * (n / across + 0.5), d / 2);
  return fmt::format(
      "[[grain.fill]]\npositions = [{}]\n{}[grain.fill.rigid]\nmove = \"none\"\nturn = \"none\"\n", positions,
      sizes);
}

/// Of the space that grains are thrown into, m.
double height_of(const Beads& b) {
  const double room = volume_of(b, b.count, b.large) / b.fraction / (b.times * b.side * b.side);
  return b.lattice ? std::max(room, 1.25 * b.ratio * b.d) : room;
}

std::string case_text(const Beads& b, double bed) {
  using fmt::arg;
  const double across = b.times * b.side;
  const bool wet = b.depth > 0;
  const double margin = b.open ? 0 : b.margin;
  const double top = (wet ? b.depth : bed) + 0.1;
  const std::string fluid =
      wet ? fmt::format(
                "[fluid]\ndx = {3}\n[[fluid.fill]]\nmin = [0, 0, 0]\nmax = [{0}, {1}, {2}]\n[visc]\n"
                "alpha = 0.02\n",
                b.side, across, b.depth, b.dx)
          : "";
  return fmt::format(
      kBeads, arg("low", 0 - margin), arg("below", b.margin), arg("outside", b.side + margin),
      arg("beyond", across + margin), arg("periodic", b.open ? "periodic = [true, true, false]\n" : ""),
      arg("sides", b.open ? "" : "\"x-\", \"x+\", \"y-\", \"y+\", "), arg("across", across), arg("top", top),
      arg("fluid", fluid), arg("d", b.d), arg("grain", b.grain), arg("large", fill_text(b, bed)),
      arg("side", b.side), arg("bed", bed), arg("count", b.count), arg("shape", b.shape), arg("wall", b.wall),
      arg("rim", wet ? top : bed));
}

std::string case_text(const Beads& b) { return case_text(b, height_of(b)); }

Benchmark spheres(const std::string& name, int count, double side, bool settle) {
  return {name,
          case_text({.count = count,
                     .side = side,
                     .grain = settle ? "settle = true\nsettle_time = 0.35\n" : "",
                     .wall = kDry}),
          {}};
}

/// A settled bed of copies of a tile, which settles for at most so long (s). Large grains, but for those of a
/// lattice, take the place of what is where they are.
Benchmark tiled(const std::string& name, Beads b, int tiles, double longest,
                const std::vector<std::string>& settings = {}) {
  const auto settling = [](double time) {
    return fmt::format("settle = true\nsettle_time = {:.3g}\n", time);
  };
  const double settled = 0.6;  // of the volume
  Beads tile = b;
  tile.open = true;
  tile.depth = 0, tile.wall = kDry;
  tile.side = b.side / tiles;
  const double lost = b.open ? 1 : std::pow(1 - b.d / b.side, 2);  // beside the walls
  const double carved = b.lattice ? 0 : settled * b.large * std::pow(b.ratio, 3);
  tile.count = int(std::lround((b.count / lost + carved) / (tiles * tiles)));
  tile.large = b.lattice ? b.large / (tiles * tiles) : 0;
  tile.grain += settling(longest);
  b.highest = volume_of(b, b.count / settled, b.large) / (b.side * b.side);
  b.count = 1;  // copies come in its place
  b.grain += settling(longest / 2);
  return {name, case_text(b, height_of(tile)), settings, {}, case_text(tile), tiles};
}

/// A settled bed of a million spheres and some larger ones.
Benchmark two_sizes(const std::string& name, int ratio, int large) {
  return tiled(name, {.count = 1000000, .side = 0.3, .wall = kDry, .ratio = ratio, .large = large}, 10, 0.35);
}

/// A settled bed of rods of three spheres.
Benchmark clumps(const std::string& name, int count, double side) {
  return tiled(name,
               {.count = count,
                .side = side,
                .open = true,
                .wall = kDry,
                .shape = "clump = \"rod\"\n[[clump]]\nname = \"rod\"\n"
                         "spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]\n",
                .fraction = 0.2},
               10, 0.4);
}

/// A million spheres strewn over a hundred fixed ones that are 100 times as large.
Benchmark coated(const std::string& name) {
  return tiled(name,
               {.count = 1000000,
                .side = 10 * 102 * kBead,
                .open = true,
                .wall = kDry,
                .ratio = 100,
                .large = 100,
                .lattice = true},
               5, 0.8);
}

Benchmark coupled(const std::string& name, double side, double depth, int count, bool settle,
                  double times = 1) {
  return {name,
          case_text({.count = int(count * times),
                     .side = side,
                     .times = times,
                     .margin = 0.03,
                     .depth = depth,
                     .grain = settle ? "settle = true\nsettle_time = 0.15\n" : ""}),
          kPeers, [=](double more) { return coupled(name, side, depth, count, settle, times * more); }};
}

/// Water over grains of 0.5 mm and `large` ones of 10 mm, 1 mm apart.
Benchmark coupled_sizes(const std::string& name, double side, double depth, int count, int large, int tiles) {
  const Beads b{.count = count,
                .side = side,
                .depth = depth,
                .grain = "resolve = \"none\"\n",
                .ratio = 20,
                .large = large,
                .d = 0.0005,
                .dx = 0.001};
  return tiles > 0 ? tiled(name, b, tiles, 0.15, kPeers) : Benchmark{name, case_text(b), kPeers};
}

/// n: nodes along a side; fraction: of the volume, in spheres.
Benchmark lattice(const std::string& name, int n, double fraction) {
  using fmt::arg;
  constexpr double dx = 1e-4;
  const std::string side = fmt::format("{:.6g}", n * dx);
  const std::string grains =
      fraction > 0 ? fmt::format(kResolved, arg("side", side), arg("fraction", fraction)) : "";
  return {name, lattice_cube(n * dx, dx) + fmt::format(kNodes, arg("grains", grains)), {}};
}

}  // namespace

std::string lattice_cube(double side, double dx) {
  return fmt::format(R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [{0:.15g}, {0:.15g}, {0:.15g}]
periodic = [true, true, true]
[fluid]
model = "lattice"
dx = {1:.15g}
)",
                     side, dx);
}

Benchmark widened_dam_break(const std::string& name, double width) {
  std::vector<std::string> settings = kPeers;
  settings.push_back("time.integrator=ab3");
  return {name, fmt::format(kDamBreak, width, width + 0.04), settings,
          [=](double times) { return widened_dam_break(name, times * width); }};
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
          tiled("settled-1M", {.count = 1000000, .side = 0.3, .wall = kDry}, 10, 0.35),
          tiled("spheres-1.1M", {.count = 1100000, .side = 0.3, .wall = kDry}, 10, 0.35),
          two_sizes("bi5", 5, 800),
          two_sizes("bi10", 10, 100),
          two_sizes("bi20", 20, 12),
          two_sizes("bi50", 50, 8),
          two_sizes("bi100", 100, 1),
          coated("bi100-coated"),
          clumps("clumps-1M", 1000000, 0.3),
          coupled("coupled", 0.12, 0.189, 10000, true),
          coupled("coupled-10M", 0.6, 0.75, 2000000, false),
          coupled_sizes("coupled-fine", 0.08, 0.156, 1000000, 0, 10),
          coupled_sizes("coupled-bi20", 0.08, 0.156, 1000000, 12, 10),
          coupled_sizes("coupled-fine-20k", 0.02, 0.02, 20000, 0, 0),
          coupled_sizes("coupled-bi20-20k", 0.02, 0.02, 20000, 1, 0),
          lattice("lattice-0.9M", 96, 0),
          lattice("lattice-57M", 384, 0),
          lattice("lattice-spheres-0.9M", 96, 0.2),
          lattice("lattice-spheres-17M", 256, 0.2),
          lattice("lattice-spheres-57M", 384, 0.2),
          lattice("lattice-dense-17M", 256, 0.4),
          lattice("lattice-dense-57M", 384, 0.4)};
}

}  // namespace bedload
