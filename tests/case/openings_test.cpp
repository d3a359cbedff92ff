// Openings in case files: what is taken and what is refused.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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
  EXPECT_EQ(orifice_layer(c.inlets[0], c.fluid.dx, c.domain).points.size(), 20u);
  InletFlow flow(c.inlets[0], c.fluid.dx, c.domain);
  EXPECT_NEAR(flow.motion(1).v.z, -1 / std::numbers::pi, 1e-12) << "the rate over the area";
  EXPECT_DOUBLE_EQ(flow.rate(1), 1e-4);
  EXPECT_EQ(read(resolved_toml(c)), c);
}

TEST(Openings, LayersFillTheirOrifice) {
  InletConfig inlet;
  inlet.centre = {0.3, 0.1, 0.2};
  inlet.direction = {0, 0, 1};
  const auto expect_full = [&](double dx, std::size_t count, double area) {
    const OrificeLayer layer = orifice_layer(inlet, dx, {});
    EXPECT_EQ(layer.points.size(), count);
    EXPECT_NEAR(orifice_area(inlet), area, 1e-12 * area);
    EXPECT_NEAR(layer.thickness * area, double(count) * dx * dx * dx, 1e-12 * area * dx);
    return layer;
  };
  inlet.shape = "rectangle";
  inlet.half_a = {0.0245, 0, 0}, inlet.half_b = {0, 0.027, 0};  // 4.9 x 5.4 spacings
  double most_a = 0, most_b = 0;
  for (const Vec3d& x : expect_full(0.01, 5 * 5, 0.049 * 0.054).points) {
    most_a = std::max(most_a, x.x - inlet.centre.x);
    most_b = std::max(most_b, x.y - inlet.centre.y);
    EXPECT_DOUBLE_EQ(x.z, inlet.centre.z);
  }
  EXPECT_NEAR(most_a, 0.0245 * 4 / 5, 1e-12) << "half a cell from the side";
  EXPECT_NEAR(most_b, 0.027 * 4 / 5, 1e-12);

  inlet.shape = "disc";
  inlet.velocity = 2;
  for (const auto& [spacings, count] :
       {std::pair{2.0, 3 + 9}, {2.5, 1 + 6 + 13}, {3.1, 3 + 9 + 16}, {4.7, 1 + 6 + 13 + 19 + 25}}) {
    inlet.radius = 0.01 * spacings;
    const double area = std::numbers::pi * inlet.radius * inlet.radius;
    const double spacing = 2 * inlet.radius / std::round(2 * spacings);
    const std::vector<Vec3d> points = expect_full(0.01, std::size_t(count), area).points;
    for (const Vec3d& x : points) {
      EXPECT_LT(norm(x - inlet.centre), inlet.radius - 0.499 * spacing);
      for (const Vec3d& y : points) {
        EXPECT_TRUE(&x == &y || norm(x - y) > 0.86 * spacing);
      }
    }
    InletFlow flow(inlet, 0.01, {});
    EXPECT_NEAR(flow.rate(1), 2 * area, 1e-12) << "the velocity times the area";
  }
}

TEST(Openings, LayersSpeedUpAsTheRampDoes) {
  InletConfig inlet;
  inlet.shape = "disc";
  inlet.direction = {0, 1, 0};
  inlet.radius = 0.02;
  inlet.velocity = 2;
  inlet.ramp = 0.1;
  const InletFlow flow(inlet, 0.01, {});
  for (const double q : {0.25, 0.5, 0.9}) {
    const RigidMotion m = flow.motion(0.1 * q);
    EXPECT_NEAR(m.v.y, 2 * q * q * (3 - 2 * q), 1e-12);
    EXPECT_NEAR(m.a.y, 2 * 6 * q * (1 - q) / 0.1, 1e-4) << "by a difference over 1e-3 of the ramp";
    EXPECT_NEAR(m.translation.y, 2 * 0.1 * (q * q * q - 0.5 * q * q * q * q), 1e-12);
  }
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
  const double thickness = orifice_layer(c.inlets[0], c.fluid.dx, c.domain).thickness;
  EXPECT_EQ(with.walls.x.size(), without.walls.x.size() + 20 * buffer_layers(c.fluid, thickness));
  EXPECT_EQ(with.walls.body.back(), 1u);
  EXPECT_NEAR(with.walls.x[without.walls.x.size()].z, 0.1 + thickness / 2, 1e-12);
}

TEST(Openings, WrongInlets) {
  EXPECT_EQ(
      error_of(with_inlet("radius = 0.01", "radius = 0.007")),
      "dam.toml:6: fluid.dx = 0.004 must be at most 0.0035 m for four particles across inlet \"feed\"; it "
      "makes 3");
  EXPECT_EQ(
      error_of(with_inlet("radius = 0.01", "radius = 10.01")),
      "dam.toml:6: fluid.dx = 0.004 must be at least 0.005611 m for no more than ten million particles in "
      "inlet \"feed\"");
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
  for (const char* factor : {"0/0", "1/t"})
    EXPECT_NE(error_of(with_inlet("rate = 1e-4", std::string("rate = 1e-4\nfactor = \"") + factor + "\""))
                  .find("must be finite at all times; it is not at t = 0 s"),
              std::string::npos)
        << factor;
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
      in_wall.ends_with("must not lie inside wall.body \"tank\"; leave an opening there, 0.0162975 m deep"))
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
  EXPECT_EQ(from_below("0", "0.05"),
            std::vector<std::string>{
                "inlet \"feed\": wall.body \"column\" next to it ends at its plane, so that fluid leaks out "
                "along its edge; let it reach 0.04 m upstream"});
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
  EXPECT_NE(grains("rate = 5\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.001]").find("must leave space along z"),
            std::string::npos);
  EXPECT_NE(grains("rate = 5\nshape = \"disc\"\ncentre = [0, 0, 0]\ndirection = [0, 0, 1]\nradius = 5e-4")
                .find("must be at least 0.001"),
            std::string::npos);
  EXPECT_NE(error_of(changed("count = 500\n", "count = 500\n[grain.fill.rigid]\n") +
                     "[[outlet]]\nname = \"end\"\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\n")
                .find("outlet.phase = \"both\" must be \"fluid\" where grains form rigid groups"),
            std::string::npos);
  const auto clumps = [](const std::string& rest) {
    return error_of(kCase + "[[clump]]\nname = \"rod\"\nspheres = [[-1, 0, 0, 1], [1, 0, 0, 1]]\n" +
                    "[[grain_inlet]]\nname = \"feed\"\nrate = 5\nmin = [0, 0, 0]\n" + rest);
  };
  EXPECT_EQ(clumps("max = [0.1, 0.1, 0.1]\nclump = \"rod\"\n"), "");
  EXPECT_EQ(clumps("max = [0.1, 0.1, 0.1]\nclump = \"stick\"\n"),
            "dam.toml:33: grain_inlet.clump = \"stick\" must name a clump; this case has rod");
  EXPECT_NE(clumps("max = [0.1, 0.1, 0.1]\nclump = \"rod\"\norientation = [1]\n")
                .find("must be three angles in deg"),
            std::string::npos);
  EXPECT_NE(clumps("max = [0.1, 0.1, 0.003]\nclump = \"rod\"\n").find("must leave space along z"),
            std::string::npos)
      << "a rod of two touching spheres is 3.2 mm long";
}

}  // namespace
}  // namespace bedload::test
