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
  if (c.grain.present) refuse("grain", "a case with grains");
  for (std::size_t k = 0; k < c.wall.bodies.size(); ++k) {
    const WallBody& body = c.wall.bodies[k];
    if (body.type->kind == WallKind::mirrored) refuse(fmt::format("wall.body.{}.type", k), "a mirrored wall");
  }
}

}  // namespace bedload
