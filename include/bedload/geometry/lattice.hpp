#pragma once
// Points at equal distances, and the fluid placed on them.

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/host_data.hpp"

namespace bedload {

/// `count` cells of width `step` that fill a length exactly; points sit at their centres.
struct Cells {
  double start = 0, step = 0;  ///< m
  std::int64_t count = 0;

  double centre(std::int64_t i) const { return start + (double(i) + 0.5) * step; }
};

/// The cells between `lo` and `hi` whose width comes nearest to `spacing`; at least one. Half a cell counts
/// whole, also where rounding takes something off: moved elsewhere, the same box has the same cells.
inline Cells fit_cells(double lo, double hi, double spacing) {
  const double n = std::fmax(1, std::floor((hi - lo) / spacing + 0.5 + 1e-6));
  return {lo, (hi - lo) / n, std::int64_t(n)};
}

/// Adds every fluid.fill that is a box or a shape; in a box a lattice that divides each side evenly, so that
/// it meets walls and periodic images half a spacing off. The masses of a fill are
/// equal and add up to rho0 times its volume. Fills must not overlap. Returns the first particle of each
/// fill, and their number at the end. Bodies that stand in a fill are left out, which `notes` reports. Throws
/// KeyError.
std::vector<std::size_t> add_fluid(const Config& config, Setup::Fluid& fluid,
                                   std::vector<std::string>& warnings, std::vector<std::string>& notes);

/// Adds every fluid.fill that comes from a file; call it after add_fluid. Each particle weighs rho0 dx^3.
/// Throws CaseError with file and line for particles outside the domain, inside walls or in other fluid.
void add_listed_fluid(const Config& config, Setup::Fluid& fluid, std::vector<std::string>& warnings);

}  // namespace bedload
