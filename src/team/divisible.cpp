#include "src/team/divisible.hpp"

#include <fmt/format.h>

#include "bedload/case/config.hpp"
#include "bedload/core/error.hpp"

namespace bedload {

void refuse_undivided(const Config& c) {
  const auto refuse = [](const std::string& key, const char* what) {
    throw KeyError(
        key,
        fmt::format("{}: {} cannot be divided among several devices or ranks yet; run it on one", key, what));
  };
  if (!c.fluid.present && !c.grain.present) refuse("fluid", "a case without fluid and grains");
  if (c.fluid.present && c.fluid.lattice()) refuse("fluid.model", "fluid on a lattice");
  if (c.grain.present) {
    if (c.fluid.present && c.couple.mode != CouplingMode::off && c.domain.sheared())
      refuse("domain.shear_rate", "sheared fluid that acts on grains");
    if (c.grain.largest() >= 2 * c.grain.smallest())
      refuse("grain", "grains of which the largest are twice as wide as the smallest");
  }
  for (const int k : c.grain.clump_fills()) refuse(fmt::format("grain.fill.{}.clump", k), "clumps");
  for (std::size_t k = 0; k < c.grain_inlets.size(); ++k)
    if (!c.grain_inlets[k].clump.empty()) refuse(fmt::format("grain_inlet.{}.clump", k), "clumps");
  for (const int k : c.grain.rigid_fills()) refuse(fmt::format("grain.fill.{}.rigid", k), "a rigid group");
}

}  // namespace bedload
