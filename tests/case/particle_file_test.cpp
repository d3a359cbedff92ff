#include "bedload/case/particle_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "../output/fake_simulation.hpp"
#include "bedload/output/output.hpp"
#include "bedload/output/vtkhdf.hpp"
#include "support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace bedload::test {
namespace {

class ParticleFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    const auto path = folder_ / "grains.csv";
    std::ofstream(path) << text;
    return path;
  }
  /// What is wrong with a table, less its folder.
  std::string error(const std::string& text) const {
    try {
      read_particles(write(text), -1);
    } catch (const CaseError& error) {
      return folder_.left_out_of(error.what());
    }
    return "";
  }
  /// kCase in this folder, its grains from `file`.
  std::string case_with(const std::string& file, const std::string& more = "") const {
    return changed("min = [0, 0, 0]\nmax = [0.05, 0.1, 0.1]\ncount = 500", "file = \"" + file + "\"" + more);
  }
  Config read_here(const std::string& text, const std::filesystem::path& checkpoint = {}) const {
    std::vector<std::string> warnings;
    return read_case_text(text, (folder_ / "dam.toml").string(), {}, warnings, checkpoint);
  }

  const TemporaryFolder folder_;
};

TEST_F(ParticleFile, FindsColumnsByName) {
  const auto list = read_particles(write("# made by hand\n\nid, z [m],y,x [m], d,vx [m/s],vy,vz\r\n"
                                         "7, 0.3,0.2,1e-1, 2e-3,1,+2,-3\r\n\n8,0.6,0.5,0.4,0.003,0,0,0\n"),
                                   -1);
  EXPECT_EQ(list.x, (std::vector<Vec3d>{{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}}));
  EXPECT_EQ(list.v, (std::vector<Vec3d>{{1, 2, -3}, {0, 0, 0}}));
  EXPECT_EQ(list.d, (std::vector<double>{0.002, 0.003}));
  EXPECT_TRUE(list.place(1).ends_with("grains.csv:6"));
}

/// As spreadsheets save them.
TEST_F(ParticleFile, ReadsAByteOrderMarkAndRefusesOtherSeparators) {
  for (const char* text : {"\xef\xbb\xbfx,y,z\n1,2,3\n", "\xef\xbb\xbfx [m],y [m],z [m]\r\n1,2,3\r\n"}) {
    const ParticleList list = read_particles(write(text), -1);
    ASSERT_EQ(list.x.size(), 1u);
    EXPECT_EQ(list.x[0], (Vec3d{1, 2, 3}));
  }
  EXPECT_EQ(error("x;y;z\n1;2;3\n"),
            "grains.csv:1: has semicolons between its columns; they must be separated by commas");
  EXPECT_EQ(error("x\ty\tz\n1\t2\t3\n"),
            "grains.csv:1: has tabs between its columns; they must be separated by commas");
}

TEST_F(ParticleFile, TellsFluidFromGrainsAndHasSpins) {
  const auto file =
      write("type,x,y,z,wx [rad/s],wy,wz\nfluid,1,2,3,0,0,0\ngrain,4,5,6,7,8,9\nfluid,2,2,2,0,0,0\n");
  EXPECT_EQ(read_particles(file, -1, "fluid").x, (std::vector<Vec3d>{{1, 2, 3}, {2, 2, 2}}));
  const auto grains = read_particles(file, -1, "grain");
  EXPECT_EQ(grains.x, (std::vector<Vec3d>{{4, 5, 6}}));
  EXPECT_EQ(grains.omega, (std::vector<Vec3d>{{7, 8, 9}}));
  EXPECT_TRUE(grains.place(0).ends_with("grains.csv:3"));
  EXPECT_EQ(error("type,x,y,z\nfluid,1,2,3\n"), "grains.csv:2: holds no particles of type grain");
  EXPECT_EQ(error("type,x,y,z\nwall,1,2,3\n"), "grains.csv:2: type = \"wall\" must be fluid or grain");
}

TEST_F(ParticleFile, NeedsNoMoreThanPlaces) {
  const auto list = read_particles(write("\"x\",\"y\",\"z\"\n1,2,3"), -1);
  EXPECT_EQ(list.x, (std::vector<Vec3d>{{1, 2, 3}}));
  EXPECT_TRUE(list.v.empty());
  EXPECT_TRUE(list.d.empty());
  EXPECT_EQ(read_particles(write("x,y,z,radius\n1,2,3,0.5\n"), -1).d, (std::vector<double>{1}));
}

TEST_F(ParticleFile, ErrorsNameFileLineColumnAndValue) {
  EXPECT_EQ(error(""), "grains.csv:1: holds no line of column names");
  EXPECT_EQ(error("x,y,z\n"), "grains.csv:1: holds no particles");
  EXPECT_EQ(error("x,y,d\n"), "grains.csv:1: has no column z; it names x, y, d");
  EXPECT_EQ(error("x,y,z,vx\n"),
            "grains.csv:1: has no column vy next to the other velocities; it names x, y, z, vx");
  EXPECT_EQ(error("x,y,z,d,radius\n"), "grains.csv:1: has both columns d and radius; one of them is enough");
  EXPECT_EQ(error("x,y,z,diameter\n1,2,3,4\n"),
            "grains.csv:1: has a column diameter, which means nothing here; known are x, y, z, d, radius, "
            "volume, vx, vy, vz, wx, wy, wz, type");
  EXPECT_EQ(error("x,x,y,z\n"), "grains.csv:1: has two columns x");
  EXPECT_EQ(error("x [mm],y,z\n"), "grains.csv:1: column x [mm] must be in [m]");
  EXPECT_EQ(error("x,y,z\n1,2,3\n4,5\n"), "grains.csv:3: has 2 values where the first line names 3 columns");
  EXPECT_EQ(error("x,y,z\n1,2,3e\n"), "grains.csv:2: z = \"3e\" must be a number");
  EXPECT_EQ(error("x,y,z\n1,,3\n"), "grains.csv:2: y = \"\" must be a number");
  EXPECT_EQ(error("x,y,z\n1,nan,3\n"), "grains.csv:2: y = nan must be finite");
  EXPECT_EQ(error("x,y,z,volume [m]\n"), "grains.csv:1: column volume [m] must be in [m3]");
  EXPECT_EQ(error("x,y,z,volume\n1,2,3,0\n"), "grains.csv:2: volume = 0 must be > 0");
  EXPECT_EQ(error("x,y,z,d\n1,2,3,0\n"), "grains.csv:2: d = 0 must be > 0");
  EXPECT_EQ(error("x,y,z,radius\n1,2,3,-1\n"), "grains.csv:2: radius = -1 must be > 0");
}

TEST_F(ParticleFile, TakesAFrameOfAFormerRun) {
  const FrameFile frames(folder_ / "grains.vtkhdf", true);
  bedload::testing::FakeSimulation s;
  for (int k = 0; k < 3; ++k, s.step()) {
    HostStore store = s.snapshot("grains");
    store.arrays[1].name = "radius";
    store.arrays[2].name = "velocity";
    frames.append(store, s.time());
  }
  const double t = bedload::testing::FakeSimulation::kDt;
  const auto last = read_particles(frames.path(), -1), second = read_particles(frames.path(), 1);
  EXPECT_EQ(last.x[2], (Vec3d{2 + 2 * t, 4, 0.125 - 2 * t * 2}));
  EXPECT_EQ(second.x[2], (Vec3d{2 + t, 4, 0.125 - t * 2}));
  EXPECT_EQ(second.v[1], (Vec3d{t, 1e-3, -t}));
  EXPECT_FLOAT_EQ(float(second.d[1]), 2 * float(10 + t));
  try {
    read_particles(frames.path(), 3);
    FAIL();
  } catch (const CaseError& error) {
    EXPECT_TRUE(
        std::string(error.what()).ends_with("grains.vtkhdf: has no frame 3; they are numbered 0 to 2"))
        << error.what();
  }
}

TEST_F(ParticleFile, IsFoundBesideTheCaseAndResolvesIt) {
  write("x,y,z,d\n0.01,0.02,0.03,0.001\n0.04,0.01,0.02,0.004\n");
  const Config c = read_here(case_with("grains.csv"));
  const GrainFill& fill = c.grain.fills[0];
  EXPECT_EQ(fill.file, (folder_ / "grains.csv").string());
  EXPECT_EQ(fill.min, (Vec3d{0.01, 0.01, 0.02}));
  EXPECT_EQ(fill.max, (Vec3d{0.04, 0.02, 0.03}));
  EXPECT_EQ(fill.count, 2);
  EXPECT_EQ(c.grain.d_min, 0.001);
  EXPECT_EQ(c.grain.d_max, 0.004);
  Config again = read_here(resolved_toml(c));
  EXPECT_TRUE(again == c) << resolved_toml(c);
}

TEST_F(ParticleFile, VolumesAreForFluid) {
  write("x,y,z,volume\n0.01,0.02,0.03,1e-9\n");
  try {
    read_here(case_with("grains.csv"));
    FAIL();
  } catch (const CaseError& error) {
    EXPECT_EQ(folder_.left_out_of(error.what()),
              "grains.csv: has a column volume, which is for fluid; grains take d or radius");
  }
}

TEST_F(ParticleFile, WithoutDiametersTakesThoseOfTheCase) {
  write("x,y,z\n0.01,0.02,0.03\n");
  EXPECT_EQ(read_here(case_with("grains.csv")).grain.d_max, 0.002);
  EXPECT_EQ(read_here(case_with("grains.csv", "\nsizes = [{d = 0.003}]")).grain.d_max, 0.003);
}

TEST_F(ParticleFile, FluidSetsTheDepth) {
  write("x,y,z\n0.002,0.002,0.002\n0.002,0.002,0.038\n");
  const Config c =
      read_here(changed("min = [0, 0, 0]\nmax = [0.05, 0.1, 0.1]\n[[wall", "file = \"grains.csv\"\n[[wall"));
  EXPECT_NEAR(c.fluid.depth, 0.04, 1e-15);
}

TEST_F(ParticleFile, IsNotNeededBesideACheckpoint) {
  const auto path = write("x,y,z,d\n0.01,0.02,0.03,0.001\n0.04,0.01,0.02,0.004\n");
  const Config c = read_here(case_with("grains.csv"));
  const auto checkpoint = folder_ / "state.h5";
  write_state(checkpoint, {}, c);
  std::filesystem::remove(path);
  const Config again = read_here(case_with("grains.csv"), checkpoint);
  EXPECT_TRUE(again == c);
  EXPECT_NO_THROW(read_checkpoint(checkpoint, again));
}

TEST_F(ParticleFile, WrongFillsNameTheCase) {
  write("x,y,z,d,vx,vy,vz\n0.01,0.02,0.03,0.001,0,0,0\n");
  const auto error = [&](const std::string& text) {
    try {
      read_here(text);
    } catch (const CaseError& error) {
      return folder_.left_out_of(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(error(case_with("none.csv")),
            "dam.toml:18: grain.fill.file = \"none.csv\" must be a file; there is no none.csv");
  EXPECT_EQ(error(case_with("grains.txt")),
            "dam.toml:18: grain.fill.file = \"grains.txt\" must end in .csv or .vtkhdf");
  EXPECT_EQ(error(case_with("grains.csv", "\nvelocity = [1, 0, 0]")),
            "dam.toml:19: grain.fill.velocity = [1, 0, 0] must be left out; grains.csv holds its own");
  EXPECT_EQ(error(case_with("grains.csv", "\nsizes = [{d = 0.001}]")),
            "dam.toml:19: grain.fill.sizes = [{...}] must be left out; grains.csv holds its own");
  EXPECT_EQ(error(case_with("grains.csv", "\ncount = 5")),
            "dam.toml:19: grain.fill.count = 5 is not used by the chosen options; remove it");
  EXPECT_EQ(error(case_with("grains.csv", "\nstep = 5")),
            "dam.toml:19: grain.fill.step = 5 is not used by the chosen options; remove it");
}

}  // namespace
}  // namespace bedload::test
