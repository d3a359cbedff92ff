// Sides of the domain that put back what crosses them, as a case gives them.

#include <gtest/gtest.h>

#include "support.hpp"

namespace bedload::test {
namespace {

std::string with_sides(const std::string& keys) {
  return changed("max = [0.2, 0.1, 0.2]\n[fluid]", "max = [0.2, 0.1, 0.2]\n" + keys + "[fluid]");
}

TEST(EdgesCase, AreReadAndWritten) {
  EXPECT_FALSE(read(kCase).domain.reflect.any());
  EXPECT_EQ(resolved_toml(read(kCase)).find("reflect"), std::string::npos) << "as before there were any";
  const Config c = read(with_sides("reflect.slip = [\"x-\", \"y+\"]\nreflect.no_slip = [\"z+\"]\n"));
  EXPECT_EQ(c.domain.reflect.slip, (std::array{true, false, false, true, false, false}));
  EXPECT_EQ(c.domain.reflect.no_slip, (std::array{false, false, false, false, false, true}));
  EXPECT_TRUE(read(resolved_toml(c)).domain == c.domain);
}

TEST(EdgesCase, AreRefusedWhereTheyCannotBe) {
  EXPECT_EQ(
      error_of(with_sides("reflect.slip = [\"z\"]\n")),
      "dam.toml:5: domain.reflect.slip = [\"z\"] must be a list of some of \"x-\", \"x+\", \"y-\", \"y+\", "
      "\"z-\", \"z+\"");
  EXPECT_EQ(error_of(with_sides("reflect.slip = [\"x-\", \"z+\"]\nreflect.no_slip = [\"z+\"]\n")),
            "dam.toml:6: domain.reflect.no_slip = \"z+\" must not be one of domain.reflect.slip as well");
  EXPECT_EQ(error_of(with_sides("periodic = [false, true, false]\nreflect.slip = [\"x-\", \"y+\"]\n")),
            "dam.toml:6: domain.reflect.slip = \"y+\" must be a side across which nothing is periodic; y is");
  EXPECT_EQ(error_of(with_sides("reflect.no_slip = [\"x-\"]\n"), {"grain.fill.0.rigid.turn=none"}),
            "dam.toml:5: domain.reflect.no_slip = \"x-\" must not be given with [grain.fill.rigid]");
}

TEST(EdgesCase, DoNotGoWithImagesThatMoveOrALayerOfParticles) {
  const std::string fluid = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.2, 0.1, 0.2]
periodic = [true, false, true]
shear_rate = 0.5
reflect.slip = ["y-"]
[fluid]
dx = 0.01
vmax = 0.1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.2, 0.1, 0.2]
[time]
end = 1
[out]
every = 1
)";
  EXPECT_EQ(error_of(fluid), "dam.toml:6: domain.shear_rate = 0.5 must be 0 with domain.reflect");
  EXPECT_EQ(error_of(fluid, {"domain.shear_rate=0"}), "");
  EXPECT_EQ(error_of(fluid, {"domain.shear_rate=0", "domain.two_d=true"}),
            "dam.toml:7: domain.reflect.slip = \"y-\" must be a side along x or z with domain.two_d");
}

}  // namespace
}  // namespace bedload::test
