// Probes as a case gives them: the directions of patches, what each key may be, places that see nothing.

#include <gtest/gtest.h>

#include <cmath>

#include "support.hpp"

namespace bedload::test {
namespace {

std::string with_probe(const std::string& lines) { return kCase + "[[probe]]\nname = \"p\"\n" + lines; }

std::string patch(const std::string& at, const std::string& more = "size = [0.02, 0.02]\n",
                  const std::string& body = "tank") {
  return with_probe("type = \"wall_pressure\"\nbody = \"" + body + "\"\nat = " + at + "\n" + more);
}

/// What `text` is refused with, behind the place.
std::string refused(const std::string& text) {
  const std::string message = error_of(text);
  EXPECT_TRUE(message.starts_with("dam.toml:2") || message.starts_with("dam.toml:3")) << message;
  return message.substr(std::min(message.size(), message.find(": ") + 2));
}

void expect_near(const Vec3d& a, const Vec3d& b) {
  EXPECT_LT(norm(a - b), 1e-12) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(PatchCase, LiesAsTheSurfaceDoes) {
  const auto probe = [](const std::string& text) { return read(text).out.probes.at(0); };
  const ProbeConfig floor = probe(patch("[0.1, 0.05, 0]"));
  expect_near(floor.normal, {0, 0, 1});
  expect_near(floor.along, {1, 0, 0});
  EXPECT_DOUBLE_EQ(floor.every, 0.01);
  const ProbeConfig left = probe(patch("[0, 0.05, 0.05]"));
  expect_near(left.normal, {1, 0, 0});
  expect_near(left.along, {0, 1, 0});
  const ProbeConfig right = probe(patch("[0.2, 0.05, 0.05]"));
  expect_near(right.normal, {-1, 0, 0});
  expect_near(right.along, {0, -1, 0});
  const ProbeConfig leaning =
      probe(patch("[0.2, 0.05, 0.05]", "radius = 0.01\nnormal = [-2, 0, 0]\nalong = [5, 0, 3]\n"));
  expect_near(leaning.normal, {-1, 0, 0});
  expect_near(leaning.along, {0, 0, 1});
  const std::string plane =
      "[[wall.body]]\nname = \"slope\"\nshape = \"plane\"\npoint = [0.2, 0, 0]\nnormal = [-3, 0, 4]\n";
  expect_near(probe(patch("[0.2, 0.05, 0]", "radius = 0.01\n", "slope") + plane).normal, {-0.6, 0, 0.8});
  const std::string box =
      "[[wall.body]]\nname = \"block\"\nshape = \"box\"\nmin = [0.1, 0.03, 0]\nmax = [0.15, 0.06, 0.1]\n";
  expect_near(probe(patch("[0.12, 0.04, 0.1]", "radius = 0.01\n", "block") + box).normal, {0, 0, 1});
  expect_near(probe(patch("[0.12, 0.03, 0.05]", "radius = 0.01\n", "block") + box).normal, {0, -1, 0});
  expect_near(probe(patch("[0.1, 0.04, 0.05]", "radius = 0.01\n", "block") + box).normal, {-1, 0, 0});
  const std::string ball =
      "[[shape]]\nname = \"ball\"\nkind = \"sphere\"\ncentre = [0.1, 0.05, 0.1]\nradius = 0.02\n"
      "[[wall.body]]\nname = \"ball\"\nshape = \"ball\"\n";
  const ProbeConfig on_ball = probe(patch("[0.112, 0.05, 0.116]", "radius = 0.005\n", "ball") + ball);
  expect_near(on_ball.normal, {0.6, 0, 0.8});
  expect_near(on_ball.along, {0, 1, 0});
}

TEST(PatchCase, IsWrittenAsResolved) {
  for (const std::string& text :
       {patch("[0.2, 0.05, 0.05]", "size = [0.02, 0.04]\ncount = [2, 3]\nnormal = [-1, 0.3, 0.1]\n"),
        patch("[0.1, 0.05, 0]", "radius = 0.01\n"),
        with_probe("type = \"point\"\nat = [0.1, 0.05, 0.1]\nbody = \"tank\"\n")}) {
    const Config once = read(text);
    Config again = read(resolved_toml(once));
    again.file = once.file;
    EXPECT_EQ(once, again);
  }
}

TEST(PatchCase, SaysWhatItsKeysMayBe) {
  const std::string at = "[0.1, 0.05, 0]";
  EXPECT_EQ(refused(patch(at, "")), "probe \"p\" must have exactly one of radius and size");
  EXPECT_EQ(refused(patch(at, "radius = 0.01\nsize = [0.01, 0.01]\n")),
            "probe.size = [0.01, 0.01] is not used by the chosen options; remove it");
  EXPECT_EQ(refused(patch(at, "radius = 0.01\ncount = [1, 2]\n")),
            "probe.count = [1, 2] is not used by the chosen options; remove it");
  EXPECT_EQ(refused(patch(at, "radius = 0\n")), "probe.radius = 0 must be > 0");
  EXPECT_EQ(refused(patch(at, "size = [0.01, 0]\n")), "probe.size = [0.01, 0] must hold numbers > 0");
  EXPECT_EQ(refused(patch(at, "size = [0.01]\n")), "probe.size = [0.01] must hold two lengths");
  const std::string size = "size = [0.01, 0.01]\n";
  EXPECT_EQ(refused(patch(at, size + "count = [0, 1]\n")),
            "probe.count = [0, 1] must hold numbers within 1..1000");
  EXPECT_EQ(refused(patch(at, size + "count = [1, 1001]\n")),
            "probe.count = [1, 1001] must hold numbers within 1..1000");
  EXPECT_EQ(refused(patch(at, size + "count = [1, 1.5]\n")),
            "probe.count = [1, 1.5] must hold two whole numbers");
  EXPECT_EQ(refused(patch(at, size + "count = [1, 2, 3]\n")),
            "probe.count = [1, 2, 3] must hold two whole numbers");
  EXPECT_EQ(refused(patch(at, size + "count = [101, 100]\n")),
            "probe.count = [101, 100] must make at most 10000 patches");
  EXPECT_EQ(refused(patch(at, size + "along = [0, 0, 2]\n")),
            "probe.along = [0, 0, 2] must not point along the normal");
  EXPECT_EQ(error_of(patch(at, size + "count = [100, 100]\n")), "");
}

TEST(PatchCase, LiesOnAWallThatStopsFluid) {
  const std::string size = "size = [0.01, 0.01]\n";
  EXPECT_EQ(refused(patch("[0.1, 0.05, 0]", size, "gate")),
            "probe.body = \"gate\" must name a wall.body that stops fluid; this case has tank");
  EXPECT_EQ(refused(patch("[0.1, 0.05, 0.004]", size)),
            "probe.at = [0.1, 0.05, 0.004] must lie on the surface of wall.body \"tank\", up to half a "
            "fluid.dx; it "
            "is 0.004 m away");
  EXPECT_EQ(error_of(patch("[0.1, 0.05, 0.0019]", size)), "");
  EXPECT_EQ(
      refused(patch("[0.1, 0.05, 0]", size, "sieve") +
              "[[wall.body]]\nname = \"sieve\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [0.2, 0.1, 0.01]\n"
              "type = \"grains_only\"\n"),
      "probe.body = \"sieve\" must name a wall.body that stops fluid; this case has tank");
}

TEST(ProbeCase, RefusesPlacesThatSeeNothing) {
  const std::string domain = "the domain [0, 0, 0]..[0.2, 0.1, 0.2]";
  EXPECT_EQ(refused(with_probe("type = \"point\"\nat = [0.3, 0.05, 0]\n")),
            "probe.at = [0.3, 0.05, 0] must lie in " + domain);
  EXPECT_EQ(refused(with_probe("type = \"height\"\nat = [0.1, 0.11, 0]\n")),
            "probe.at = [0.1, 0.11, 0] must have a part of " + domain + " above or below it");
  EXPECT_EQ(error_of(with_probe("type = \"height\"\nat = [0.1, 0.05, -0.5]\n")), "");
  EXPECT_EQ(refused(with_probe("type = \"box\"\nmin = [0.3, 0, 0]\nmax = [0.4, 0.1, 0.1]\n")),
            "probe.min = [0.3, 0, 0] must have a part of the domain in its box");
  EXPECT_EQ(
      refused(patch("[0.25, 0.05, 0]", "size = [0.01, 0.01]\n", "floor") +
              "[[wall.body]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n"),
      "probe.at = [0.25, 0.05, 0] must lie in " + domain);
  EXPECT_EQ(refused(with_probe("type = \"point\"\nat = [0.1, 0.05, 0]\nbody = \"gate\"\n")),
            "probe.body = \"gate\" must name a wall.body; this case has tank");
  EXPECT_EQ(refused(with_probe("type = \"height\"\nat = [0.1, 0.05, 0]\nbody = \"tank\"\n")),
            "probe.body = \"tank\" is not used by the chosen options; remove it");
}

TEST(ProbeCase, OfForcesTellsMeansOrInstants) {
  const std::string force = "type = \"force\"\nbody = \"tank\"\n";
  const auto sample = [](const std::string& text) { return read(text).out.probes.at(0).sample; };
  EXPECT_EQ(sample(with_probe(force)), "mean");
  EXPECT_EQ(sample(with_probe(force + "sample = \"instant\"\n")), "instant");
  EXPECT_EQ(refused(with_probe(force + "sample = \"average\"\n")),
            "probe.sample = \"average\" must be one of mean, instant");
  EXPECT_EQ(refused(with_probe("type = \"point\"\nat = [0.1, 0.05, 0.1]\nsample = \"mean\"\n")),
            "probe.sample = \"mean\" is not used by the chosen options; remove it");
}

TEST(ProbeCase, FollowsTheColumnAlongGravity) {
  const std::string sideways = with_probe("type = \"height\"\nat = [0.3, 0.05, 0.1]\n");
  EXPECT_NE(error_of(sideways), "");
  EXPECT_EQ(error_of(sideways, {"gravity=[9.81, 0, 0]"}), "");
  EXPECT_EQ(error_of(sideways, {"gravity=[5, 0, -4]"}), "");
  EXPECT_NE(error_of(sideways, {"gravity=[5, 0, -6]"}), "");  // passes 0.02 m above the corner
}

TEST(ProbeCase, MayHaveSeveralPoints) {
  const std::string line = "type = \"point\"\nat = [0.1, 0.05, 0.01]\nspan = [[0.05, 0, 0], [0, 0, 0.05]]\n";
  const ProbeConfig grid = read(with_probe(line + "count = [6, 2]\n")).out.probes.at(0);
  EXPECT_EQ(grid.span.size(), 2u);
  EXPECT_EQ(grid.count, (std::vector<double>{6, 2}));
  EXPECT_EQ(refused(with_probe(line + "count = [6]\n")),
            "probe.count = [6] must have a number for each span; there are 2");
  EXPECT_EQ(refused(with_probe(line + "count = [6, 1.5]\n")),
            "probe.count = [6, 1.5] must hold numbers within 2..1000");
  EXPECT_EQ(refused(with_probe(line + "count = [6, 2.5]\n")),
            "probe.count = [6, 2.5] must hold whole numbers");
  EXPECT_EQ(refused(with_probe(line + "count = [101, 100]\n")),
            "probe.count = [101, 100] must make at most 10000 points");
  EXPECT_NE(error_of(with_probe("type = \"point\"\nat = [0.1, 0.05, 0.01]\ncount = [6]\n")), "");
  EXPECT_NE(refused(with_probe("type = \"point\"\nat = [0.1, 0.05, 0.01]\nspan = [[5, 0, 0]]\ncount = [2]\n"))
                .find("must lie in the domain"),
            std::string::npos);
}

TEST(ProbeCase, MeasuresUpASlopeAndThroughASection) {
  const Vec3d along =
      read(with_probe("type = \"height\"\nat = [0.1, 0.05, 0]\nalong = [3, 0, 4]\n")).out.probes.at(0).along;
  expect_near(along, {0.6, 0, 0.8});
  const std::string flux = "type = \"flux\"\nmin = [0.1, 0, 0]\nmax = [0.12, 0.1, 0.1]\n";
  const ProbeConfig p = read(with_probe(flux + "direction = \"z-\"\n")).out.probes.at(0);
  EXPECT_EQ(p.axis, 2);
  EXPECT_EQ(p.sign, -1);
  EXPECT_NE(refused(with_probe("type = \"flux\"\nmin = [0.1, 0, 0]\nmax = [9, 0.1, 0.1]\n"))
                .find("must lie in the domain"),
            std::string::npos);
}

TEST(ProbeCase, OfFieldsTakesAKernelAndPointsThatSpanSomething) {
  const std::string field = "type = \"field\"\nat = [0.1, 0.05, 0.1]\n", two = "radius = 0.004\n";
  EXPECT_EQ(error_of(with_probe(field + two)), "");
  EXPECT_EQ(refused(with_probe(field + "radius = 0.0035\n")),
            "probe.radius = 0.0035 m must be >= 0.004 m, two diameters of the largest grain");
  EXPECT_EQ(refused(with_probe(field + two + "span = [[0.01, 0, 0], [0.02, 0, 0]]\ncount = [2, 2]\n")),
            "probe.span = 2 vectors must not be 0, nor lie along one another or in one plane");
  EXPECT_EQ(read(with_probe(field + two + "sample_every = 0.001\n")).out.probes[0].sample_every, 0.001);
  EXPECT_EQ(refused(with_probe(field + two + "sample_every = 0.02\n")),
            "probe.sample_every = 0.02 s must be <= 0.01 s, the interval of its rows");
}

}  // namespace
}  // namespace bedload::test
