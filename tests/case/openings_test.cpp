// Openings in case files: what is taken and what is refused.

#include <gtest/gtest.h>

#include <cmath>

#include "bedload/geometry/orifice.hpp"
#include "bedload/geometry/setup.hpp"
#include "src/motion/inlet_flow.hpp"
#include "tests/case/support.hpp"

namespace bedload::test {
namespace {

const std::string kInlet = R"([[inlet]]
name = "feed"
centre = [0.15, 0.05, 0.1]
direction = [0, 0, -2]
radius = 0.01
rate = 1e-4
)";

std::string with_inlet(const std::string& from = "", const std::string& to = "") {
  std::string text = kInlet;
  if (!from.empty()) {
    const auto at = text.find(from);
    if (at == text.npos) throw std::logic_error("no '" + from + "' in the inlet");
    text.replace(at, from.size(), to);
  }
  return kCase + text;
}

std::string setup_error(const std::string& text) {
  const Config config = read(text);
  std::vector<std::string> warnings;
  try {
    build_setup(config, warnings);
  } catch (const CaseError& error) {
    return error.what();
  }
  return "";
}

TEST(Openings, AnInletIsResolved) {
  const Config c = read(with_inlet());
  ASSERT_EQ(c.inlets.size(), 1u);
  EXPECT_EQ(c.inlets[0].direction, (Vec3d{0, 0, -1}));
  EXPECT_DOUBLE_EQ(c.inlets[0].ramp, 10 * c.fluid.h() / c.fluid.c);
  const auto points = orifice_points(c.inlets[0], c.fluid.dx);
  EXPECT_EQ(points.size(), 21u);
  InletFlow flow(c.inlets[0], c.fluid.dx);
  EXPECT_NEAR(flow.motion(1).v.z, -1e-4 / (21 * 16e-6), 1e-12);
  EXPECT_DOUBLE_EQ(flow.rate(1), 1e-4);
  EXPECT_EQ(read(resolved_toml(c)), c);
}

TEST(Openings, TheFlowSetsTheSoundSpeed) {
  const Config c = read(with_inlet("rate = 1e-4", "velocity = 3\nfactor = \"2*exp(-t)\""));
  EXPECT_NEAR(c.fluid.vmax, 6 * std::exp(-c.inlets[0].ramp), 0.02);
}

TEST(Openings, AHeadThatNobodyGaveIsWarnedOf) {
  const auto warnings = warnings_of(with_inlet());  // 0.1 m of fluid in a domain of 0.2 m
  ASSERT_EQ(warnings.size(), warnings_of(kCase).size() + 1);
  EXPECT_EQ(warnings[0],
            "fluid.vmax = 1.4 m/s sets the sound speed; fluid from an inlet that stands or falls as high as "
            "the domain, 0.2 m, reaches 1.98 m/s");
}

TEST(Openings, BuffersFollowTheWallParticles) {
  const Config c = read(with_inlet());
  std::vector<std::string> warnings;
  const auto with = build_setup(c, warnings), without = build_setup(read(kCase), warnings);
  EXPECT_EQ(with.walls.x.size(), without.walls.x.size() + 21 * buffer_layers(c.fluid));
  EXPECT_EQ(with.walls.body.back(), 1u);
  EXPECT_NEAR(with.walls.x[without.walls.x.size()].z, 0.1 + c.fluid.dx / 2, 1e-12);
}

TEST(Openings, WrongInlets) {
  EXPECT_EQ(
      error_of(with_inlet("radius = 0.01", "radius = 0.007")),
      "dam.toml:6: fluid.dx = 0.004 must be at most 0.0035 m for four particles across inlet \"feed\"; it "
      "makes 3");
  EXPECT_EQ(error_of(with_inlet("rate = 1e-4", "")),
            "dam.toml:25: inlet \"feed\" must have exactly one of rate and velocity");
  EXPECT_EQ(error_of(with_inlet("rate = 1e-4", "rate = 1e-4\nvelocity = 1")),
            "dam.toml:30: inlet \"feed\" must have exactly one of rate and velocity");
  EXPECT_EQ(error_of(with_inlet("direction = [0, 0, -2]", "direction = [0, 0, 0]")),
            "dam.toml:28: inlet.direction = [0, 0, 0] must not be zero");
  EXPECT_EQ(error_of(with_inlet("radius = 0.01",
                                "shape = \"rectangle\"\nhalf_a = [0.01, 0, 0]\nhalf_b = "
                                "[0.01, 0.01, 0]")),
            "dam.toml:31: inlet.half_b = [0.01, 0.01, 0] must be at right angles to half_a");
  EXPECT_NE(
      error_of(with_inlet("rate = 1e-4", "rate = 1e-4\nfactor = \"1+q\"")).find("must be a formula in t"),
      std::string::npos);
  EXPECT_NE(
      error_of(with_inlet("centre = [0.15, 0.05, 0.1]", "centre = [0.15, 0.05, 0.5]")).find("in the domain"),
      std::string::npos);
}

TEST(Openings, BuffersNeedAnOpening) {
  const std::string in_wall = setup_error(with_inlet("[0.15, 0.05, 0.1]", "[0.15, 0.05, 0.2]"));
  EXPECT_TRUE(in_wall.starts_with("inlet \"feed\": the fluid upstream of it, at (0.1")) << in_wall;
  EXPECT_TRUE(
      in_wall.ends_with("must not lie inside wall.body \"tank\"; leave an opening there, 0.016 m deep"))
      << in_wall;
  const std::string in_fluid = setup_error(with_inlet("[0.15, 0.05, 0.1]", "[0.03, 0.05, 0.09]"));
  EXPECT_NE(in_fluid.find("must not overlap the initial fluid at"), std::string::npos) << in_fluid;
}

TEST(Openings, WallsThatEndAtAnInletAreWarnedOf) {
  const auto from_below = [](const std::string& bottom, const std::string& side) {
    std::vector<std::string> warnings;
    build_setup(read(R"([domain]
min = [0, 0, -0.1]
max = [0.1, 0.1, 0.2]
[fluid]
dx = 0.01
vmax = 2
[[wall.body]]
name = "column"
shape = "tank"
min = [0, 0, )" + bottom +
                     R"(]
max = [0.1, 0.1, 0.2]
faces = ["x-", "x+", "y-", "y+"]
[[inlet]]
name = "feed"
shape = "rectangle"
centre = [0.05, 0.05, 0]
direction = [0, 0, 1]
half_a = [)" + side + R"(, 0, 0]
half_b = [0, 0.03, 0]
rate = 1e-3
[time]
end = 1
[out]
every = 1
)"),
                warnings);
    return warnings;
  };
  EXPECT_EQ(
      from_below("0", "0.05"),
      std::vector<std::string>{
          "inlet \"feed\": wall.body \"column\" beside it ends at its plane, so that fluid comes in too "
          "thin along it; let it reach 0.04 m upstream"});
  EXPECT_TRUE(from_below("-0.04", "0.05").empty());
  EXPECT_TRUE(from_below("0", "0.03").empty()) << "in mid-air";
}

TEST(Openings, WrongOutletsAndGrainInlets) {
  const auto outlet = [](const std::string& rest) {
    return error_of(kCase + "[[outlet]]\nname = \"end\"\n" + rest);
  };
  EXPECT_EQ(
      outlet("shape = \"hole\""),
      "dam.toml:27: outlet.shape = \"hole\" must be box, plane or the name of a [[shape]]; this case has "
      "none");
  EXPECT_NE(outlet("min = [0, 0, 0]\nmax = [0, 1, 1]").find("must exceed outlet.min"), std::string::npos);
  EXPECT_NE(error_of(kCase + kInlet + "[[outlet]]\nname = \"feed\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]")
                .find("must differ from other inlets' and outlets'"),
            std::string::npos);
  const auto grains = [](const std::string& rest) {
    return error_of(kCase + "[[grain_inlet]]\nname = \"feed\"\n" + rest);
  };
  EXPECT_NE(grains("min = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]").find("exactly one of rate and mass_rate"),
            std::string::npos);
  EXPECT_NE(grains("rate = 5\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.001]").find("must leave room along z"),
            std::string::npos);
  EXPECT_NE(grains("rate = 5\nshape = \"disc\"\ncentre = [0, 0, 0]\ndirection = [0, 0, 1]\nradius = 5e-4")
                .find("must be at least 0.001"),
            std::string::npos);
}

}  // namespace
}  // namespace bedload::test
