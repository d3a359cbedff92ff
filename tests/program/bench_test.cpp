// `bedload bench` from outside. What it measures is not judged here.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "bedload/case/read.hpp"
#include "cli/benchmarks.hpp"
#include "cli/tiled_bed.hpp"
#include "run_program.hpp"
#include "tests/support/cases.hpp"

namespace bedload::test {
namespace {

const std::string kSmall = small_dam() + "[time]\nend = 1\n[out]\nevery = 1\n";

using Bench = ProgramTest;

TEST_F(Bench, TimesTheStepsOfACaseByStage) {
  write("dam.toml", kSmall);
  const Outcome o = bedload(
      "bench dam.toml --backend cpu --precision mixed --at 1e-4 --warm 1 --steps 3 --spans 2 --json "
      "speed.json");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("fluid particle-steps/s"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find(" dam |"), std::string::npos) << o.out;

  const auto json = nlohmann::json::parse(content_of(dir_ / "speed.json"));
  EXPECT_EQ(json.at("version"), BL_VERSION);
  EXPECT_FALSE(json.at("commit").get<std::string>().empty());
  EXPECT_EQ(json.at("backend"), "cpu");
  EXPECT_EQ(json.at("span_steps"), 3);
  ASSERT_EQ(json.at("rows").size(), 1u);
  const auto& row = json["rows"][0];
  EXPECT_EQ(row.at("row"), "dam");
  EXPECT_EQ(row.at("precision"), "mixed");
  EXPECT_EQ(row.at("fluid_particles"), 150);
  EXPECT_EQ(row.at("grains"), 40);
  EXPECT_EQ(row.at("h_over_dx"), 1.5);
  EXPECT_GT(row.at("wall_particles"), 0);
  const double ms = row.at("step_ms");
  EXPECT_GT(ms, 0);
  EXPECT_NEAR(row.at("fluid_particle_steps_per_s"), 150e3 / ms, 1e-6 * 150e3 / ms);
  EXPECT_LE(row.at("substep_us"), 1e3 * ms);
  EXPECT_GT(row.at("sphere_substeps_per_s"), 0);
  EXPECT_GT(row.at("bytes_per_particle"), 100);
  double stages = 0;
  for (const char* name : {"lists", "fluid", "grains", "coupling", "checks"}) {
    const double stage = row.at("stages_ms").at(name);
    EXPECT_GE(stage, 0) << name;
    stages += stage;
  }
  EXPECT_GT(stages, 0);
  EXPECT_LE(stages, ms);
}

TEST_F(Bench, TimesRowsWithSeveralNumbersOfThreads) {
  write("dam.toml", kSmall);
  const Outcome o = bedload(
      "bench dam.toml --backend cpu --precision mixed --warm 1 --steps 2 --spans 1 --thread-counts 1,2 "
      "--json "
      "speed.json");
  ASSERT_EQ(o.code, 0) << o.err;
  const auto rows = nlohmann::json::parse(content_of(dir_ / "speed.json")).at("rows");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("threads"), 1);
  EXPECT_EQ(rows[1].at("threads"), 2);
  EXPECT_NE(o.out.find("threads |"), std::string::npos) << o.out;
}

TEST_F(Bench, TimesFramesAndRemovesThem) {
  write("dam.toml", kSmall);
  const auto folders = [] {
    std::ptrdiff_t n = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::temp_directory_path()))
      n += entry.path().filename().string().starts_with("bedload_bench_");
    return n;
  };
  const std::ptrdiff_t before = folders();
  const Outcome o = bedload(
      "bench dam.toml --backend cpu --precision mixed --warm 1 --steps 4 --spans 1 --frames 2 --json "
      "speed.json");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(folders(), before);
  const auto json = nlohmann::json::parse(content_of(dir_ / "speed.json"));
  EXPECT_EQ(json.at("frame_every"), 2);
  const auto& row = json.at("rows").at(0);
  const double ms = row.at("step_beside_frames_ms"), with = row.at("step_with_frames_ms");
  EXPECT_GT(std::min(ms, with), 0);
  EXPECT_NEAR(row.at("frames_percent"), 100 * (1 - ms / with), 1e-9 * (100 + 100 * ms / with));
  EXPECT_GE(row.at("frame_wait_ms"), 0);
  EXPECT_GE(row.at("frame_writing_ms"), 0);
}

TEST_F(Bench, RefusesWhatItDoesNotKnowWithOneSentence) {
  write("dam.toml", kSmall);
  const auto refused = [&](const std::string& arguments, const std::string& place, const std::string& why) {
    const Outcome o = bedload("bench " + arguments + " --backend cpu");
    EXPECT_EQ(o.code, 2) << arguments;
    EXPECT_TRUE(o.err.starts_with(place + ": ")) << o.err;
    EXPECT_NE(o.err.find(why), o.err.npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_EQ(o.out, "") << arguments;
  };
  refused("dam.toml 2M", "command line", "unknown benchmark 2M");
  refused("dam.toml 2M", "command line",
          "bi100-coated, clumps-1M, coupled, coupled-10M, coupled-fine, coupled-bi20, coupled-fine-20k, "
          "coupled-bi20-20k, lattice-0.9M, lattice-57M, "
          "lattice-spheres-0.9M, lattice-spheres-17M, lattice-spheres-57M, lattice-dense-17M, "
          "lattice-dense-57M, or a case file");
  refused("no.toml", "no.toml", "no such file");
  refused("dam.toml --set grain.e=1.4", "--set grain.e=1.4", "must be within 0.05..1");
  refused("0.1M --set fluid.d=1", "--set fluid.d=1", "did you mean grain.d?");
}

TEST_F(Bench, ReadsEveryBuiltInCase) {
  std::vector<Benchmark> rows = benchmarks();
  rows.push_back(widened_dam_break("0.2 m wide", 0.2));
  for (const Benchmark& row : rows) {
    std::vector<std::string> warnings;
    EXPECT_NO_THROW(read_case_text(row.text, row.name, {}, warnings)) << row.name;
    const Config config = read_case_text(row.text, row.name, row.settings, warnings);
    EXPECT_EQ(config.fluid.present && !config.fluid.lattice(), !row.settings.empty()) << row.name;
    std::erase_if(warnings, [&](const std::string& w) {  // which is what the row is about
      return row.name.starts_with("coupled-bi20") && w.find("too large for drag laws") != w.npos;
    });
    if (row.tiles > 0) EXPECT_NO_THROW(read_case_text(row.tile, row.name, {}, warnings)) << row.name;
    EXPECT_EQ(warnings, std::vector<std::string>{}) << row.name;
  }
}

template <class T>
HostArray array_of(const char* name, Scalar type, int components, const std::vector<T>& values) {
  HostArray a{name, "-", type, components, {}};
  a.bytes.resize(values.size() * sizeof(T));
  std::memcpy(a.bytes.data(), values.data(), a.bytes.size());
  return a;
}

TEST(TiledBed, IsCopiesOfWhatHasSettledWhereThereIsRoom) {
  const auto config = [](const std::string& name, double side, const std::string& periodic,
                         const std::string& faces, const std::string& large) {
    std::vector<std::string> warnings;
    return read_case_text(
        fmt::format("[domain]\nmin = [0, 0, -0.01]\nmax = [{0}, {0}, 0.1]\n{1}[grain]\nd = 0.005\n{2}"
                    "[[grain.fill]]\nmin = [0, 0, 0]\nmax = [{0}, {0}, 0.05]\ncount = 2\n"
                    "[[wall.body]]\nname = \"box\"\nshape = \"tank\"\nmin = [0, 0, 0]\nmax = [{0}, {0}, "
                    "0.05]\nfaces = [{3}]\n[time]\nend = 1\n[out]\nevery = 1\n",
                    side, periodic, large, faces),
        name, {}, warnings);
  };
  const Config tile = config("tile", 0.02, "periodic = [true, true, false]\n", "\"z-\"", "");
  const Config whole = config("whole", 0.06, "", R"("x-", "x+", "y-", "y+", "z-")",
                              "[[grain.fill]]\npositions = [[0.03, 0.03, 0.005]]\nsizes = [{ d = 0.01 }]\n");
  Setup::Grains placed, others;
  placed.x = placed.v = {{}, {}}, placed.radius = {0.0025, 0.0025}, placed.fill = placed.clump = {0, 0};
  others.x = others.v = {{0.03, 0.03, 0.005}, {0.05, 0.05, 0.04}}, others.radius = {0.005, 0.0025};
  others.fill = {0, 1}, others.clump = {0, 0};
  SavedState settled;
  settled.stores.push_back(
      {"grains",
       2,
       {array_of<std::uint32_t>("id", Scalar::u32, 1, {2, 1}),
        array_of<Vec3d>("x", Scalar::f64, 3, {{0.001, 0.01, 0.0075}, {0.01, 0.01, 0.0024}})}});
  const Setup::Grains bed = tiled_bed(tile, placed, settled, whole, others, 3);
  // nine of the first, one of them in the large one; nine of the second, three of them in a wall
  ASSERT_EQ(bed.x.size(), 1 + 8 + 6u);
  EXPECT_EQ(bed.fill[0], 0u);
  EXPECT_EQ(std::count(bed.fill.begin(), bed.fill.end(), 1u), 14);
  for (std::size_t n = 1; n < bed.x.size(); ++n)
    EXPECT_NEAR(bed.x[n].z, bed.x[n].x > 0.0205 && std::fmod(bed.x[n].x, 0.02) < 0.002 ? 0.0075 : 0.0024,
                1e-12);
}

}  // namespace
}  // namespace bedload::test
