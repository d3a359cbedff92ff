// Shapes in case files: what walls, water and grains make of them, and what is refused.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "bedload/case/read.hpp"
#include "bedload/geometry/build_shape.hpp"
#include "bedload/geometry/setup.hpp"
#include "mesh_support.hpp"

namespace bedload::test {
namespace {

const char* const kDrum = R"(
[domain]
min = [-0.1, -0.1, -0.1]
max = [0.1, 0.1, 0.1]
[[shape]]
name = "inside"
kind = "cylinder"
a = [0, -0.05, 0]
b = [0, 0.05, 0]
radius = 0.05
[[shape]]
name = "drum"
kind = "hollow"
of = ["inside"]
[fluid]
dx = 0.004
[[fluid.fill]]
shape = "inside"
level = 0.0
[[wall.body]]
name = "drum"
shape = "drum"
[grain]
d = 0.005
[[grain.fill]]
shape = "inside"
packing_fraction = 0.1
[time]
end = 1
[out]
every = 1
)";

Config read(const std::string& text, const std::string& name = "drum.toml") {
  std::vector<std::string> warnings;
  return read_case_text(text, name, {}, warnings);
}
std::string with(const std::string& from, const std::string& to) {
  std::string text = kDrum;
  text.replace(text.find(from), from.size(), to);
  return text;
}
std::string refused(const std::string& from, const std::string& to) {
  return error_in([&] { read(with(from, to)); });
}

TEST(ShapeCase, WaterGrainsAndWallsFollowACurvedVessel) {
  const Config c = read(kDrum);
  std::vector<std::string> warnings;
  const auto setup = build_setup(c, warnings);
  const double dx = c.fluid.dx, half = 0.5 * M_PI * 0.05 * 0.05 * 0.1, clear = 0.48 * dx;

  double mass = 0;
  for (const double m : setup.fluid.mass) mass += m;
  EXPECT_NEAR(mass / (1000 * half), 1, 1e-3);
  EXPECT_NEAR(double(setup.fluid.x.size()) * dx * dx * dx / half, 1, 0.06) << "cells divide the sides evenly";
  double nearest = 1;
  for (std::size_t a = 0; a < setup.fluid.x.size(); ++a) {
    const Vec3d& x = setup.fluid.x[a];
    EXPECT_LT(std::hypot(x.x, x.z), 0.05 - clear);
    EXPECT_LT(std::abs(x.y), 0.05 - clear);
    EXPECT_LT(x.z, -clear);
    for (std::size_t b = 0; b < a; ++b) nearest = std::min(nearest, norm(x - setup.fluid.x[b]));
  }
  EXPECT_GT(nearest, 0.8 * dx) << "no two crowd each other";

  ASSERT_FALSE(setup.walls.x.empty());
  EXPECT_EQ(c.shapes[1].thickness, 0.012) << "three layers reach as far as the kernel";
  for (const Vec3d& x : setup.walls.x) EXPECT_GT(c.shapes[0].solid.shape->distance(x), 0.499 * dx);

  double solid = 0;
  for (std::size_t i = 0; i < setup.grains.x.size(); ++i) {
    const Vec3d& x = setup.grains.x[i];
    const double r = setup.grains.radius[i];
    EXPECT_LE(std::hypot(x.x, x.z), 0.05 - r * (1 - 1e-5));
    EXPECT_LE(std::abs(x.y), 0.05 - r * (1 - 1e-5));
    solid += 4.0 / 3.0 * M_PI * r * r * r;
  }
  EXPECT_NEAR(solid / (2 * half), 0.1, 1e-3);
}

TEST(ShapeCase, VolumeBelowALevel) {
  const auto ball = make_sphere({0, 0, 0}, 1);
  EXPECT_NEAR(volume_below(*ball, {0, 0, 1}, Bounds::kInfinity, 0.03), 4.0 / 3 * M_PI, 2e-3);
  EXPECT_NEAR(volume_below(*ball, {0, 1, 0}, 0, 0.03), 2.0 / 3 * M_PI, 2e-3);
  EXPECT_NEAR(volume_below(*ball, {0, 0, 1}, -0.5, 0.03), M_PI * 0.25 * 2.5 / 3, 2e-3);
}

TEST(ShapeCase, PlacesAndCombines) {
  const Config c = read(with("[fluid]\n", R"([[shape]]
name = "ball"
kind = "sphere"
centre = [0.01, 0, 0]
radius = 0.01
scale = 2
turn_axis = [0, 0, 2]
turn_angle = 90
translate = [0, 0, 0.05]
[[shape]]
name = "both"
kind = "union"
of = ["ball", "inside"]
[[shape]]
name = "rest"
kind = "difference"
of = ["inside", "ball"]
[fluid]
)"));
  const Shape& ball = *c.shapes[2].solid.shape;
  EXPECT_NEAR(ball.distance({0, 0.02, 0.05}), -0.02, 1e-15);
  EXPECT_LT(c.shapes[3].solid.shape->distance({0, 0.02, 0.06}), 0);
  EXPECT_GT(c.shapes[4].solid.shape->distance({0, 0.02, 0.04}), 0);
}

/// A drum of which lifters about its axis are written one by one, or as copies.
std::string lifters(bool copies) {
  const std::string box =
      "kind = \"box\"\nmin = [0.04, -0.05, -0.005]\nmax = [0.052, 0.05, 0.005]\nturn_axis = [0, 1, 0]\n";
  std::string text, of;
  for (int n = 0; n < (copies ? 1 : 8); ++n) {
    text += fmt::format("[[shape]]\nname = \"lifter{}\"\n{}turn_angle = {}\n", n, box, 45 * n);
    of += fmt::format(", \"lifter{}\"", n);
  }
  if (copies) text += "[shape.copies]\ncount = 8\nabout = [0, 1, 0]\n";
  text += "[[shape]]\nname = \"mill\"\nkind = \"union\"\nof = [\"drum\"" + of + "]\n[fluid]\n";
  std::string all = with("[fluid]\n", text);
  all.replace(all.find("shape = \"drum\""), 14, "shape = \"mill\"");
  return all;
}

TEST(ShapeCase, CopiesEqualShapesWrittenOneByOne) {
  const Config one = read(lifters(false)), other = read(lifters(true));
  EXPECT_EQ(other.shapes[2].copies.angle, 45);
  const Shape &a = *one.shapes.back().solid.shape, &b = *other.shapes.back().solid.shape;
  for (int n = 0; n < 1000; ++n) {
    const Vec3d x{0.06 * std::sin(n), 0.055 * std::sin(7.3 * n), 0.06 * std::cos(3.1 * n)};
    EXPECT_EQ(a.distance(x), b.distance(x));
  }
  std::vector<SurfacePart> parts, copied;
  a.add_parts(parts, {}), b.add_parts(copied, {});
  ASSERT_EQ(copied.size(), parts.size());
  for (std::size_t n = 0; n < parts.size(); ++n) EXPECT_EQ(copied[n].centre, parts[n].centre);
  std::vector<std::string> warnings;
  const auto written = build_setup(one, warnings), made = build_setup(other, warnings);
  EXPECT_EQ(made.walls.x, written.walls.x);
  EXPECT_EQ(made.fluid.x, written.fluid.x) << "the fluid leaves out the same";
  EXPECT_EQ(made.grains.x, written.grains.x);
  EXPECT_EQ(read(resolved_toml(other)), other);
}

TEST(ShapeCase, CopiesInARowWeighWhatTheyAre) {
  const auto rods = [](const std::string& copies, const std::string& more = "") {
    return with(
        "[fluid]\n",
        "[[shape]]\nname = \"rod\"\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [0.01, 0.02, 0.01]\ntranslate = "
        "[-0.03, 0, 0.06]\n[shape.copies]\n" +
            copies + more +
            "[[wall.body]]\nname = \"rods\"\nshape = \"rod\"\n[wall.body.free]\ndensity = 500\n"
            "contacts = false\n[fluid]\n");
  };
  const Config c = read(rods("count = 3\nalong = [0.02, 0, 0]\n"));
  const MassProperties& m = c.wall.bodies[0].free.solid;
  const double one = 500 * 2e-6;
  EXPECT_NEAR(m.mass, 3 * one, 0.005 * 3 * one);
  EXPECT_NEAR(m.centre.x, -0.005, 5e-5);
  // about z: three boxes of 1 x 2 cm, two of them 2 cm aside
  const double about_z = one * (3 * 5e-4 / 12 + 2 * 4e-4);
  EXPECT_NEAR(m.inertia[2], about_z, 0.01 * about_z);
  EXPECT_NEAR(c.shapes.back().solid.shape->distance({0.015, 0.01, 0.065}), -0.005, 1e-15);

  const Config helix = read(
      rods("count = 2\nabout = [0, 0, 3]\ncentre = [-0.03, 0, 0]\nangle = 90\n", "along = [0, 0, 0.02]\n"));
  EXPECT_NEAR(helix.shapes.back().solid.shape->distance({-0.04, 0.005, 0.085}), -0.005, 1e-12)
      << "turned about the axis, then moved on";
}

TEST(ShapeCase, SaysWhatCopiesLack) {
  const auto says = [](const std::string& copies) {
    return refused("radius = 0.05\n", "radius = 0.05\n[shape.copies]\n" + copies);
  };
  EXPECT_EQ(
      says("count = 2\n"),
      "drum.toml:11: shape.copies must have about, the direction of an axis, or along, the way to the next "
      "copy");
  EXPECT_EQ(
      says("count = 2\nalong = [0.1, 0, 0]\nangle = 30\n"),
      "drum.toml:14: shape.copies.angle = 30 must stand with shape.copies.about, the direction of an axis");
  EXPECT_EQ(says("count = 0\nalong = [0.1, 0, 0]\n"),
            "drum.toml:12: shape.copies.count = 0 must be within 1..10000");
  EXPECT_EQ(says("count = 2.5\nalong = [0.1, 0, 0]\n"),
            "drum.toml:12: shape.copies.count = 2.5 must be a whole number");
  EXPECT_EQ(says("count = 10001\nalong = [0.1, 0, 0]\n"),
            "drum.toml:12: shape.copies.count = 10001 must be within 1..10000");
  EXPECT_NE(
      says("count = 2\nalong = [0, 0.2, 0]\n").find("hollow: grains can meet it only around a single box"),
      std::string::npos);
}

TEST(ShapeCase, ReadsBackWhatWasResolvedMeshesIncluded) {
  const TemporaryFolder folder;
  std::ofstream(folder / "box.obj") << "v 0 0 0\nv 20 0 0\nv 20 20 0\nv 0 20 0\nv 0 0 20\nv 20 0 20\n"
                                       "v 20 20 20\nv 0 20 20\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\n"
                                       "f 3 4 8 7\nf 4 1 5 8\n";
  const std::string text = with("[fluid]\n", R"([[shape]]
name = "block"
kind = "mesh"
file = "box.obj"
scale = 0.001
[[wall.body]]
name = "block"
shape = "block"
[fluid]
)");
  const std::string name = (folder / "drum.toml").string();
  const Config c = read(text, name);
  EXPECT_NEAR(c.shapes[2].solid.shape->distance({0.01, 0.01, 0.03}), 0.01, 1e-9);
  EXPECT_EQ(c.shapes[2].digest.size(), 16u);
  Config again = read(resolved_toml(c), name);
  again.file = c.file;
  EXPECT_EQ(again, c);

  std::string changed = resolved_toml(c);
  changed.replace(changed.find(c.shapes[2].digest), 16, "0123456789abcdef");
  EXPECT_NE(error_in([&] { read(changed, name); }).find("the file has changed"), std::string::npos);
}

/// A mesh of floats ends within their rounding of the sides that it is to reach.
TEST(ShapeCase, AMeshMaySpanAPeriod) {
  const TemporaryFolder folder;
  const auto refusal = [&](double lo, double hi, const std::string& sides) {
    const double y = 0.5 * (hi - lo);
    write_stl(folder / "block.stl",
              moved(prism({{0, 0}, {0.02, 0}, {0.02, 2 * y}, {0, 2 * y}}, {{0, 1, 2}, {0, 2, 3}}, 0.02),
                    {0, lo, -0.1}));
    return error_in([&] {
      read("[domain]\nmin = [-0.1, " + sides + ", 0.1]\nperiodic = [false, true, false]\n" +
               "[[shape]]\nname = \"block\"\nkind = \"mesh\"\nfile = \"block.stl\"\n[[wall.body]]\nname = "
               "\"block\"\nshape = \"block\"\n[grain]\nd = 0.005\n[[grain.fill]]\npositions = [[0.05, " +
               std::to_string(lo + 0.05) + ", 0]]\n[time]\nend = 1\n[out]\nevery = 1\n",
           (folder / "block.toml").string());
    });
  };
  EXPECT_EQ(refusal(-0.1, 0.1, "-0.1, -0.1]\nmax = [0.1, 0.1"), "");
  EXPECT_EQ(refusal(-1.0 / 3, 1.0 / 3, "-0.3333333333, -0.1]\nmax = [0.1, 0.3333333333"), "");
  EXPECT_EQ(refusal(99.9, 100.1, "99.9, -0.1]\nmax = [0.1, 100.1"), "") << "far from the origin";
  EXPECT_NE(refusal(-0.1, 0.10001, "-0.1, -0.1]\nmax = [0.1, 0.1").find("must lie within the period along y"),
            std::string::npos);
}

TEST(ShapeCase, SaysWhatIsWrong) {
  EXPECT_EQ(
      refused("shape = \"drum\"", "shape = \"pot\""),
      "drum.toml:22: wall.body.shape = \"pot\" must be tank, box, plane or the name of a [[shape]]; this "
      "case has inside, drum");
  EXPECT_EQ(refused("of = [\"inside\"]", "of = [\"later\"]"),
            "drum.toml:11: shape \"drum\": of = \"later\" must name a shape listed before it: inside");
  EXPECT_EQ(refused("name = \"drum\"\nkind", "name = \"inside\"\nkind"),
            "drum.toml:12: shape.name = \"inside\" must differ from other shapes'");
  std::string doubled = "kind = \"union\"\nof = [\"inside\", \"inside\"]\n";
  for (int n = 0; n < 40; ++n)
    doubled += "[[shape]]\nname = \"u" + std::to_string(n) + "\"\nkind = \"union\"\nof = [\"" +
               (n == 0 ? std::string("drum") : "u" + std::to_string(n - 1)) + "\", \"" +
               (n == 0 ? std::string("drum") : "u" + std::to_string(n - 1)) + "\"]\n";
  EXPECT_NE(refused("kind = \"hollow\"\nof = [\"inside\"]\n", doubled)
                .find("is made of 16384 pieces, must be of at most 10000"),
            std::string::npos);
  EXPECT_EQ(refused("radius = 0.05", "radius = 0"), "drum.toml:10: shape.radius = 0 must be > 0");
  EXPECT_EQ(refused("b = [0, 0.05, 0]", "b = [0, -0.05, 0]"),
            "drum.toml:5: shape \"inside\": cylinder: its ends (0, -0.05, 0) and (0, -0.05, 0) m must lie "
            "apart");
  EXPECT_EQ(refused("kind = \"hollow\"\nof = [\"inside\"]\n",
                    "kind = \"difference\"\nof = [\"inside\", \"inside\"]\n"),
            "drum.toml:22: wall.body.shape = \"drum\" makes no wall: difference: with a facet of 0.00173205 "
            "m, nothing is left of what the difference is taken from, or less than that");
  EXPECT_EQ(refused("level = 0.0", "level = -0.06"),
            "drum.toml:19: fluid.fill.level = -0.06 must lie above the bottom of shape \"inside\"");
  EXPECT_EQ(refused("kind = \"hollow\"", "kind = \"vessel\"").substr(0, 44),
            "drum.toml:13: shape.kind = \"vessel\" must be ");
  EXPECT_EQ(refused("max = [0.1, 0.1, 0.1]", "max = [0.1, 0.1, 0.1]\nperiodic = [false, true, false]"), "");
  EXPECT_NE(refused("max = [0.1, 0.1, 0.1]", "max = [0.1, 0.05, 0.1]\nperiodic = [false, true, false]")
                .find("must lie within the period along y"),
            std::string::npos);
}

}  // namespace
}  // namespace bedload::test
