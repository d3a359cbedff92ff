// Several processes: `bedload run --mpi`.

#include <algorithm>
#include <map>

#include "run_program.hpp"

namespace bedload::test {
namespace {

namespace fs = std::filesystem;

/// Water and settled grains that collapse together.
const std::string kSlurry = R"([domain]
min = [0, 0, 0]
max = [0.2, 0.06, 0.3]
[fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0]
max = [0.1, 0.06, 0.1]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.2, 0.06, 0.15]
faces = ["x-", "x+", "y-", "y+", "z-"]
[grain]
d = 0.008
settle = true
settle_time = 0.02
[[grain.fill]]
min = [0, 0, 0]
max = [0.1, 0.06, 0.08]
count = 60
[run]
block = 1
[time]
end = 0.01
[out]
every = 0.005
[checkpoint]
every = 0.005
[[probe]]
name = "side"
type = "force"
body = "tank"
)";

bool one_sentence(const std::string& text) { return std::ranges::count(text, '\n') == 1; }

using WithoutProcesses = ProgramTest;

TEST_F(WithoutProcesses, ProgramStartsWithoutThePlugin) {
  write("slurry.toml", kSlurry);
  fs::copy(BL_PROGRAM, dir_ / "alone");
  const Outcome needs = shell("env -u LD_LIBRARY_PATH ldd alone");
  EXPECT_EQ(needs.out.find("libmpi"), needs.out.npos) << needs.out;
  const Outcome o = shell("env -u LD_LIBRARY_PATH ./alone run slurry.toml --mpi");
  EXPECT_EQ(o.code, 2) << o.out;
  EXPECT_TRUE(o.err.starts_with("--mpi: libbedload_mpi.so: ") && one_sentence(o.err)) << o.err;
  const Outcome both = bedload("run slurry.toml --mpi --ranks 2");
  EXPECT_EQ(both.code, 2);
  EXPECT_NE(both.err.find("--ranks excludes --mpi"), both.err.npos) << both.err;
}

class SeveralProcesses : public ProgramTest {
 protected:
  void SetUp() override {
    if (!fs::exists(fs::path(BL_PROGRAM).parent_path() / "lib/libbedload_mpi.so") ||
        shell("mpirun --version").code != 0)
      GTEST_SKIP() << "there is no MPI; tools/install_dependencies --mpi installs it";
    write("slurry.toml", kSlurry);
  }
  /// Of Open MPI also as root, with more processes than cores, and without its own words.
  Outcome mpirun(const std::string& words) const {
    return shell(
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
        "OMPI_MCA_orte_execute_quiet=1 OMP_NUM_THREADS=1 mpirun " +
        words);
  }
  static std::string run(const std::string& words) {
    return std::string(BL_PROGRAM) + " run " + words + " --backend cpu --mpi";
  }
  /// What a results folder holds but times.
  std::map<std::string, std::string> files(const std::string& folder) const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(dir_ / folder))
      if (entry.is_regular_file() && entry.path().filename() != "summary.json")
        out[fs::relative(entry.path(), dir_ / folder)] = content_of(entry.path());
    return out;
  }
  void expect_same(const std::string& a, const std::string& b) const {
    const auto of_a = files(a), of_b = files(b);
    ASSERT_EQ(of_a.size(), of_b.size());
    ASSERT_GT(of_a.size(), 6u);
    for (const auto& [name, content] : of_a)
      EXPECT_TRUE(of_b.contains(name) && of_b.at(name) == content) << name;
  }
};

TEST_F(SeveralProcesses, WriteTheFilesOfThreads) {
  const Outcome threads = bedload("run slurry.toml --backend cpu --threads 1 --ranks 3 --out threads");
  ASSERT_EQ(threads.code, 0) << threads.err;
  fs::remove_all(dir_ / "cache");  // the settled bed
  const Outcome o = mpirun("-n 3 " + run("slurry.toml --threads 1 --out processes"));
  ASSERT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_EQ(o.err, "");
  EXPECT_EQ(o.out.find("completed"), o.out.rfind("completed")) << "one of them prints";
  EXPECT_NE(o.out.find("exchange   by host memory, as process 0 computes on the CPU\n"), o.out.npos) << o.out;
  expect_same("threads", "processes");

  // with another number from a checkpoint on
  ASSERT_EQ(mpirun("-n 2 " + run("slurry.toml --mpi-data host --threads 1 --until 0.005 --out again")).code,
            0);
  ASSERT_EQ(mpirun("-n 3 " + run("slurry.toml --threads 1 --out again --restart latest")).code, 0);
  expect_same("threads", "again");
}

TEST_F(SeveralProcesses, EndTogether) {
  write("other.toml", kSlurry + "[eos]\nbackground = 1\n");
  const Outcome other = mpirun("-n 2 " + run("slurry.toml") + " : -n 1 " + run("other.toml"));
  EXPECT_EQ(other.code, 2) << other.out;
  EXPECT_NE(other.err.find("process 2 has read another case than process 0"), other.err.npos) << other.err;
  const Outcome cpu = mpirun("-n 2 " + run("slurry.toml --mpi-data nccl --out b"));
  EXPECT_EQ(cpu.code, 2) << cpu.out;
  EXPECT_EQ(cpu.err, "--mpi-data nccl: process 0 computes on the CPU\n");
  const Outcome none = mpirun("-n 2 " + run("slurry.toml --out b") + " : -n 1 " + run("none.toml --out b"));
  EXPECT_EQ(none.code, 2) << none.out;
  EXPECT_NE(none.err.find("none.toml"), none.err.npos) << none.err;
}

}  // namespace
}  // namespace bedload::test
