// Whether fluid begins with a free surface.

#include <gtest/gtest.h>

#include "bedload/geometry/setup.hpp"
#include "tests/case/support.hpp"

namespace bedload::test {
namespace {

constexpr const char* kBox = R"([domain]
min = [0, 0, 0]
max = [0.04, 0.04, 0.05]
[fluid]
dx = 0.004
[[fluid.fill]]
min = [0, 0, 0]
max = [0.04, 0.04, 0.05]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.04, 0.04, 0.05]
[time]
end = 0.1
[out]
every = 0.1
)";

constexpr const char* kDrum = R"([domain]
min = [-0.05, -0.03, -0.05]
max = [0.05, 0.03, 0.05]
[[shape]]
name = "inside"
kind = "cylinder"
a = [0, -0.02, 0]
b = [0, 0.02, 0]
radius = 0.03
[[shape]]
name = "drum"
kind = "hollow"
of = ["inside"]
[fluid]
dx = 0.003
[[fluid.fill]]
shape = "inside"
level = 0.1
[[wall.body]]
name = "drum"
shape = "drum"
[time]
end = 0.1
[out]
every = 0.1
)";

bool free_surface(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Config config = read(text, overrides);
  std::vector<std::string> warnings;
  return has_free_surface(config, build_setup(config, warnings));
}

TEST(FreeSurface, IsNoneInABoxFilledToItsLid) {
  EXPECT_FALSE(free_surface(kBox));
  EXPECT_TRUE(free_surface(kBox, {"wall.body.0.faces=[\"x-\",\"x+\",\"y-\",\"y+\",\"z-\"]"}));
  EXPECT_TRUE(free_surface(kBox, {"fluid.fill.0.max=[0.04,0.04,0.044]"})) << "a layer is missing";
  EXPECT_TRUE(free_surface(kBox, {"fluid.fill.0.max=[0.034,0.04,0.05]"})) << "at its side";
}

TEST(FreeSurface, IsNoneAcrossPeriodsNorBesideMirrors) {
  EXPECT_FALSE(free_surface(kBox, {"domain.periodic=[true,true,false]"}));
  EXPECT_FALSE(free_surface(
      kBox, {"wall.body.0.faces=[\"x-\",\"x+\",\"y-\",\"y+\",\"z-\"]", "domain.reflect.slip=[\"z+\"]"}));
  EXPECT_FALSE(free_surface(kBox, {"domain.two_d=true"}));
  EXPECT_TRUE(free_surface(kBox, {"domain.two_d=true", "fluid.fill.0.max=[0.04,0.04,0.044]"}));
}

TEST(FreeSurface, IsNoneInADrumThatIsFull) {
  EXPECT_FALSE(free_surface(kDrum));
  EXPECT_TRUE(free_surface(kDrum, {"fluid.fill.0.level=0.02"}));
}

}  // namespace
}  // namespace bedload::test
