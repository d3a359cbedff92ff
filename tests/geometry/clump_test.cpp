// Clumps in case files: their shapes, where fills place them, what is refused.

#include "bedload/geometry/clump.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "bedload/geometry/body.hpp"
#include "bedload/geometry/setup.hpp"
#include "tests/case/support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace bedload::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A rod of three spheres, in a case that is right; `keys` of its fill.
std::string rods(const std::string& keys, const std::string& more = "") {
  return std::string(R"([domain]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
[[clump]]
name = "rod"
spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]
[grain]
d = 0.006
[[grain.fill]]
)") + (keys.starts_with("positions") ? "" : "min = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\n") +
         "clump = \"rod\"\n" + keys + "\n[time]\nend = 0.1\n[out]\nevery = 0.1\n" + more;
}

Setup placed(const Config& c) {
  std::vector<std::string> warnings;
  return build_setup(c, warnings);
}

TEST(ClumpShape, OneSphereIsExact) {
  const ClumpShape s = clump_shape({{3, 4, 5, 2}});
  EXPECT_EQ(s.fullness, 1);
  EXPECT_DOUBLE_EQ(s.reach, 0.5);
  EXPECT_NEAR(s.spheres[0][3], 0.5, 1e-15);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(s.spheres[0][k], 0, 1e-15);
    EXPECT_NEAR(s.inertia[k], kPi / 6 * 0.1, 1e-14) << "m d^2 / 10";
    EXPECT_EQ(s.inertia[3 + k], 0);
  }
}

TEST(ClumpShape, SpheresThatOverlapAreCountedOnce) {
  // two of radius R, R apart: 9/4 pi R^3
  const ClumpShape two = clump_shape({{0, 0, 0, 2}, {0, 2, 0, 2}});
  EXPECT_NEAR(two.fullness * 2 * 4 / 3, 9.0 / 4, 2e-5);
  EXPECT_NEAR(two.spheres[1][1] - two.spheres[0][1], two.spheres[0][3], 1e-12);
  // a small one within a large one adds nothing, and does not move the centre
  const ClumpShape within = clump_shape({{0, 0, 0, 1}, {0.3, 0, 0.2, 0.5}});
  EXPECT_NEAR(within.fullness * (1 + 0.125), 1, 1e-4);
  EXPECT_NEAR(within.spheres[0][0], 0, 1e-5);
  EXPECT_NEAR(within.inertia[1] / (kPi / 60), 1, 1e-4);
  EXPECT_NEAR(within.offset.x, 0.125 / 1.125 * 0.3 * within.spheres[0][3], 1e-5);
  // many along a line: a capsule, 20 radii from end to end
  std::vector<ClumpSphere> line;
  for (int k = -180; k <= 180; k += 2) line.push_back({0.05 * k, 0, 0, 1});
  const ClumpShape capsule = clump_shape(line);
  const double V = kPi * (18 + 4.0 / 3), d = std::cbrt(6 * V / kPi);
  EXPECT_NEAR(1 / capsule.spheres[0][3], d, 2e-3 * d);
  EXPECT_NEAR(capsule.inertia[0] * std::pow(d, 5), kPi * (18.0 / 2 + 8.0 / 15), 0.01 * kPi * 9.53);
}

TEST(ClumpShape, ResistsBlowsWithMassAndInertia) {
  EXPECT_EQ(clump_shape({{1, 2, 3, 4}}).contact_mass, 1);
  // two that touch, each 1 and of radius 1: about their centre 0.8 along and 0.8 + 2 across; a blow across,
  // in two of three directions, meets 1 / (1/2 + 1/2.8)
  EXPECT_NEAR(clump_shape({{0, 0, 0, 1}, {0, 0, 2, 1}}).contact_mass, 2 / (1 + 2 * 2.0 / 3 / 2.8) / 1, 1e-9);
}

TEST(ClumpShape, DoesNotDependOnItsPlaceOrUnit) {
  const std::vector<ClumpSphere> one{{0, 0, 0, 1}, {0.7, 0.2, 0, 0.8}, {0.1, -0.6, 0.9, 0.5}};
  std::vector<ClumpSphere> other;
  for (const ClumpSphere& s : one) other.push_back({7 + 3 * s[0], 3 * s[1] - 2, 3 * s[2], 3 * s[3]});
  const ClumpShape a = clump_shape(one), b = clump_shape(other);
  EXPECT_NEAR(a.fullness, b.fullness, 1e-9);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(a.inertia[k], b.inertia[k], 1e-9);
  EXPECT_GT(std::abs(a.inertia[3]), 1e-3) << "no symmetry";
}

TEST(ClumpCase, ReadsBackAsResolved) {
  const Config c = read(rods("count = 20\norientation = [0, 90, 0]\n"));
  ASSERT_EQ(c.grain.clump_fills(), std::vector<int>{0});
  EXPECT_EQ(read(resolved_toml(c)).grain, c.grain);
  const double R = c.grain.clumps[0].shape.spheres[0][3] * 0.006;
  EXPECT_DOUBLE_EQ(c.grain.d_max, 2 * R);
  EXPECT_DOUBLE_EQ(c.grain.d_min, 2 * R);
  const auto all = c.grain.all_materials();
  ASSERT_EQ(all.size(), 2u);
  // three spheres weigh what their union does
  EXPECT_NEAR(3 * all[1].rho * 4 / 3 * kPi * R * R * R, 2500 * kPi / 6 * std::pow(0.006, 3), 1e-15);
}

TEST(ClumpCase, ReadsSpheresFromAFile) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "rod.txt") << "# x y z r\n-1 0 0 1\n0, 0, 0, 1\n\n1\t0 0 1 # the last\n";
  const auto spheres = read_spheres(folder.path() / "rod.txt");
  EXPECT_EQ(spheres, (std::vector<ClumpSphere>{{-1, 0, 0, 1}, {0, 0, 0, 1}, {1, 0, 0, 1}}));
  std::ofstream(folder.path() / "short.txt") << "0 0 0 1\n0 0 1\n";
  try {
    read_spheres(folder.path() / "short.txt");
    FAIL();
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("short.txt:2: must hold four numbers"), std::string::npos);
  }
}

TEST(ClumpCase, FillsAShapeWithSpheres) {
  std::string text = rods("count = 5\n", R"([[shape]]
name = "brick"
kind = "box"
min = [1, 0, 0]
max = [2, 1, 2]
)");
  const std::string spheres = "spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]";
  text.replace(text.find(spheres), spheres.size(), "shape = \"brick\"\ncount = 20");
  std::vector<std::string> warnings;
  const Config c = read_case_text(text, "dam.toml", {}, warnings);
  const ClumpConfig& brick = c.grain.clumps[0];
  ASSERT_EQ(brick.spheres.size(), 20u);
  EXPECT_NEAR(brick.spheres[0][3], 0.5, 1e-2) << "the largest first";
  for (const auto& [x, y, z, r] : brick.spheres) {
    EXPECT_GE(std::min({x - 1, 2 - x, y, 1 - y, z, 2 - z}), r - 1e-12) << "within";
    EXPECT_LE(r, brick.spheres[0][3] + 1e-2);
  }
  EXPECT_GT(brick.filled, 0.65);
  EXPECT_LT(brick.filled, 0.9);
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings[0].find("the spheres of \"rod\" fill"), std::string::npos) << warnings[0];
  // the volume is that of the spheres, and the longest way that of the brick
  const Vec3d of = principal_inertia(brick.shape.inertia).moments;
  EXPECT_NEAR(std::min({of.x, of.y, of.z}) / std::max({of.x, of.y, of.z}), 0.4, 0.06) << "as of a brick";
}

TEST(ClumpCase, SaysWhatIsWrong) {
  const auto expect = [](const std::string& text, const std::string& part) {
    const std::string error = error_of(text);
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  const std::string good = rods("count = 20\n");
  EXPECT_EQ(error_of(good), "");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  expect(with("clump = \"rod\"", "clump = \"road\""),
         "grain.fill.clump = \"road\" must name a clump; this case has rod");
  expect(with("[1, 0, 0, 1]]", "[1, 0, 0, 1]]\ndrag = \"sphere\""),
         "clump.drag = \"sphere\" must be one of clump, members");
  expect(with("[1, 0, 0, 1]]", "[1, 0, 0, 0]]"), "clump.spheres = [.., r = 0] must have radii > 0");
  expect(with("[1, 0, 0, 1]]", "[1, 0, 0]]"), "must be a list of spheres [[x, y, z, r], ...]");
  expect(with("spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]", ""), "clump.spheres must be given");
  expect(with("[[clump]]", "[[clump]]\nname = \"rod\"\nspheres = [[0, 0, 0, 1]]\n[[clump]]"),
         "clump.name = \"rod\" must differ from other clumps'");
  expect(with("spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]", "shape = \"rock\""),
         "clump.count must be given");
  for (const char* file : {"nothing.txt", "/dev/zero"})
    expect(with("spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]", fmt::format("file = \"{}\"", file)),
           fmt::format("clump.file = \"{}\" holds no spheres", file));
  expect(rods("count = 20\norientation = [0, 90]\n"), "grain.fill.orientation");
  expect(rods("count = 20\n[grain.fill.rigid]\n"), "grain.fill.rigid");
  EXPECT_EQ(
      error_of(rods("count = 20\n", "[[outlet]]\nname = \"end\"\nmin = [0, 0, 0]\nmax = [0.01, 0.1, 0.1]\n")),
      "");
  expect(rods("count = 20\n", "[domain.reflect]\nslip = [\"x-\"]\n"), "must not be given with clumps");
}

TEST(ClumpFill, PlacesThemApartInAllDirections) {
  const Config c = read(rods("packing_fraction = 0.1\n"));
  const Setup::Grains g = placed(c).grains;
  const double v = kPi / 6 * std::pow(0.006, 3);
  ASSERT_EQ(g.clumps.size(), std::size_t(std::llround(0.1 * 1e-3 / v)));
  ASSERT_EQ(g.x.size(), 3 * g.clumps.size());
  Vec3d axes, mean;
  for (const auto& clump : g.clumps) {
    const Vec3d along = clump.rotation.rotate({1, 0, 0});
    for (int k = 0; k < 3; ++k) axes[k] += along[k] * along[k] / double(g.clumps.size());
    mean += along / double(g.clumps.size());
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(axes[k], 1.0 / 3, 4 * 0.3 / std::sqrt(double(g.clumps.size())));
  EXPECT_LT(norm(mean), 4 / std::sqrt(double(g.clumps.size())));
  for (std::size_t i = 0; i < g.x.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (g.clump[i] != g.clump[j]) {
        ASSERT_GE(norm(g.x[i] - g.x[j]), (g.radius[i] + g.radius[j]) * (1 - 1e-9));
      }
  EXPECT_EQ(placed(c).grains.x, g.x) << "the same case, the same grains";
}

TEST(ClumpFill, TakesPlacesOrientationMassAndSizes) {
  const Config c =
      read(rods("positions = [[0.05, 0.05, 0.05]]\norientation = [0, -90, 0]\nspin = [0, 2, 0]\n"));
  const Setup::Grains g = placed(c).grains;
  ASSERT_EQ(g.x.size(), 3u);
  const double R = g.radius[0];
  for (int k = 0; k < 3; ++k) EXPECT_LT(norm(g.x[k] - Vec3d{0.05, 0.05, 0.05 + (k - 1) * R}), 1e-9);
  EXPECT_LT(norm(g.v[2] - Vec3d{2 * R, 0, 0}), 1e-9);
  const Config by_mass = read(
      rods("mass = 0.01\nsizes = [{ d = 0.004, mass_fraction = 1 }, { d = 0.006, mass_fraction = 1 }]\n"));
  double mass = 0;
  for (const auto& clump : placed(by_mass).grains.clumps) mass += 2500 * kPi / 6 * std::pow(clump.d, 3);
  EXPECT_NEAR(mass, 0.01, 3e-4);
  const std::string close =
      "positions = [[0.05, 0.05, 0.05], [0.05, 0.05, 0.055]]\norientation = [0, 90, 0]\n";
  try {
    placed(read(rods(close)));
    FAIL();
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("grain 2 at (0.05, 0.05, 0.055) m lies inside another grain"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace bedload::test
