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
}

}  // namespace bedload
