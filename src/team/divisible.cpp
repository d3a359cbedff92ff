#include "src/team/divisible.hpp"

#include <fmt/format.h>

#include "bedload/case/config.hpp"
#include "bedload/core/error.hpp"

namespace bedload {

void refuse_undivided(const Config& c) {
  const auto refuse = [](const std::string& key, const char* what) {
    throw KeyError(key, fmt::format("{}: {} cannot be divided among several devices or ranks yet; run it on one",
                                    key, what));
  };
  if (!c.fluid.present) refuse("fluid", "a case without fluid");
  if (c.fluid.lattice()) refuse("fluid.model", "fluid on a lattice");
  for (const int k : c.grain.clump_fills()) refuse(fmt::format("grain.fill.{}.clump", k), "clumps");
  if (c.grain.present) refuse("grain", "a case with grains");
  if (c.wall.energy_consistent && c.wall.suction)
    refuse("wall.energy_consistent", "work of the pressure of walls");
  for (std::size_t k = 0; k < c.fluid.fills.size(); ++k)
    if (!c.fluid.fills[k].file.empty())
      refuse(fmt::format("fluid.fill.{}.file", k), "fluid from a file of particles");
  for (std::size_t k = 0; k < c.wall.bodies.size(); ++k) {
    const WallBody& body = c.wall.bodies[k];
    if (body.type->kind == WallKind::mirrored) refuse(fmt::format("wall.body.{}.type", k), "a mirrored wall");
  }
}

}  // namespace bedload
