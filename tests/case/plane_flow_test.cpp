// domain.two_d as a case gives it.

#include <gtest/gtest.h>

#include "bedload/geometry/orifice.hpp"
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
}

std::string with_inlet(const std::string& rest) {
  return kWithout + "[[inlet]]\nname = \"in\"\ncentre = [0.1, 7, 0.1]\nrate = 1e-5\n" + rest;
}

TEST(PlaneFlowCase, HasInletsThatRunThroughIt) {
  const std::string up = "direction = [0, 0, 1]\nshape = \"rectangle\"\n";
  const Config c = read(with_inlet(up + "half_a = [0, 3, 0]\nhalf_b = [0.01, 0, 0]\n"));
  EXPECT_EQ(c.inlets[0].centre, Vec3d(0.1, 0.0005, 0.1));
  EXPECT_EQ(c.inlets[0].half_a, Vec3d(0.01, 0, 0));
  EXPECT_EQ(c.inlets[0].half_b, Vec3d(0, 0.0005, 0));
  EXPECT_EQ(read(resolved_toml(c)), c);
  const OrificeLayer layer = orifice_layer(c.inlets[0], c.fluid.dx, c.domain);
  ASSERT_EQ(layer.points.size(), 5u);
  for (const Vec3d& x : layer.points) EXPECT_EQ(x.y, 0.0005);
  EXPECT_NEAR(layer.thickness, 0.004, 1e-15);

  EXPECT_EQ(error_of(with_inlet("direction = [0, 0, 1]\nradius = 0.02\n")),
            "dam.toml:24: inlet.shape = \"disc\" must be \"rectangle\" with domain.two_d");
  EXPECT_EQ(error_of(with_inlet("shape = \"rectangle\"\ndirection = [0, 1, 1]\nhalf_a = [0, 1, -1]\n"
                                "half_b = [0.01, 0, 0]\n")),
            "dam.toml:29: inlet.direction = [0, 1, 1] must be 0 along y with domain.two_d");
  EXPECT_EQ(
      error_of(with_inlet(up + "half_a = [0.01, 0.01, 0]\nhalf_b = [-0.01, 0.01, 0]\n")),
      "dam.toml:31: inlet.half_b = [0.01, 0.01, 0] must lie along y and half_a in the plane of x and z with "
      "domain.two_d, or the other way round");
  EXPECT_EQ(
      error_of(with_inlet(up + "half_a = [0.005, 0, 0]\nhalf_b = [0, 1, 0]\n")),
      "dam.toml:7: fluid.dx = 0.004 must be at most 0.0025 m for four particles across inlet \"in\"; it "
      "makes 2");
}

std::string with_float(const std::string& rest, const std::string& shape =
                                                    "box\"\nmin = [0.1, 0, 0.05]\n"
                                                    "max = [0.15, 1, 0.1]\n") {
  return kWithout + "[[wall.body]]\nname = \"float\"\nshape = \"" + shape +
         "[wall.body.free]\ndensity = 500\n" + rest;
}

TEST(PlaneFlowCase, HasFreeBodiesThatStayInIt) {
  const FreeConfig f = read(with_float("")).wall.bodies[1].free;
  EXPECT_NEAR(f.solid.mass, 500 * 0.05 * 0.05 * 0.001, 1e-15);
  EXPECT_NEAR(f.contact_spacing, 0.0125, 1e-15) << "whatever the slab's length";
  EXPECT_EQ(error_of(with_float("velocity = [0, 0.1, 0]\n")),
            "dam.toml:31: wall.body.free.velocity = [0, 0.1, 0] must be 0 along y with domain.two_d");
  EXPECT_EQ(error_of(with_float("spin = [1, 2, 0]\n")),
            "dam.toml:31: wall.body.free.spin = [1, 2, 0] must be 0 along x and z with domain.two_d");
  EXPECT_EQ(error_of(with_float("move = \"axis\"\naxis = [0, 1, 1]\n")),
            "dam.toml:32: wall.body.free.axis = [0, 1, 1] must lie along y or in the plane of x and z with "
            "domain.two_d");
  const auto ball = [](double y) {
    return with_float("", "ball\"\n") + "[[shape]]\nname = \"ball\"\nkind = \"sphere\"\ncentre = [0.1, " +
           std::to_string(y) + ", 0.1]\nradius = 0.02\n";
  };
  EXPECT_EQ(error_of(ball(0.0005)), "");
  EXPECT_EQ(
      error_of(ball(0.0105)),
      "dam.toml:26: wall.body.shape = \"ball\" must stand at right angles to the plane of x and z, and reach "
      "well beyond it, with free bodies and domain.two_d");
  EXPECT_EQ(error_of(ball(0.0305)),
            "dam.toml:27: wall.body.free needs a shape that the plane y = 0.0005 m cuts");
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
