#pragma once
// The built-in cases of `bedload bench`.

#include <functional>
#include <string>
#include <vector>

namespace bedload {

struct Benchmark {
  std::string name;
  std::string text;  ///< TOML
  /// Settings of other programs, as for --set: h = 1.3 dx, density by the continuity equation alone, no
  /// shifting; forces once per step in single-phase cases. Empty without fluid.
  std::vector<std::string> settings;
  /// The same so many times as wide, with as many times the particles; empty where there is no such thing.
  std::function<Benchmark(double)> widened = {};
  /// Of a bed of copies of a small one: that one, periodic along x and y and settled first (TOML), and how
  /// many copies lie along each of them. Those take the place of the grains of the last fills.
  std::string tile = {};
  int tiles = 0;
};

std::vector<Benchmark> benchmarks();

/// The first keys of a case, to go on in [fluid]: a cube of fluid on nodes without gravity, periodic on all
/// sides, m.
std::string lattice_cube(double side, double dx);

/// The single-phase dam break of He et al. 2018 with a column of that width, m.
Benchmark widened_dam_break(const std::string& name, double width);

}  // namespace bedload
