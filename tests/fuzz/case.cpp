// Texts of cases: reading, all checks, and what small ones start with.

#include <algorithm>
#include <cmath>

#include "bedload/case/read.hpp"
#include "bedload/geometry/setup.hpp"
#include "fuzz.hpp"

namespace bedload::fuzz {
namespace {

/// Few enough particles to place them here.
bool is_small(const Config& c) {
  const Vec3d space = c.domain.max - c.domain.min;
  double particles = 0;
  const auto add = [&](double length, double spacing, double power) {
    particles += std::pow(length / spacing, power);
  };
  if (c.fluid.present) {
    add(std::max({space.x, space.y, space.z}), c.fluid.dx, 3);
    for (const WallBody& body : c.wall.bodies) {
      const Vec3d side = body.max - body.min;
      if (body.shape != "plane") add(std::max({side.x, side.y, side.z}), c.wall.spacing(body), 3);
    }
  }
  if (c.grain.present) add(std::max({space.x, space.y, space.z}), c.grain.d_min, 3);
  return particles < 1e5;
}

}  // namespace
}  // namespace bedload::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bedload;
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::attempt([&] {
    std::vector<std::string> warnings;
    const Config config = read_case_text(text, BL_FUZZ_FILES "/case.toml", {}, warnings);
    if (fuzz::is_small(config)) build_setup(config, warnings);
    for (const std::string& warning : warnings) fuzz::check_sentence(warning);
  });
  return 0;
}
