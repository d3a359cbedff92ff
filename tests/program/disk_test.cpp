// Disks that fill up and folders that go while a run writes to them.

#include <algorithm>

#include "run_program.hpp"
#include "tests/support/cases.hpp"

namespace bedload::test {
namespace {

/// Writes a checkpoint every 0.004 s and frames more often.
const std::string kCase =
    small_dam() + "[time]\nend = 0.1\n[out]\nevery = 0.002\n[checkpoint]\nevery = 0.004\n";

const std::string kRun =
    "timeout 100 " BL_PROGRAM " run case.toml --backend cpu --quiet --threads 1 --out out ";

class Disk : public ProgramTest {
 protected:
  void SetUp() override { write("case.toml", kCase); }

  /// Runs without end until there is a checkpoint, then does `harm`; tells how the run ends.
  Outcome harmed(const std::string& harm) const {
    return shell(
        "sh -c '" + kRun + "--overwrite --set time.end=1000 & run=$!; n=0; until " +
        "ls out/checkpoints/*.h5 >/dev/null 2>&1 || [ $((n += 1)) -gt 3000 ]; do sleep 0.02; done; " + harm +
        "; wait $run'");
  }

  /// One sentence that names `file` and the reason, and a checkpoint that is whole.
  void expect_stopped(const Outcome& o, const std::string& file, const std::string& reason) const {
    EXPECT_EQ(o.code, 2);
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_NE(o.err.find(file), o.err.npos) << o.err;
    EXPECT_NE(o.err.find(": cannot write: " + reason), o.err.npos) << o.err;
    const std::string told = "; the last good checkpoint is ";
    const auto at = o.err.find(told);
    ASSERT_NE(at, o.err.npos) << o.err;
    last_ = o.err.substr(at + told.size(), o.err.size() - at - told.size() - 1);
  }

  /// Every frame so far can be read, and the run goes on to the same end as one that was never stopped.
  void expect_nothing_lost() const {
    EXPECT_EQ(bedload("info " + last_).code, 0) << last_;
    for (const std::string store : {"fluid", "grains", "walls"}) {
      const Outcome o = bedload("info out/" + store + ".vtkhdf");
      EXPECT_EQ(o.code, 0) << o.err;
      EXPECT_NE(o.out.find("NSteps = "), o.out.npos) << o.out;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(dir_ / "out"))
      EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    const Outcome on = shell(kRun + "--restart latest");
    ASSERT_EQ(on.code, 0) << on.err;
    std::filesystem::rename(dir_ / "out", dir_ / "parts");
    ASSERT_EQ(shell(kRun).code, 0);
    const auto last_of = [&](const std::string& run) {
      std::filesystem::path newest;
      for (const auto& entry : std::filesystem::directory_iterator(dir_ / run / "checkpoints"))
        newest = std::max(newest, entry.path());
      return newest;
    };
    EXPECT_TRUE(content_of(last_of("out")) == content_of(last_of("parts")));
    EXPECT_EQ(content_of(dir_ / "out/diagnostics.csv"), content_of(dir_ / "parts/diagnostics.csv"));
  }

  mutable std::string last_;
};

TEST_F(Disk, AFolderThatIsMovedAwayStopsTheRun) {
  const Outcome o = harmed("mv out gone");
  EXPECT_EQ(o.code, 2);
  EXPECT_TRUE(o.err.starts_with("out/")) << o.err;
  EXPECT_NE(o.err.find(": cannot "), o.err.npos) << "write, or open for it: " << o.err;
  EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  EXPECT_EQ(o.err.find("checkpoint is"), o.err.npos) << "it has gone as well: " << o.err;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "out"));
}

TEST_F(Disk, AFileThatIsRemovedIsNotBegunAnew) {
  for (const std::string file : {"out/fluid.vtkhdf", "out/diagnostics.csv"}) {
    std::filesystem::remove_all(dir_ / "out");
    const Outcome o = harmed("rm " + file);
    expect_stopped(o, file, "it was removed during the run");
    EXPECT_EQ(bedload("info " + last_).code, 0);
    EXPECT_FALSE(std::filesystem::exists(dir_ / file));
  }
}

TEST_F(Disk, ALimitOnTheSizeOfFilesStopsTheRunAndLosesNothing) {
  const Outcome o =
      shell("bash -c 'ulimit -f 1400; " + kRun + "'");  // kB: frames take a few, and 1 MB to spare
  expect_stopped(o, "out/walls.vtkhdf", "File too large");
  expect_nothing_lost();
}

/// A disk of a few MB that nothing else is on, where the user may make one.
TEST_F(Disk, AFullDiskStopsTheRunAndLosesNothing) {
  std::filesystem::create_directory(dir_ / "out");
  const std::string mounted = "unshare -Urm bash -c 'mount -t tmpfs -o size=4m tmpfs out && ";
  if (shell(mounted + "true'").code != 0) GTEST_SKIP() << "this user may not mount a disk";
  const Outcome o = shell(mounted + kRun + "; code=$?; cp -r out kept; exit $code'");
  std::filesystem::remove(dir_ / "out");
  std::filesystem::rename(dir_ / "kept", dir_ / "out");
  expect_stopped(o, "out/", "disk full: ");
  expect_nothing_lost();
}

}  // namespace
}  // namespace bedload::test
