// Several ranks from outside: `bedload check`, `run` and `bench`.

#include <nlohmann/json.hpp>
#include <regex>

#include "cli/room.hpp"
#include "run_program.hpp"

namespace bedload::test {
namespace {

using DividedProgram = ProgramTest;

const std::string kPool = R"([domain]
min = [-0.05, -0.05, -0.05]
max = [0.25, 0.11, 0.2]
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
[run]
block = 1
[time]
end = 0.01
[out]
every = 0.005
)";

TEST_F(DividedProgram, CheckSaysWhatEachRankHas) {
  write("pool.toml", kPool);
  const Outcome o = bedload("check pool.toml --backend cpu --ranks 2");
  ASSERT_EQ(o.code, 0) << o.err;
  const std::regex line(R"((\d): fluid (\d+), walls ([\d ]+), grains 0, ghosts ([\d ]+); \d.* of .* free\n)");
  int ranks = 0, fluid = 0;
  for (std::sregex_iterator at(o.out.begin(), o.out.end(), line), end; at != end; ++at, ++ranks) {
    EXPECT_EQ(at->str(1), std::to_string(ranks));
    fluid += std::stoi(at->str(2));
    EXPECT_GT(std::stoi(at->str(4)), 0);
  }
  EXPECT_EQ(ranks, 2) << o.out;
  EXPECT_EQ(fluid, 600);
  std::smatch found;
  ASSERT_TRUE(std::regex_search(o.out, found, std::regex(R"(\nimbalance  (\S+): )"))) << o.out;
  EXPECT_GE(std::stod(found[1]), 1);
  EXPECT_LT(std::stod(found[1]), 1.3);
  ASSERT_TRUE(std::regex_search(o.out, found, std::regex(R"(\nexchanges  (\S+) a step)"))) << o.out;
  EXPECT_GE(std::stod(found[1]), 3) << "kick-drift-kick has three";
  ASSERT_TRUE(std::regex_search(o.out, found, std::regex(R"(\nspeed-up   (\S+) over one rank)"))) << o.out;
  EXPECT_GT(std::stod(found[1]), 0);
  EXPECT_EQ(bedload("check pool.toml --backend cpu").out.find("\nranks "), std::string::npos);
}

TEST_F(DividedProgram, BenchMakesTablesOfScaling) {
  write("pool.toml", kPool);
  const Outcome o = bedload(
      "bench pool.toml --widths 0.02 --set run.block=1 --set fluid.dx=0.01 --backend cpu --ranks 2,1 --warm "
      "1 --steps 4 --spans "
      "1 --json "
      "speed.json");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("\nStrong scaling"), o.out.npos) << o.out;
  EXPECT_NE(o.out.find("\nWeak scaling"), o.out.npos) << o.out;
  const auto json = nlohmann::json::parse(content_of(dir_ / "speed.json"));
  std::map<std::string, std::vector<nlohmann::json>> rows;
  for (const auto& row : json.at("rows"))
    rows[row.at("row").get<std::string>() + " " + row.at("scaling").get<std::string>()].push_back(row);
  ASSERT_EQ(rows.size(), 3u);  // a case file cannot grow
  for (const auto& [name, pair] : rows) {
    ASSERT_EQ(pair.size(), 2u) << name;
    const auto &one = pair[0], &two = pair[1];
    EXPECT_EQ(one.at("ranks"), 1) << name;
    EXPECT_EQ(one.at("speed_up"), 1) << name;
    EXPECT_EQ(one.at("ghost_percent"), 0) << name;
    EXPECT_EQ(two.at("ranks"), 2) << name;
    const bool weak = name.ends_with("weak");
    const double times = two.at("fluid_particles").get<double>() / one.at("fluid_particles").get<double>();
    EXPECT_NEAR(times, weak ? 2 : 1, 1e-9) << name;
    const double expected = times * one.at("step_ms").get<double>() / two.at("step_ms").get<double>();
    EXPECT_NEAR(two.at("speed_up"), expected, 1e-9 * expected) << name;
    EXPECT_NEAR(two.at("efficiency_percent"), 50 * expected, 1e-7 * expected) << name;
    EXPECT_GT(two.at("ghost_percent"), 0) << name;
    EXPECT_GE(two.at("imbalance"), 1) << name;
    EXPECT_GE(two.at("wait_percent"), 0) << name;
    EXPECT_GT(two.at("exchanges_per_step"), 1) << name;
    EXPECT_GT(two.at("sent_mb_per_step"), 0) << name;
    EXPECT_GE(two.at("migrated_per_step"), 0) << name;
  }
}

TEST_F(DividedProgram, WarnsOfRanksWithoutParticles) {
  write("pool.toml", kPool);
  const Outcome o = bedload("run pool.toml --backend cpu --ranks 4 --set run.block=8 --until 1e-4");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_TRUE(std::regex_search(
      o.err, std::regex(R"(warning: [123] of 4 ranks have no particles: .* run.block = 8)")))
      << o.err;
  EXPECT_EQ(bedload("run pool.toml --backend cpu --ranks 4 --until 1e-4 --overwrite").err, "");
}

TEST_F(DividedProgram, RefusesWhatCannotBe) {
  write("pool.toml", kPool);
  const Outcome both = bedload("bench pool.toml --ranks 2 --devices 2");
  EXPECT_EQ(both.code, 2);
  EXPECT_NE(both.err.find("give one"), both.err.npos) << both.err;
  const Outcome none = bedload("check pool.toml --backend cpu --devices 2");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("--devices 2: there is no GPU to use"), none.err.npos) << none.err;
}

TEST(DivisionMemory, IsThatOfAPart) {
  MemoryEstimate e{.fluid = 400, .rest = 0};
  const Counts n{.fluid = 1000};
  EXPECT_EQ(e.of(n), 400000u);
  e.ranks = 2;
  EXPECT_EQ(e.of(n), 240000u) << "half, with a fifth more";
  e.ranks = 4;
  EXPECT_EQ(e.of(n), 120000u);
  e.ranks = 1;
  EXPECT_EQ(devices_with_room(e, n, {350000, 350000, 350000}), 2);
  EXPECT_EQ(devices_with_room(e, n, {350000, 200000, 200000}), 3) << "all must have room";
  EXPECT_EQ(devices_with_room(e, n, {119000, 119000, 119000, 119000}), 0);
  e.ranks = 2;
  EXPECT_EQ(devices_with_room(e, n, {350000, 350000, 350000}), 3) << "more than have been tried";
  EXPECT_EQ(devices_with_room(e, n, {}), 0);
}

}  // namespace
}  // namespace bedload::test
