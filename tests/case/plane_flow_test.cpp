// domain.two_d as a case gives it.

#include <gtest/gtest.h>

#include "support.hpp"

namespace bedload::test {
namespace {

const std::string kWithout = R"(title = "dam"
[domain]
min = [0, 0, 0]
max = [0.2, 0.001, 0.2]
two_d = true
[fluid]
dx = 0.004
[[fluid.fill]]
min = [0, 5, 0]
max = [0.05, 6, 0.1]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, -1, 0]
max = [0.2, 2, 0.2]
[[probe]]
name = "in"
type = "point"
at = [0.02, 3, 0.02]
[time]
end = 0.3
[out]
every = 0.01
)";

TEST(PlaneFlowCase, RunsThroughTheDomainWhateverIsGivenAlongY) {
  const Config c = read(kWithout);
  EXPECT_TRUE(c.domain.periodic[1]);
  EXPECT_EQ(c.wall.bodies[0].min.y, 0);
  EXPECT_EQ(c.wall.bodies[0].max.y, 0.001);
  EXPECT_EQ(c.fluid.fills[0].min.y, 0);
  EXPECT_EQ(c.out.probes[0].at.y, 0.0005);
}

TEST(PlaneFlowCase, RefusesWhatIsNoPlaneFlow) {
  EXPECT_EQ(
      error_of(kWithout +
               "[grain]\nd = 0.01\n[[grain.fill]]\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\ncount = 1\n"),
      "dam.toml:5: domain.two_d = true must be false with [grain]; grains are spheres");
  EXPECT_EQ(error_of("gravity = [0, 1, -9.81]\n" + kWithout),
            "dam.toml:1: gravity = [0, 1, -9.81] must be 0 along y with domain.two_d");
  EXPECT_EQ(error_of(kWithout + "[[inlet]]\nname = \"in\"\ncentre = [0.1, 0, 0.1]\ndirection = [1, 0, 0]\n"
                                "radius = 0.02\nrate = 1e-5\n"),
            "dam.toml:5: domain.two_d = true must be false with [[inlet]]");
  EXPECT_EQ(error_of(kWithout + "[[wall.body]]\nname = \"float\"\nshape = \"box\"\nmin = [0.1, 0, 0.05]\n"
                                "max = [0.15, 1, 0.1]\n[wall.body.free]\nmass = 1\n"),
            "dam.toml:5: domain.two_d = true must be false with free bodies");
}

TEST(PlaneFlowCase, StaysInItsPlane) {
  EXPECT_EQ(error_of(kWithout, {"drive.f=[0, 1, 0]"}),
            "--set drive.f=[0, 1, 0]: drive.f = [0, 1, 0] must be 0 along y with domain.two_d");
  const auto moving = [](const std::string& motion) {
    return error_of(kWithout +
                    "[[wall.body]]\nname = \"paddle\"\nshape = \"box\"\nmin = [0.1, 0, 0.05]\n"
                    "max = [0.15, 1, 0.1]\n[wall.body.motion]\n" +
                    motion);
  };
  const std::string must =
      " must stay in the plane of x and z with domain.two_d: nothing along y, turning about y alone";
  EXPECT_EQ(moving("kind = \"velocity\"\nvelocity = [0.1, 0, 0.2]\n"), "");
  EXPECT_EQ(moving("kind = \"velocity\"\nvelocity = [0.1, 0.1, 0]\n"),
            "dam.toml:30: wall.body.motion.kind = \"velocity\"" + must);
  const std::string turning = "kind = \"rotation\"\nrate = 2\ncentre = [0.12, 0, 0.07]\n";
  EXPECT_EQ(moving(turning + "axis = [0, -1, 0]\n"), "");
  EXPECT_EQ(moving(turning + "axis = [0.1, 1, 0]\n"),
            "dam.toml:30: wall.body.motion.kind = \"rotation\"" + must);
}

}  // namespace
}  // namespace bedload::test
