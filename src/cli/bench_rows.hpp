#pragma once
// The cases that `bedload bench` has built in.

#include <string>
#include <vector>

namespace bedload {

struct BenchRow {
  std::string name;
  std::string text;  ///< TOML
  /// What other programs compute with, as for --set: h = 1.3 dx, the continuity equation alone for the
  /// density, no shifting; forces once a step where the fluid is alone. Empty without fluid.
  std::vector<std::string> settings;
};

std::vector<BenchRow> bench_rows();

/// The single-phase dam break of He et al. 2018 with a column `width` wide, m.
BenchRow widened_dam_break(const std::string& name, double width);

}  // namespace bedload
