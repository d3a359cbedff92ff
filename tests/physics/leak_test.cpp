// Nothing gets out of a vessel made of triangles, however it is shaken.

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "bedload/motion/law.hpp"
#include "tests/boundaries/support.hpp"
#include "tests/geometry/mesh_support.hpp"

namespace BL_SOLVER {
namespace {

/// How much is shaken and how long: BEDLOAD_LEAK="fluid grains seconds" if that is set.
struct Load {
  double fluid = BL_CUDA ? 1e6 : 4e3, grains = BL_CUDA ? 1e5 : 400;  ///< particles, about
  double end = 0.5;                                                  ///< s

  Load() {
    if (const char* given = std::getenv("BEDLOAD_LEAK")) {
      std::istringstream text(given);
      if (!(text >> fluid >> grains >> end)) throw std::runtime_error("BEDLOAD_LEAK: fluid, grains, seconds");
    }
  }
};

constexpr double kSide = 0.5, kWall = 0.2;  // m
constexpr int kLooks = 20;
constexpr double kVolume = 3 * kSide * kSide * kSide;

TriangleSoup scaled(TriangleSoup soup, const Vec3d& by) {
  for (Vec3d& x : soup.vertices) x = {x.x * by.x, x.y * by.y, x.z * by.z};
  return soup;
}

/// An angular room with an edge that juts into it, in a block; accelerations of tens of m/s2 in all
/// directions.
std::string shaken(const Load& load) {
  const double dx = std::cbrt(0.5 * kVolume / load.fluid);
  const double d = std::cbrt(0.12 * kVolume / (M_PI / 6 * load.grains));
  std::ostringstream text;
  text << "[fluid]\nvmax = 2.5\ndx = " << dx << "\n[grain]\nE = 1e7\nd = " << d << "\n[couple]\nhc = " << d
       << "\n[[grain.fill]]\nshape = \"inside\"\ncount = " << std::int64_t(load.grains)
       << "\n[time]\nend = " << load.end << "\n[out]\nevery = 1\n"
       << R"case([domain]
min = [-0.8, -0.8, -0.9]
max = [1.8, 1.8, 1.4]
[[shape]]
name = "inside"
kind = "mesh"
file = "inside.stl"
[[shape]]
name = "vessel"
kind = "mesh"
file = "vessel.stl"
[[fluid.fill]]
shape = "inside"
level = 0.28
[[wall.body]]
name = "vessel"
shape = "vessel"
[wall.body.motion]
kind = "formula"
displacement = ["0.02*(1-cos(30*t))", "0.016*(1-cos(40*t))", "0.012*(1-cos(45*t))"]
rotation = ["15*(1-cos(8*t))", "10*(1-cos(10*t))", 0]
centre = [0.5, 0.5, 0.25]
)case";
  return text.str();
}

TEST(SlowLeak, NothingLeavesAShakenVesselOfTriangles) {
  const Load load;
  const test::TemporaryFolder folder;
  const TriangleSoup inside = scaled(test::l_prism(), {kSide, kSide, kSide});
  const Vec3d outer{2 * kSide + 2 * kWall, 2 * kSide + 2 * kWall, kSide + 2 * kWall};
  test::write_ascii_stl(folder / "inside.stl", inside);
  test::write_ascii_stl(folder / "vessel.stl",
                        test::together(test::moved(scaled(test::cube(), outer), {-kWall, -kWall, -kWall}),
                                       test::inside_out(inside)));
  std::ofstream(folder / "case.toml") << shaken(load);
  std::vector<std::string> warnings;
  const Config config = read_case(folder / "case.toml", {}, warnings);
  auto s = started(config);
  const double initial = reading(*s, "fluid_count");
  ASSERT_GT(initial, 0.8 * load.fluid);
  ASSERT_EQ(reading(*s, "grain_count"), std::int64_t(load.grains));
  std::cout << initial << " fluid particles, dx " << config.fluid.dx << " m, " << load.grains << " grains, d "
            << config.grain.d << " m" << std::endl;

  const TriangleMesh room(inside, "inside");
  const MotionLaw law(config.wall.bodies[0].motion, load.end);
  double fluid_out = -1, grains_out = -1, fastest = 0;  // of centres beyond the inner surface, m; m/s
  for (int look = 1; look <= kLooks; ++look) {
    run_until(*s, load.end * look / kLooks);
    const RigidMotion pose = law.at(s->time());
    const auto farthest = [&](const char* store) {
      double out = -1;
      for (const Vec3d& x : vectors(s->snapshot(store), "position")) {
        EXPECT_TRUE(std::isfinite(norm(x)));
        out = std::max(out, room.distance(pose.undo(x)));
      }
      return out;
    };
    fluid_out = std::max(fluid_out, farthest("fluid"));
    grains_out = std::max(grains_out, farthest("grains"));
    fastest = std::max(fastest, reading(*s, "fluid_speed_max"));
    std::cout << s->time() << " s, " << s->steps() << " steps: farthest centres " << fluid_out
              << " m (fluid) and " << grains_out << " m (grains) beyond the room's surface, fastest fluid "
              << fastest << " m/s; lost " << reading(*s, "lost_fluid_count") << " and "
              << reading(*s, "grains_outside") << std::endl;
  }
  EXPECT_EQ(reading(*s, "fluid_count"), initial);
  EXPECT_EQ(reading(*s, "lost_fluid_count"), 0);
  EXPECT_EQ(reading(*s, "grains_outside"), 0);
  EXPECT_LT(grains_out, 0) << "no centre of a grain";
  EXPECT_LT(fluid_out, 0.5 * config.fluid.dx) << "no fluid beyond the wall's first layer of particles";
  EXPECT_GT(fastest, 1) << "the test means the fluid to slosh";
}

}  // namespace
}  // namespace BL_SOLVER
