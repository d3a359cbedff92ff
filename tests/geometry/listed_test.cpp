// Fluid and grains from files.

#include <fstream>

#include "bedload/geometry/shape.hpp"
#include "support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace bedload::test {
namespace {

class Listed : public testing::Test {
 protected:
  void SetUp() override { config_ = empty_case({0.1, 0.1, 0.1}); }

  void fluid(const std::string& table) {
    std::ofstream(file_) << table;
    config_.fluid.present = true;
    config_.fluid.vmax = 10;
    FluidFill fill;
    fill.file = file_.string();
    config_.fluid.fills.push_back(fill);
  }
  void grains(const std::string& table) {
    std::ofstream(file_) << table;
    config_.grain.present = true;
    config_.grain.fills.resize(1);
    config_.grain.fills[0].file = file_.string();
  }
  std::string error() const { return folder_.left_out_of(error_of(config_)); }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "p.csv";
  Config config_;
};

TEST_F(Listed, FluidWeighsADensityTimesACubicSpacing) {
  fluid("x,y,z\n0.01,0.02,0.03\n0.04,0.02,0.03\n");
  config_.fluid.fills[0].velocity = {"100*x", "0", "1"};
  const auto setup = setup_of(config_);
  ASSERT_EQ(setup.fluid.x.size(), 2u);
  EXPECT_EQ(setup.fluid.x[1], (Vec3d{0.04, 0.02, 0.03}));
  EXPECT_EQ(setup.fluid.v[1], (Vec3d{4, 0, 1}));
  EXPECT_DOUBLE_EQ(setup.fluid.mass[0], 1e-3);
}

TEST_F(Listed, FluidBringsItsVolumes) {
  fluid("x,y,z,volume [m3]\n0.01,0.02,0.03,2e-6\n0.04,0.02,0.03,5e-7\n");
  EXPECT_EQ(setup_of(config_).fluid.mass, (std::vector<double>{2e-3, 5e-4}));
}

TEST_F(Listed, FluidBringsItsVelocities) {
  fluid("x,y,z,vx,vy,vz\n0.01,0.02,0.03,1,2,3\n");
  EXPECT_EQ(setup_of(config_).fluid.v[0], (Vec3d{1, 2, 3}));
  config_.fluid.vmax = 3;
  std::vector<std::string> warnings;
  build_setup(config_, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(
      warnings[0],
      "fluid.fill 1: its particles move at up to 3.74 m/s, above fluid.vmax = 3, from which the sound speed "
      "follows");
}

TEST_F(Listed, FluidMustLieInTheOpenAndNotTwice) {
  fluid("x,y,z\n0.05,0.05,0.05\n0.01,0.02,0.2\n");
  EXPECT_EQ(error(), "p.csv:3: fluid particle 2 at (0.01, 0.02, 0.2) m lies outside the domain");
  fluid("x,y,z\n0.05,0.05,0.05\n\n0.0505,0.05,0.05\n");
  config_.fluid.fills.resize(1);
  EXPECT_EQ(error(), "p.csv:4: fluid particle 2 at (0.0505, 0.05, 0.05) m lies on another fluid particle");
  add_fill(config_, {0.04, 0.04, 0.04}, {0.07, 0.07, 0.07});
  EXPECT_EQ(error(), "p.csv:2: fluid particle 1 at (0.05, 0.05, 0.05) m lies inside fluid.fill 2");
  config_.fluid.fills.resize(1);
  config_.wall.bodies = {body("box", {0.04, 0.04, 0.04}, {0.07, 0.07, 0.07})};
  EXPECT_EQ(error(), "p.csv:2: fluid particle 1 at (0.05, 0.05, 0.05) m lies inside wall.body \"box\"");
}

TEST_F(Listed, FluidMayLieBesideACurvedShape) {
  fluid("x,y,z\n0.07,0.07,0.07\n0.05,0.05,0.07\n");
  const ShapePtr ball = make_sphere({0.05, 0.05, 0.05}, 0.03);
  add_fill(config_, ball->bounds().min, ball->bounds().max);
  config_.fluid.fills[1].solid.shape = ball;
  EXPECT_EQ(error(), "p.csv:3: fluid particle 2 at (0.05, 0.05, 0.07) m lies inside fluid.fill 2");
  config_.fluid.fills[1].level = 0.06;
  EXPECT_EQ(error(), "");
}

TEST_F(Listed, GrainsKeepTheirSizesAndVelocities) {
  grains("x,y,z,radius,vx,vy,vz\n0.01,0.02,0.03,0.001,0,0,-1\n0.04,0.02,0.03,0.002,1,0,0\n");
  config_.grain.d_max = 0.004;
  const auto g = setup_of(config_).grains;
  EXPECT_EQ(g.radius, (std::vector<double>{0.001, 0.002}));
  EXPECT_EQ(g.v[0], (Vec3d{0, 0, -1}));
  EXPECT_EQ(g.x[1], (Vec3d{0.04, 0.02, 0.03}));
}

TEST_F(Listed, RoundingPutsNothingOutsideTheDomain) {
  fluid("x,y,z\n0.1000000015,-1e-7,0.03\n");  // 0.1 in single precision
  config_.domain.min.y = 0;
  EXPECT_EQ(error(), "p.csv:2: fluid particle 1 at (0.1, -1e-07, 0.03) m lies outside the domain");
  fluid("x,y,z\n0.1000000015,0,0.03\n");
  config_.fluid.fills.resize(1);
  EXPECT_EQ(setup_of(config_).fluid.x[0], (Vec3d{0.1, 0, 0.03}));
}

TEST_F(Listed, GrainsMustLieInTheOpen) {
  grains("x,y,z\n0.05,0.05,0.05\n0.05,0.05,0.058\n");
  EXPECT_EQ(error(), "p.csv:3: grain 2 at (0.05, 0.05, 0.058) m lies inside another grain");
  grains("x,y,z\n0.05,0.05,0.05\n0.05,0.05,0.2\n");
  EXPECT_EQ(error(), "p.csv:3: grain 2 at (0.05, 0.05, 0.2) m lies outside the domain");
  config_.wall.bodies = {body("tank", {0, 0, 0}, {0.1, 0.1, 0.1})};
  grains("x,y,z\n0.05,0.05,0.004\n");
  EXPECT_EQ(error(), "p.csv:2: grain 1 at (0.05, 0.05, 0.004) m lies inside a wall");
}

}  // namespace
}  // namespace bedload::test
