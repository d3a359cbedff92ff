#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "bedload/core/error.hpp"
#include "bedload/output/csv.hpp"
#include "bedload/output/files.hpp"
#include "bedload/output/output.hpp"
#include "bedload/output/vtkhdf.hpp"
#include "fake_simulation.hpp"

namespace bedload::testing {
namespace {

namespace fs = std::filesystem;

const Device kDevice{"cpu", "two threads", 0};

/// Steps on and writes until `steps` are done.
void run_to(FakeSimulation& s, RunOutput& out, int steps) {
  if (s.steps() == 0) out.write(s, s.info());
  while (s.steps() < steps) out.write(s, s.step());
}

/// What the action's FileError says.
template <class Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const FileError& e) {
    return e.what();
  }
  return "no error";
}

class RunFolder : public ::testing::Test {
 protected:
  /// A run of 25 steps, never interrupted.
  void unbroken(const fs::path& dir) {
    FakeSimulation s;
    RunOutput out(dir, config, kDevice, "0.1.0");
    run_to(s, out, 25);
    out.finish(s, "completed", {2.0, 100});
  }
  void expect_same_results(const fs::path& a, const fs::path& b) {
    for (const char* name :
         {"diagnostics.csv", "probes/gauge.csv", "spectra.csv", "spectra_peaks.csv", "fluid.xdmf",
          "grains.xdmf", "walls.xdmf", "contacts.xdmf", "checkpoints/step_000000025.h5"})
      EXPECT_EQ(read_file(a / name), read_file(b / name)) << name;
    for (const char* name : {"fluid.vtkhdf", "grains.vtkhdf", "walls.vtkhdf", "contacts.vtkhdf"})
      EXPECT_EQ(FrameFile(a / name).times(), FrameFile(b / name).times()) << name;
  }
  test::TemporaryFolder folder;
  Config config = fake_config();
};

TEST_F(RunFolder, WritesAtTheFirstStepEndAtOrAfterItsTime) {
  const auto dir = folder / "new" / "run";
  unbroken(dir);
  // Steps of 0.03 s; frames every 0.1 s, diagnostics every 0.05 s, the gauge every 0.2 s; the end is 0.75 s.
  const std::vector<int> frames{0, 4, 7, 10, 14, 17, 20, 24, 25};
  const auto at = FrameFile(dir / "fluid.vtkhdf").times();
  ASSERT_EQ(at.size(), frames.size());
  for (std::size_t k = 0; k < at.size(); ++k) EXPECT_NEAR(at[k], 0.03 * frames[k], 1e-12);
  EXPECT_EQ(CsvTable(dir / "diagnostics.csv").times().size(), 16u);
  const std::string gauge = read_file(dir / "probes" / "gauge.csv");
  EXPECT_EQ(gauge.substr(0, gauge.find('\n')), "time [s],gauge [m]");
  EXPECT_EQ(std::count(gauge.begin(), gauge.end(), '\n'), 6);  // header; 0, 0.21, 0.42, 0.6, 0.75 s
  const auto readings = CsvTable(dir / "probes" / "gauge.csv").times();
  EXPECT_NE(gauge.find(fmt::format("\n{},{}\n", readings.at(1), readings.at(1) / 3)), std::string::npos)
      << gauge;
}

/// The row with which a run ends before its time is taken back by a restart: the mean goes on over it.
TEST_F(RunFolder, BeginsAnIntervalWithEachRowThatIsDue) {
  FakeSimulation s;
  RunOutput out(folder.path(), config, kDevice, "0.1.0");
  run_to(s, out, 25);
  out.finish(s, "completed", {2.0, 100});
  const auto rows = CsvTable(folder / "probes" / "gauge.csv").times();
  ASSERT_EQ(rows.size(), 5u);
  ASSERT_EQ(s.intervals.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(s.intervals[k].first, "gauge");
    EXPECT_DOUBLE_EQ(s.intervals[k].second, rows[k]);
  }
}

TEST_F(RunFolder, HasATableForEachBodyThatMoves) {
  config.wall.bodies.emplace_back().name = "raft";
  config.wall.bodies.back().free.present = true;
  config.wall.bodies.emplace_back().name = "gate";
  config.wall.bodies.back().motion.kind = "velocity";
  config.grain.fills.resize(2);
  config.grain.fills[1].rigid.present = true;
  unbroken(folder / "moving");
  EXPECT_TRUE(fs::exists(folder / "moving" / "bodies" / "grain_fill_2.csv"));
  EXPECT_FALSE(fs::exists(folder / "moving" / "bodies" / "grain_fill_1.csv"));
  EXPECT_EQ(CsvTable(folder / "moving" / "bodies" / "raft.csv").times().size(), 16u) << "as diagnostics";
  EXPECT_TRUE(fs::exists(folder / "moving" / "bodies" / "gate.csv"));
  EXPECT_FALSE(fs::exists(folder / "moving" / "bodies" / "tank.csv"));
  config.out.bodies = "all";
  unbroken(folder / "all");
  EXPECT_TRUE(fs::exists(folder / "all" / "bodies" / "tank.csv"));
  config.out.bodies = "none";
  unbroken(folder / "none");
  EXPECT_FALSE(fs::exists(folder / "none" / "bodies"));
}

TEST_F(RunFolder, ResolvedCaseNamesVersionDeviceAndSeed) {
  config.seed = 42;
  RunOutput(folder.path(), config, kDevice, "0.1.0");
  const std::string text = read_file(folder / "case.resolved.toml");
  EXPECT_EQ(text.find("# Bedload 0.1.0\n# device: cpu, two threads\n# seed: 42\n"), 0u) << text;
  EXPECT_GT(text.size(), 80u);
}

TEST_F(RunFolder, SummaryTellsHowTheRunEnded) {
  FakeSimulation s;
  RunOutput out(folder.path(), config, kDevice, "0.1.0");
  run_to(s, out, 12);
  out.warn("Ma = 0.2 is large");
  out.add("viscometer", {{"viscosity", "Pa s", 7}}, "of the fluid alone");
  out.finish(s, "stopped", {2.0, 100, 36, 2});
  const auto summary = nlohmann::json::parse(read_file(folder / "summary.json"));
  EXPECT_EQ(summary["status"], "stopped");
  EXPECT_EQ(summary["version"], "0.1.0");
  EXPECT_EQ(summary["counts"]["fluid"], 6);
  EXPECT_EQ(summary["steps"], 12);
  EXPECT_EQ(summary["substeps"], 36);
  EXPECT_EQ(summary["rebuilds"], 2);
  EXPECT_EQ(summary["time"]["value"], s.time());
  EXPECT_EQ(summary["wall_time_of"]["fluid"]["value"], 3.0);
  EXPECT_EQ(summary["wall_time_of"]["fluid"]["unit"], "s");
  EXPECT_EQ(summary["numerical_viscosity"]["artificial_bulk"]["value"], 12.5);
  EXPECT_EQ(summary["particle_steps_rate"]["value"], 50.0);
  EXPECT_EQ(summary["memory"]["solver"]["value"], 12345);
  EXPECT_EQ(summary["warnings"], nlohmann::json::array({"Ma = 0.2 is large"}));
  EXPECT_EQ(summary["metrics"]["fluid mass"]["unit"], "kg");
  EXPECT_EQ(summary["probes"]["gauge"]["gauge"]["value"], s.time() / 3);
  EXPECT_EQ(summary["last_checkpoint"], "checkpoints/step_000000012.h5");
  EXPECT_EQ(summary["viscometer"]["viscosity"]["value"], 7);
  EXPECT_EQ(summary["viscometer"]["note"], "of the fluid alone");
  EXPECT_EQ(summary["lost"]["fluid"]["z+"]["mass"]["value"], 0.125);
  EXPECT_EQ(summary["lost"]["fluid"]["z+"]["first"]["unit"], "s");
  EXPECT_EQ(summary["lost"]["grains"], nlohmann::json::object());
  EXPECT_EQ(out.last_checkpoint(), folder / "checkpoints/step_000000012.h5");
}

TEST_F(RunFolder, CheckpointsComeOnTimeAndAtTheEnd) {
  config.out.checkpoint_every = 0.3;
  unbroken(folder.path());
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(folder / "checkpoints"))
    found.push_back(entry.path().filename().string());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<std::string>{"step_000000010.h5", "step_000000020.h5", "step_000000025.h5"}));
}

TEST_F(RunFolder, FailedRunKeepsNoCheckpointOfItsState) {
  FakeSimulation s;
  RunOutput out(folder.path(), config, kDevice, "0.1.0");
  run_to(s, out, 5);
  const auto good = out.checkpoint(s);
  EXPECT_TRUE(fs::exists(good));
  out.write(s, s.step());
  out.finish(s, "failed", {1, 1});
  EXPECT_EQ(out.last_checkpoint(), good);
  EXPECT_EQ(FrameFile(folder / "fluid.vtkhdf").times().back(), s.time());
}

TEST_F(RunFolder, StoppedAndRestartedEqualsUnbroken) {
  unbroken(folder / "a");
  const auto dir = folder / "b";
  for (const int stop : {0, 5, 7, 14, 25}) {  // 7 and 14 are due times of frames
    fs::remove_all(dir);
    fs::path checkpoint;
    {
      FakeSimulation s;
      RunOutput out(dir, config, kDevice, "0.1.0");
      run_to(s, out, stop);
      out.finish(s, "stopped", {1, 1});
      checkpoint = out.last_checkpoint();
    }
    FakeSimulation s;
    s.load(read_checkpoint(checkpoint, config));
    ASSERT_EQ(s.steps(), stop);
    RunOutput out(dir, config, kDevice, "0.1.0", &s);
    EXPECT_EQ(out.last_checkpoint(), checkpoint);
    run_to(s, out, 25);
    out.finish(s, "completed", {1, 1});
    expect_same_results(folder / "a", dir);
  }
}

TEST_F(RunFolder, RestartDropsWhatLiesAfterItsTime) {
  config.out.checkpoint_every = 0.3;
  unbroken(folder / "a");
  unbroken(folder / "b");
  {  // a killed run: half a row at the end
    std::string rows = read_file(folder / "b" / "diagnostics.csv");
    rows.resize(rows.size() - 7);
    write_file(folder / "b" / "diagnostics.csv", rows);
  }
  FakeSimulation s;
  s.load(read_checkpoint(folder / "b/checkpoints/step_000000010.h5", config));
  RunOutput out(folder / "b", config, kDevice, "0.1.0", &s);
  out.write(s, s.step());
  EXPECT_EQ(out.checkpoint(s).filename(), "step_000000011.h5");
  EXPECT_EQ(FrameFile(folder / "b/fluid.vtkhdf").times().size(), 4u);
  EXPECT_EQ(CsvTable(folder / "b/diagnostics.csv").times().size(), 7u);
  run_to(s, out, 25);
  out.finish(s, "completed", {1, 1});
  expect_same_results(folder / "a", folder / "b");
  EXPECT_EQ(read_file(folder / "a/checkpoints/step_000000020.h5"),
            read_file(folder / "b/checkpoints/step_000000020.h5"));
}

TEST_F(RunFolder, LatestIsTheMostSteps) {
  fs::create_directories(folder / "checkpoints");
  for (const char* name : {"step_999999999.h5", "step_1000000000.h5", "step_000000017.h5", "step_.h5",
                           "step_5000000000x.h5", "step_6000000000.h5.part", "step_-7.h5", "other.h5"})
    write_file(folder / "checkpoints" / name, "");
  EXPECT_EQ(latest_checkpoint(folder.path()).filename(), "step_1000000000.h5");
}

/// Until a step is made it is not sure that the run goes on.
TEST_F(RunFolder, ARestartChangesNothingBeforeItsFirstStep) {
  config.out.checkpoint_every = 0.3;
  unbroken(folder.path());
  const auto contents = [&] {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
      if (entry.is_regular_file()) all[entry.path()] = read_file(entry.path());
    return all;
  };
  const auto before = contents();
  const auto early = folder / "checkpoints/step_000000010.h5";
  {
    FakeSimulation s;
    s.load(read_checkpoint(early, config));
    RunOutput out(folder.path(), config, kDevice, "0.1.0", &s);
    EXPECT_EQ(out.last_checkpoint(), early);
    out.finish(s, "stopped", {1, 1});
  }
  EXPECT_TRUE(contents() == before);
  FakeSimulation s;
  s.load(read_checkpoint(early, config));
  RunOutput out(folder.path(), config, kDevice, "0.1.0", &s);
  EXPECT_TRUE(contents() == before);
  out.write(s, s.step());
  EXPECT_EQ(latest_checkpoint(folder.path()), early);
  EXPECT_FALSE(fs::exists(folder / "summary.json"));
}

TEST_F(RunFolder, TellsWhatIsMissingBeforeARestart) {
  unbroken(folder.path());
  FakeSimulation s;
  s.load(read_checkpoint(folder / "checkpoints/step_000000025.h5", config));
  const auto gaps = [&](const Config& now) {
    return RunOutput(folder.path(), now, kDevice, "0.1.0", &s).gaps(config);
  };
  Config other = config;
  other.out.every = 0.01;
  other.out.probes.push_back(config.out.probes[0]);
  other.out.probes.back().name = "new";
  EXPECT_TRUE(gaps(config).empty());
  EXPECT_TRUE(gaps(other).empty()) << "what it is to write from now on is not missing";
  CsvTable(folder / "probes/gauge.csv").keep(2);
  FrameFile(folder / "grains.vtkhdf").keep(0);
  const std::vector<std::string> expected{(folder / "grains.vtkhdf").string() + " is missing",
                                          (folder / "probes/gauge.csv").string() + " ends at t = 0.21 s"};
  EXPECT_EQ(gaps(config), expected);
  other.out.probes.erase(other.out.probes.begin());
  EXPECT_EQ(gaps(other).size(), 1u) << "nothing goes on with the gauge";
}

TEST_F(RunFolder, FreshRunRemovesTheFormerOne) {
  config.out.checkpoint_every = 0.3;
  unbroken(folder.path());
  RunOutput out(folder.path(), config, kDevice, "0.1.0");
  EXPECT_TRUE(out.last_checkpoint().empty());
  EXPECT_TRUE(FrameFile(folder / "fluid.vtkhdf").times().empty());
  EXPECT_FALSE(fs::exists(folder / "summary.json"));
  EXPECT_FALSE(fs::exists(folder / "diagnostics.csv"));
}

TEST_F(RunFolder, UnwritableFolderIsOneSentence) {
  write_file(folder / "file", "");
  const std::string message = error_of([&] { RunOutput(folder / "file" / "run", config, kDevice, "0.1.0"); });
  EXPECT_NE(message.find("file/run: cannot write results there: Not a directory"), std::string::npos)
      << message;
}

TEST_F(RunFolder, FullDiskSurfaces) {
  FakeSimulation s;
  RunOutput out(folder.path(), config, kDevice, "0.1.0");
  fs::create_symlink("/dev/full", folder / "probes" / "gauge.csv");
  out.write(s, s.info());
  const std::string message = error_of([&] { out.checkpoint(s); });
  EXPECT_NE(message.find("gauge.csv: cannot write: No space left on device"), std::string::npos) << message;
  EXPECT_EQ(error_of([&] { out.finish(s, "completed", {1, 1}); }), message);
}

TEST_F(RunFolder, WriterErrorSurfacesInALaterStep) {
  FakeSimulation s;
  RunOutput out(folder.path(), config, kDevice, "0.1.0");
  fs::create_directory(folder / "grains.vtkhdf");
  const std::string message = error_of([&] {
    run_to(s, out, 25);
    out.finish(s, "completed", {1, 1});
  });
  EXPECT_NE(message.find("grains.vtkhdf: cannot write: "), std::string::npos) << message;
}

TEST(CsvTable, HasSeveralRowsOfOneTime) {
  const test::TemporaryFolder folder;
  const CsvTable table(folder / "spectra.csv");
  for (const double time : {0.0, 1.0, 2.0})
    table.append_rows(time,
                      {{{"from", "J", 1}, {"count", "-", time}}, {{"from", "J", 2}, {"count", "-", 5}}});
  EXPECT_EQ(table.times(), (std::vector<double>{0, 1, 2}));
  table.keep(2);
  EXPECT_EQ(read_file(table.path()), "time [s],from [J],count [-]\n0,1,0\n0,2,5\n1,1,1\n1,2,5\n");
}

TEST(CsvTable, OtherColumnsAreRefused) {
  const test::TemporaryFolder folder;
  const CsvTable table(folder / "a.csv");
  table.append(0, {{"front", "m", 1}});
  table.append(0.1, {{"front", "m", 1.0 / 3}});
  EXPECT_EQ(read_file(table.path()), "time [s],front [m]\n0,1\n0.1,0.3333333333333333\n");
  const std::string message = error_of([&] { table.append(1, {{"height", "m", 1}}); });
  EXPECT_NE(message.find("a.csv: has the columns 'time [s],front [m]'"), std::string::npos) << message;
  EXPECT_NE(message.find("give the restart another --out"), std::string::npos) << message;
}

}  // namespace
}  // namespace bedload::testing
