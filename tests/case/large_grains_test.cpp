// grain.resolve and couple.between: grains around which the fluid flows become free bodies.

#include <gtest/gtest.h>

#include <cmath>

#include "support.hpp"

namespace bedload::test {
namespace {

/// Besides the grains of 2 mm two of steel, of this diameter (m), in fluid of 4 mm.
std::string with(const std::string& d, const std::string& more = "") {
  return changed("[time]\n",
                 "[[grain.material]]\nname = \"steel\"\nrho = 7800\nmu = 0.2\n[[grain.fill]]\n" +
                     ("material = \"steel\"\nsizes = [{ d = " + d + ", number_fraction = 1 }]\n") +
                     "velocity = [0.1, 0, 0]\n" +
                     (more.empty() ? "positions = [[0.1, 0.05, 0.1], [0.15, 0.05, 0.12]]\n" : more) +
                     "[time]\n");
}
std::string refused(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const std::string message = error_of(text, overrides);
  return message.substr(std::min(message.size(), message.find(": ") + 2));
}

TEST(LargeGrains, AreFreeBodiesFromEightSpacingsOn) {
  const auto again = [](const Config& c) {
    Config of = read(resolved_toml(c));
    of.file = c.file;
    return of;
  };
  const Config alone = read(kCase, {"grain.d=0.04", "grain.fill.0.count=2"});
  EXPECT_EQ(alone.wall.bodies.size(), 3u);
  EXPECT_FALSE(alone.grain.present);
  EXPECT_EQ(alone, again(alone));
  const Config c = read(with("0.036"));
  EXPECT_EQ(c, again(c));
  ASSERT_EQ(c.wall.bodies.size(), 3u);
  EXPECT_EQ(c.grain.fills.size(), 1u);
  EXPECT_EQ(c.grain.d_max, 0.002);
  const WallBody& body = c.wall.bodies[2];
  EXPECT_EQ(body.name, "resolved_2_2");
  EXPECT_NEAR(body.min.x, 0.15 - 0.018, 1e-12);
  EXPECT_NEAR(body.max.z, 0.12 + 0.018, 1e-12);
  EXPECT_TRUE(body.free.present);
  EXPECT_NEAR(body.free.solid.mass, 7800 * M_PI / 6 * std::pow(0.036, 3), 1e-3 * body.free.solid.mass);
  EXPECT_EQ(body.free.velocity, (Vec3d{0.1, 0, 0}));
  EXPECT_EQ(body.free.mu, 0.2);
  EXPECT_EQ(body.mu, 0.2);
  EXPECT_EQ(body.E, c.grain.E);
}

TEST(LargeGrains, AreThrownIntoBoxesByNumberMassOrFraction) {
  const std::string box = "min = [0.06, 0, 0.1]\nmax = [0.2, 0.1, 0.2]\n";
  const double each = M_PI / 6 * std::pow(0.032, 3);
  for (const std::string& count :
       {std::string("count = 4\n"), "mass = " + std::to_string(4 * 7800 * each) + "\n",
        "packing_fraction = " + std::to_string(4 * each / (0.14 * 0.1 * 0.1)) + "\n"}) {
    const Config c = read(with("0.032", box + count));
    ASSERT_EQ(c.wall.bodies.size(), 5u) << count;
    for (int i = 1; i < 5; ++i)
      for (int j = 1; j < i; ++j)
        EXPECT_GE(norm(c.wall.bodies[i].free.solid.centre - c.wall.bodies[j].free.solid.centre), 0.032);
  }
  EXPECT_NE(refused(with("0.032", box + "count = 90\n")).find("must fit into the box at random"),
            std::string::npos);
}

TEST(LargeGrains, AreTreatedAsTheCaseSays) {
  const auto bodies = [](const std::string& d, const std::vector<std::string>& overrides) {
    return read(with(d), overrides).wall.bodies.size();
  };
  EXPECT_EQ(bodies("0.036", {"grain.resolve=none"}), 1u);
  EXPECT_EQ(bodies("0.036", {"couple.mode=off"}), 1u);
  EXPECT_EQ(bodies("0.016", {}), 1u);  // four spacings
  EXPECT_EQ(
      refused(with("0.02")),
      "couple.between = \"refuse\" must be \"unresolved\" or \"resolved\" with grains of 0.02 m, 5 times "
      "fluid.dx: too large for drag laws, which take what is up to 2 times as large, and too small for the "
      "fluid to flow around them, as it does from 8 times on");
  EXPECT_EQ(bodies("0.02", {"couple.between=unresolved"}), 1u);
  EXPECT_EQ(bodies("0.02", {"couple.between=resolved"}), 3u);
  EXPECT_EQ(refused(with("0.036"), {"grain.resolve=all"}),
            "grain.fill.sizes has grains of 0.002 m, 0.5 times fluid.dx, around which the fluid flows: they "
            "must be at "
            "least 4 times as large (or grain.resolve = \"none\")");
  EXPECT_EQ(refused(with("0.036 }, { d = 0.002")),
            "grain.fill.sizes has grains of 0.036 m, 9 times fluid.dx, around which the fluid flows: they "
            "must be in a "
            "fill of their own, of one diameter (or grain.resolve = \"none\")");
}

}  // namespace
}  // namespace bedload::test
