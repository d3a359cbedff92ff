// The program from outside: exit codes, messages, files.

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <vector>

#include "bedload/output/folder_lock.hpp"
#include "run_program.hpp"
#include "tests/support/cases.hpp"

namespace bedload::test {
namespace {

const std::string kSmall = "title = \"small dam\"\n" + small_dam("settle = true\nsettle_time = 0.05\n") +
                           "[time]\nend = 0.02\n[out]\nevery = 0.01\n";

class Program : public ProgramTest {
 protected:
  /// The last checkpoints of both runs are equal to the last bit.
  void expect_same_checkpoints(const std::string& one, const std::string& other) const {
    const auto last = [&](const std::string& run) {
      std::filesystem::path newest;
      for (const auto& entry : std::filesystem::directory_iterator(dir_ / run / "checkpoints"))
        newest = std::max(newest, entry.path());
      return newest;
    };
    EXPECT_EQ(last(one).filename(), last(other).filename());
    EXPECT_TRUE(content_of(last(one)) == content_of(last(other))) << one << " and " << other << " differ";
  }
  /// Runs in halves, the second without the file that the grains of the first come from.
  void expect_restart_without_file(bool sizes) const {
    std::string text = kSmall, table = sizes ? "x,y,z,d\n" : "x,y,z\n";
    const std::string box = "min = [0, 0, 0]\nmax = [0.05, 0.06, 0.03]\ncount = 40\n";
    text.replace(text.find(box), box.size(), "file = \"grains.csv\"\n");
    for (int n = 0; n < 40; ++n)
      table += std::to_string(0.005 + 0.007 * (n % 5)) + "," + std::to_string(0.005 + 0.007 * (n / 5)) +
               ",0.01" +
               (!sizes  ? ""
                : n % 2 ? ",0.005"
                        : ",0.004") +
               "\n";
    write("dam.toml", text);
    write("grains.csv", table);
    const std::string run = "run dam.toml --backend cpu --quiet ";
    ASSERT_EQ(bedload(run + "--overwrite --out whole").code, 0);
    ASSERT_EQ(bedload(run + "--overwrite --out parts --until 0.01").code, 0);
    std::filesystem::path middle;
    for (const auto& entry : std::filesystem::directory_iterator(dir_ / "parts/checkpoints"))
      middle = entry.path();
    std::filesystem::remove(dir_ / "grains.csv");
    const Outcome o = bedload(run + "--out parts --restart " + middle.string());
    ASSERT_EQ(o.code, 0) << o.err;
    expect_same_checkpoints("whole", "parts");
    const Outcome missing = bedload(run + "--out other");
    EXPECT_EQ(missing.code, 2);
    EXPECT_TRUE(
        missing.err.starts_with("dam.toml:21: grain.fill.file = \"grains.csv\" must be a file; there is no "))
        << missing.err;
  }
};

/// Batch systems stop runs so, and terminals that close.
TEST_F(Program, StopsAtASignalWithACheckpointToGoOnFrom) {
  write("dam.toml", kSmall);
  for (const std::string signal : {"HUP", "TERM"}) {
    const std::string out = "out_" + signal;
    const Outcome stopped =
        shell("sh -c '" BL_PROGRAM " run dam.toml --backend cpu --quiet --until 1000 --out " + out +
              " & run=$!; until [ -s " + out + "/diagnostics.csv ]; do sleep 0.05; done; kill -" + signal +
              " $run; wait $run'");
    EXPECT_EQ(stopped.code, 130) << signal << ": " << stopped.err;
    std::size_t checkpoints = 0;
    for (const auto& entry : std::filesystem::directory_iterator(dir_ / out / "checkpoints")) {
      ++checkpoints;
      EXPECT_EQ(bedload("info " + entry.path().string()).code, 0) << signal;
    }
    EXPECT_EQ(checkpoints, 1u) << signal;
  }
}

TEST_F(Program, SaysItsVersion) {
  const Outcome o = bedload("--version");
  EXPECT_EQ(o.code, 0);
  EXPECT_EQ(o.out, "bedload " BL_VERSION "\n");
}

TEST_F(Program, HelpsWhenAsked) {
  const Outcome o = bedload("run --help");
  EXPECT_EQ(o.code, 0);
  for (const char* option : {"--backend", "--precision", "--out", "--set", "--until", "--restart",
                             "--threads", "--quiet", "--force-dt", "--overwrite"})
    EXPECT_NE(o.out.find(option), std::string::npos) << option;
}

TEST_F(Program, RefusesWrongCommandLinesWithOneSentence) {
  write("dam.toml", kSmall);
  const auto refused = [&](const std::string& arguments, const std::string& place, const std::string& why) {
    const Outcome o = bedload(arguments);
    EXPECT_EQ(o.code, 2) << arguments;
    EXPECT_TRUE(o.err.starts_with(place + ": ")) << o.err;
    EXPECT_NE(o.err.find(why), o.err.npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  };
  const std::string line = "command line";
  refused("", line, "subcommand is required");
  refused("simulate dam.toml", line, "unknown command simulate");
  refused(
      "simulate dam.toml", line,
      "run, viscometer, check, new, demo, list, info, convert, bench, drag, gui, schema, completion, man");
  write("empty.toml", "\n");
  refused("check empty.toml", "empty.toml", "is empty");
  refused("run", line, "case is required");
  refused("run dam.toml --bogus", line, "not expected: --bogus");
  refused("run dam.toml --backend gpu", line, "--backend: gpu not in {auto,cpu,cuda}");
  refused("run no.toml", "no.toml", "no such file");
  refused("check dam.toml --set grain.e=1.4", "--set grain.e=1.4", "grain.e = 1.4 must be within 0.05..1");
  refused("run dam.toml --backend cpu --restart no.h5", "no.h5", "no such file");
  refused("info no.h5", "no.h5", "no such file");
  refused("info dam.toml", "dam.toml", "not a checkpoint");
}

TEST_F(Program, NamesFileAndLineOfAWrongCase) {
  write("dam.toml", "[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nperiod = true\n");
  for (const char* command : {"run", "check"}) {
    const Outcome o = bedload(std::string(command) + " dam.toml");
    EXPECT_EQ(o.code, 2);
    EXPECT_EQ(o.err, "dam.toml:4: domain.period is not a parameter; did you mean domain.periodic?\n");
    EXPECT_EQ(o.out, "");
  }
}

TEST_F(Program, ListsItsFamilies) {
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"laws", "gidaspow_blend"},
      {"models", "wendland_c2"},
      {"shapes", "tank"},
      {"outputs", "front"},
      {"parameters", "grain.fill.packing_fraction"},
      {"presets", "he2018"},
      {"words", "DesignSPHysics  inter-particle distance"}};
  const Outcome all = bedload("list");
  for (const auto& [family, member] : expected) {
    const Outcome o = bedload("list " + family);
    EXPECT_EQ(o.code, 0) << family;
    EXPECT_NE(o.out.find(member), std::string::npos) << family;
    EXPECT_NE(all.out.find(o.out), std::string::npos) << family;
  }
  // the parameters of what can be chosen, with unit, default and bounds
  EXPECT_NE(bedload("list laws").out.find("contact.k "), std::string::npos);
  EXPECT_NE(bedload("list outputs").out.find("out.diagnostics_every "), std::string::npos);
  const Outcome wrong = bedload("list lawz");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.err.find("did you mean laws?"), std::string::npos) << wrong.err;
  EXPECT_EQ(bedload("list xyzzy").err.find("did you mean"), std::string::npos);
  // a word of another program, and the parameters that it is here
  const Outcome word = bedload("list time_max");
  EXPECT_TRUE(word.out.starts_with("DualSPHysics  TimeMax  time.end\n\nkey ")) << word.out;
  EXPECT_NE(word.out.find("end time of the run"), std::string::npos) << word.out;
  EXPECT_EQ(
      bedload("list 'surface tension'").out.rfind("-  surface tension  there is no surface tension;", 0), 0u);
  EXPECT_NE(bedload("list TimeMax --json").out.find("\"time.end\""), std::string::npos);
  EXPECT_NE(bedload("list fluid.dx").out.find("particle spacing"), std::string::npos);
}

TEST_F(Program, ChecksACaseWithoutRunningIt) {
  write("dam.toml", kSmall);
  const Outcome o = bedload("check dam.toml --backend cpu");
  EXPECT_EQ(o.code, 0) << o.err;
  for (const char* part : {"fluid 150, walls ", "grains 40", "(active), set by time.", "substep    rayleigh",
                           "memory     ", "tension    fluid cavitates below -", "wake       ",
                           "contacts   grain.E = ", "run time   about ", "settling   at most ", "\ncase OK\n",
                           "40 grains of 0.005 m: 0.5 times fluid.dx, h_c 3 d, 113 fluid particles per "
                           "kernel, by the drag law\n"})
    EXPECT_NE(o.out.find(part), std::string::npos) << part << "\n" << o.out;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "results"));
}

/// What `check` tells and what the run then holds at its end, MB.
class ProgramMemory : public Program {
 protected:
  void expect_told(bool fast, const std::string& options = "") const {
    const auto number_after = [](const std::string& text, const std::string& words) {
      return std::stod(text.substr(text.find(words) + words.size()));
    };
    const std::string arguments = " dam.toml --backend cpu " + options;
    const Outcome before = bedload("check" + arguments);
    ASSERT_EQ(before.code, 0) << before.err;
    const Outcome run = bedload("run --quiet --overwrite --out run" + arguments);
    ASSERT_EQ(run.code, 0) << run.err;
    const Outcome after = bedload("check" + arguments);  // by the bed that the run has kept, if any
    const std::string summary = content_of(dir_ / "run/summary.json");
    const double held = 1e-6 * number_after(summary.substr(summary.find("\"solver\"")), "\"value\": ");
    for (const std::string& text : {before.out, after.out}) {
      ASSERT_NE(text.find(" MB"), std::string::npos) << text;
      double told = number_after(text, "memory     ");
      const std::string only = " kB only in fast flow";
      if (const auto at = text.find(only); !fast && at != std::string::npos)
        told -= 1e-3 * std::stod(text.substr(text.rfind(' ', at - 1)));
      EXPECT_NEAR(told, held, 0.05 * held) << options << '\n' << text;
    }
  }
};

TEST_F(ProgramMemory, OfADamThatBreaks) {
  write("dam.toml", R"(title = "dam"
[domain]
min = [0, 0, 0]
max = [0.2, 0.06, 0.12]
[fluid]
dx = 0.004
[[fluid.fill]]
min = [0, 0, 0]
max = [0.06, 0.06, 0.08]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.2, 0.06, 0.12]
faces = ["x-", "x+", "y-", "y+", "z-"]
[time]
end = 0.2
[run]
max_lost = 0.01
[out]
every = 0.1
)");
  expect_told(true);
}

TEST_F(ProgramMemory, OfABedThatSettlesFirst) {
  write("dam.toml", "title = \"bed\"\n" + small_dam("E = 1e6\nsettle = true\nsettle_time = 0.3\n") +
                        "[time]\nend = 0.02\n[out]\nevery = 0.01\n");
  expect_told(false,
              "--set fluid.dx=0.004 --set fluid.fill.0.max=[0.1,0.06,0.05] --set grain.d=0.004 "
              "--set grain.fill.0.count=800 --set grain.fill.0.max=[0.1,0.06,0.06]");
}

TEST_F(Program, CountsWhatComesIn) {
  write("spout.toml", R"([domain]
min = [-0.1, 0, 0]
max = [0.3, 0.08, 0.1]
[fluid]
dx = 0.01
vmax = 2
[[inlet]]
name = "spout"
shape = "rectangle"
centre = [0, 0.04, 0.05]
direction = [1, 0, 0]
half_a = [0, 0.04, 0]
half_b = [0, 0, 0.02]
velocity = 0.5
factor = "sin(pi*t)^2"
ramp = 1e-3
[grain]
d = 0.01
E = 1e6
[[grain_inlet]]
name = "chute"
min = [0.1, 0, 0.05]
max = [0.2, 0.04, 0.1]
rate = 30
[time]
end = 2
[out]
every = 1
)");
  const Outcome o = bedload("check spout.toml --backend cpu");
  EXPECT_EQ(o.code, 0) << o.err;
  for (const char* part :
       {"up to 1 600 fluid particles with inflow", "up to 60 grains with inflow", "incl. inflow"})
    EXPECT_NE(o.out.find(part), std::string::npos) << part << "\n" << o.out;
}

TEST_F(Program, ShowsWhatACaseStartsWith) {
  write("dam.toml", kSmall);
  const Outcome o = bedload("check dam.toml --backend cpu --preview look/here");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("preview    look/here/preview.png\n"), std::string::npos) << o.out;
  EXPECT_TRUE(content_of(dir_ / "look/here/preview.png").starts_with("\x89PNG"));
  EXPECT_NE(bedload("info look/here/grains.vtkhdf").out.find("40"), std::string::npos);
  const auto size = std::filesystem::file_size(dir_ / "look/here/fluid.vtkhdf");
  EXPECT_EQ(bedload("check dam.toml --backend cpu --preview look/here").code, 0);
  EXPECT_EQ(std::filesystem::file_size(dir_ / "look/here/fluid.vtkhdf"), size);  // anew, not one frame more
}

TEST_F(Program, ShowsTheWallsOfDryCases) {
  write("dam.toml", kSmall.substr(0, kSmall.find("[fluid]")) + kSmall.substr(kSmall.find("[[wall.body]]")));
  const Outcome o = bedload("check dam.toml --backend cpu --preview look");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(bedload("info look/walls.vtkhdf").code, 0);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "look/fluid.vtkhdf"));
}

TEST_F(Program, RunsDryCases) {
  write("dry.toml", kSmall.substr(0, kSmall.find("[fluid]")) + kSmall.substr(kSmall.find("[[wall.body]]")));
  const Outcome o = bedload("run dry.toml --backend cpu --quiet --until 0.001 --out r");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(bedload("info r/grains.vtkhdf").out.find("40"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "r/walls.vtkhdf"));  // grains meet surfaces, not particles
}

TEST_F(Program, RefusesAFolderThatCannotTakeAPreview) {
  write("dam.toml", kSmall);
  const Outcome o = bedload("check dam.toml --backend cpu --preview dam.toml/look");
  EXPECT_EQ(o.code, 2);
  EXPECT_TRUE(o.err.starts_with("dam.toml/look: ")) << o.err;
  EXPECT_NE(o.err.find("Not a directory"), o.err.npos) << o.err;
  EXPECT_TRUE(bedload("check dam.toml --backend cpu --preview dam.toml").err.starts_with("dam.toml: "));
  ASSERT_EQ(bedload("run dam.toml --backend cpu --quiet --until 0.001 --out r").code, 0);
  const Outcome run = bedload("check dam.toml --backend cpu --preview r");
  EXPECT_EQ(run.code, 2);
  EXPECT_TRUE(run.err.starts_with("r: holds a run")) << run.err;
}

TEST_F(Program, RefusesAFixedStepAboveItsLimit) {
  write("dam.toml", kSmall);
  const Outcome o = bedload("run dam.toml --backend cpu --set time.dt=0.1 --out r");
  EXPECT_EQ(o.code, 2);
  EXPECT_TRUE(o.err.starts_with("--set time.dt=0.1: time.dt = 0.1 must be <= ")) << o.err;
  EXPECT_NE(o.err.find("; limited by "), std::string::npos) << o.err;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "r"));

  std::string fixed = kSmall;
  fixed.insert(fixed.find("[time]\n") + 7, "dt = 0.1\n");
  write("fixed.toml", fixed);
  const Outcome f = bedload("check fixed.toml --backend cpu");
  EXPECT_EQ(f.code, 2);
  EXPECT_TRUE(f.err.starts_with("fixed.toml:25: time.dt = 0.1 must be <= ")) << f.err;
}

TEST_F(Program, RefusesASubstepAboveTheLimitOfFreeBodies) {
  write("ball.toml", R"([domain]
min = [-1, -1, -1]
max = [1, 1, 1]
[[shape]]
name = "ball"
kind = "sphere"
centre = [0, 0, 0]
radius = 0.1
[[wall.body]]
name = "ball"
shape = "ball"
[wall.body.free]
density = 1000
[time]
end = 0.1
dt_dem = 0.05
[out]
every = 0.1
)");
  const Outcome o = bedload("run ball.toml --backend cpu --out r");
  EXPECT_EQ(o.code, 2);
  EXPECT_TRUE(o.err.starts_with("ball.toml:16: time.dt_dem = 0.05 must be <= ")) << o.err;
  EXPECT_NE(o.err.find("; limited by body contact"), std::string::npos) << o.err;
  const Outcome check = bedload("check ball.toml --backend cpu --set time.dt_dem=1e-5");
  EXPECT_NE(check.out.find("body contact"), std::string::npos) << check.out;
}

/// With the key that sets the limit: `check` before, the run at its end.
TEST_F(Program, ReportsTheActiveStepLimits) {
  write("dam.toml", kSmall);
  const std::string options =
      " dam.toml --backend cpu --set grain.settle=false --set fluid.mu=1 --set lubrication.forces=all "
      "--set lubrication.least_gap=1e-4 --set time.dt=1e-5 ";
  const Outcome check = bedload("check" + options);
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_NE(check.out.find(" s  (active), set by lubrication.least_gap\n"), check.out.npos) << check.out;
  EXPECT_NE(check.out.find(" substeps per step, limited by lubrication (lubrication.least_gap)\n"),
            check.out.npos)
      << check.out;
  const Outcome run = bedload("run --out out --until 1e-4" + options);
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("step       limited by fixed (time.dt) 100 %\n"), run.out.npos) << run.out;
  EXPECT_NE(run.out.find("substep    limited by lubrication (lubrication.least_gap) 100 %\n"), run.out.npos)
      << run.out;
  const auto summary = nlohmann::json::parse(content_of(dir_ / "out/summary.json"));
  EXPECT_EQ(summary["steps_by_limit"]["fixed"], summary["steps"]);
  EXPECT_EQ(summary["substeps_by_limit"]["lubrication"], summary["substeps"]);
}

/// And the effect of another value of the key.
TEST_F(Program, ReportsTheEffectOfChangingAKey) {
  write("dam.toml", kSmall);
  const std::string options = "check dam.toml --backend cpu --set grain.settle=false --set time.dt=1e-5 ";
  const auto number_before = [](const std::string& text, const std::string& words) {
    const auto at = text.find(words);
    EXPECT_NE(at, text.npos) << words << " in " << text;
    return at == text.npos ? 0 : std::stoi(text.substr(text.rfind(' ', at - 1)));
  };
  const std::string films = "--set fluid.mu=1 --set lubrication.forces=all --set lubrication.least_gap=";
  const std::string wider = " substeps with lubrication.least_gap = 0.001\n";
  EXPECT_NEAR(number_before(bedload(options + films + "1e-4").out, wider),
              number_before(bedload(options + films + "1e-3").out, " substeps per step"), 1);
  const std::string stiff = "--set time.dt=1e-4 --set grain.E=",
                    softer = " substeps with grain.E = 1e+08 Pa\n";
  EXPECT_NEAR(number_before(bedload(options + stiff + "1e9").out, softer),
              number_before(bedload(options + stiff + "1e8").out, " substeps per step"), 1);
  const std::string soft = bedload(options + "--set time.dt=1e-4 --set grain.E=2e6").out;
  EXPECT_EQ(soft.find(" with grain.E = "), soft.npos) << "its bed is as soft as it may be\n" << soft;

  const std::string water = bedload("check dam.toml --backend cpu --set grain.settle=false").out;
  std::smatch counts;
  const std::regex both("steps +about ([0-9]+) of [^\n]*\n +about ([0-9]+) with fluid.c_factor = 5");
  ASSERT_TRUE(std::regex_search(water, counts, both)) << water;
  EXPECT_NEAR(std::stoi(counts[2]), std::stoi(counts[1]) / 2, 1) << water;
}

/// docs/howto/walls.md: a box filled to its lid cavitates.
TEST_F(Program, WarnsOfABoxFilledToItsLid) {
  write("box.toml", R"([domain]
min = [0, 0, 0]
max = [0.06, 0.06, 0.06]
[fluid]
dx = 0.006
[[fluid.fill]]
min = [0, 0, 0]
max = [0.06, 0.06, 0.06]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.06, 0.06, 0.06]
[time]
end = 0.01
[out]
every = 0.01
)");
  const std::string full = "without a free surface: ", cavitates = full + "it cavitates",
                    waves = "waves      ";
  const std::string vortex =
      "--set 'fluid.fill.0.velocity=[\"20*(z-0.03)\", \"0\", \"20*(0.03-x)\"]' --set fluid.vmax=1 ";
  const auto check = [&](const std::string& settings) {
    return bedload("check box.toml --backend cpu " + settings).out;
  };
  EXPECT_NE(check("").find("note       the fluid fills the space between the walls, " + full + "if it moves"),
            std::string::npos);
  EXPECT_EQ(check("").find(waves), std::string::npos);
  EXPECT_NE(check(vortex).find(cavitates), std::string::npos);
  EXPECT_EQ(check(vortex + "--set eos.background=1000").find(full), std::string::npos);
  const std::string open = check(vortex + "--set 'fluid.fill.0.max=[0.06,0.06,0.048]'");
  EXPECT_EQ(open.find(full), std::string::npos) << open;
  EXPECT_NE(open.find(waves), std::string::npos) << open;
  EXPECT_NE(open.find(" with splashing;"), std::string::npos) << open;

  const std::string run = "run box.toml --backend cpu --quiet --overwrite --out out ";
  EXPECT_NE(bedload(run + vortex).err.find("warning: the fluid fills the space"), std::string::npos);
  EXPECT_EQ(bedload(run).err, "");
}

/// What is as it should be is no warning.
TEST_F(Program, NotesBodiesThatStandInAFill) {
  write("dam.toml", kSmall +
                        "[[wall.body]]\nname = \"pier\"\nshape = \"box\"\nmin = [0.02, 0.02, 0]\n"
                        "max = [0.04, 0.04, 0.1]\n");
  const std::string settings = " dam.toml --backend cpu --set grain.settle=false ";
  const std::string note = "note       fluid.fill 1: leaves out wall.body \"pier\"";
  for (const char* command : {"check", "run --out out --until 1e-3"}) {
    const Outcome o = bedload(command + settings);
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find(note), std::string::npos) << o.out;
    EXPECT_EQ((o.out + o.err).find("warning: fluid.fill"), std::string::npos) << o.out << o.err;
  }
  EXPECT_EQ(content_of(dir_ / "out/summary.json").find("leaves out"), std::string::npos);
}

/// Density diffusion is no viscosity.
TEST_F(Program, TellsDensityDiffusionFromViscosity) {
  write("dam.toml", kSmall);
  const std::string out = bedload("check dam.toml --backend cpu").out;
  EXPECT_NE(out.find("m2/s, none of it numerical\ndensity    diffusion of "), out.npos) << out;
  EXPECT_EQ(out.find("drag         inf s"), out.npos) << out;
}

/// What the how-to pages say of resolution, beds, mirrors: a line each, and none where they are kept.
TEST_F(Program, RemarksOnWhatTheDocumentsAdvise) {
  write("dam.toml", kSmall);
  const auto said = [&](const std::string& about, const std::string& settings) {
    const Outcome o = bedload("check dam.toml --backend cpu --set grain.settle=false " + settings);
    EXPECT_EQ(o.code, 0) << o.err;
    return o.out.find("\n" + about) != o.out.npos;
  };
  EXPECT_TRUE(said("resolution the fluid is 5 particles across along ", ""));
  EXPECT_FALSE(said("resolution ", "--set fluid.dx=0.005"));
  EXPECT_TRUE(said("kernel     kernel radius 2.4 fluid.dx", "--set fluid.h_over_dx=1.2"));
  EXPECT_FALSE(said("kernel     ", ""));
  EXPECT_TRUE(
      said("bed        on frozen walls the buoyancy of a thin bed is 13 %", "--set wall.type=frozen"));
  EXPECT_FALSE(said("bed        ", ""));
  EXPECT_TRUE(said("sizes      the largest grain is 6 times",
                   "--set 'grain.fill.0.sizes=[{d=0.001},{d=0.006}]' --set grain.fill.0.count=20 "
                   "--set couple.own_hc=false"));
  EXPECT_FALSE(said("sizes      ", ""));
  EXPECT_TRUE(said("coupling   two_way, di_felice, h_c 0.015 m to 0.02 m, each grain its own",
                   "--set 'grain.fill.0.sizes=[{d=0.002},{d=0.01}]' --set grain.fill.0.count=10"));
  EXPECT_TRUE(said("mirror     fluid rests on the reflecting side z- of the domain",
                   "--set 'domain.reflect.slip=[\"z-\"]'"));
  EXPECT_FALSE(said("mirror     ", "--set 'domain.reflect.slip=[\"z+\"]'"));
  EXPECT_FALSE(said("viscometer ", "")) << "nobody would measure there";
}

/// Once, when it happens, with what to do; in the summary, too.
TEST_F(Program, WarnsOfFluidFasterThanItsSoundAllows) {
  write("dam.toml", kSmall);
  const std::string run =
      "run dam.toml --backend cpu --quiet --overwrite --out out --until 0.01 --set grain.settle=false ";
  const std::string fast = "warning: fluid flows at up to ";
  const Outcome pushed = bedload(run + "--set 'drive.f=[4e6, 0, 0]' --set run.max_lost=1");
  const auto at = pushed.err.find(fast);
  ASSERT_NE(at, std::string::npos) << pushed.err;
  EXPECT_EQ(pushed.err.find(fast, at + 1), std::string::npos) << pushed.err;
  EXPECT_NE(pushed.err.find("times fluid.vmax = 0.99 m/s (Mach "), std::string::npos) << pushed.err;
  EXPECT_NE(pushed.err.find("; increase fluid.vmax to "), std::string::npos) << pushed.err;
  EXPECT_NE(content_of(dir_ / "out/summary.json").find("fluid flows at up to "), std::string::npos);
  EXPECT_EQ(bedload(run).err.find(fast), std::string::npos);
}

TEST_F(Program, RunsACaseAndLeavesItsFiles) {
  write("dam.toml", kSmall);
  const Outcome o = bedload("run dam.toml --backend cpu --until 0.005");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("completed"), std::string::npos);
  for (const char* file :
       {"case.resolved.toml", "summary.json", "diagnostics.csv", "fluid.vtkhdf", "grains.vtkhdf"})
    EXPECT_TRUE(std::filesystem::exists(dir_ / "results/dam" / file)) << file;

  const Outcome info = bedload("info results/dam/summary.json");
  EXPECT_EQ(info.code, 0);
  EXPECT_NE(info.out.find("completed"), std::string::npos);
  EXPECT_EQ(bedload("info results/dam/fluid.vtkhdf").code, 0);
  const Outcome checkpoint = bedload("info results/dam/checkpoints/*.h5");
  EXPECT_EQ(checkpoint.code, 0) << checkpoint.err;
  EXPECT_NE(checkpoint.out.find("precision = mixed"), std::string::npos) << checkpoint.out;
}

TEST_F(Program, RunsWithAndWithoutAvx2) {
  write("dam.toml", kSmall);
  const std::string run =
      "run dam.toml --backend cpu --quiet --until 0.002 --set grain.settle=false --set run.simd=";
  ASSERT_EQ(bedload(run + "baseline --out baseline").code, 0);
  ASSERT_EQ(bedload(run + "auto --out auto").code, 0);
  const auto summary = [&](const char* of) {
    return nlohmann::json::parse(content_of(dir_ / of / "summary.json"));
  };
  const auto has_avx2 = [&](const char* of) {
    return summary(of)["device"]["name"].get<std::string>().find("AVX2") != std::string::npos;
  };
  EXPECT_FALSE(has_avx2("baseline"));
  const Outcome o = bedload(run + "avx2 --out avx2");
  if (o.code) {  // no such processor, or built without
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("--set run.simd=avx2: run.simd = avx2: this pro"), std::string::npos) << o.err;
    EXPECT_FALSE(has_avx2("auto"));
    return;
  }
  EXPECT_TRUE(has_avx2("auto"));
  EXPECT_EQ(summary("auto")["metrics"], summary("avx2")["metrics"]);
  for (const char* what : {"fluid_potential_energy", "fluid_kinetic_energy", "grain_kinetic_energy"}) {
    const double value = summary("baseline")["metrics"][what]["value"];
    EXPECT_NEAR(summary("avx2")["metrics"][what]["value"], value, 1e-4 * std::abs(value)) << what;
  }
}

TEST_F(Program, KeepsARunFromBeingWrittenOver) {
  write("dam.toml", kSmall);
  const std::string run = "run dam.toml --backend cpu --quiet --until 0.002 --out r";
  ASSERT_EQ(bedload(run).code, 0);
  const Outcome again = bedload(run);
  EXPECT_EQ(again.code, 2);
  EXPECT_TRUE(again.err.starts_with("r: already holds a run")) << again.err;
  for (const char* remedy : {"--restart", "--overwrite", "--out"})
    EXPECT_NE(again.err.find(remedy), again.err.npos) << again.err;
  EXPECT_EQ(bedload(run + " --overwrite").code, 0);
}

/// A range, for costs that the first steps do not show.
TEST_F(Program, ReportsHowMuchLongerARunMayTake) {
  write("dam.toml", kSmall);
  const auto cause = [&](const std::string& settings) -> std::string {
    const std::string out = bedload("check dam.toml --backend cpu " + settings).out;
    std::smatch found;
    const std::regex line("run time +about [^\n,]+(, up to [^\n]* with ([a-z ]+))?; extrapolated [^\n]*\n");
    return std::regex_search(out, found, line) ? found[2].str() : out;
  };
  EXPECT_EQ(cause(""), "splashing and a settled bed");  // which is not cached yet
  EXPECT_EQ(cause("--set grain.settle=false"), "splashing");
  EXPECT_EQ(cause("--set grain.settle=false --set fluid.mu=1"), "");  // oil
  EXPECT_EQ(cause("--set grain.settle=false --set 'gravity=[0,0,0]' --set fluid.vmax=1"), "");
}

TEST_F(Program, TakesASettledBedFromItsCache) {
  write("dam.toml", kSmall);
  const Outcome first = bedload("run dam.toml --backend cpu --until 0.002 --out a");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("settled    in "), std::string::npos) << first.out;
  const Outcome second = bedload("run dam.toml --backend cpu --until 0.002 --out b --set fluid.mu=0.002");
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_NE(second.out.find("settled    from cache, cache/bedload/settled-"), std::string::npos)
      << second.out;
  const Outcome third = bedload("run dam.toml --backend cpu --until 0.002 --out c --set grain.mu=0.5");
  EXPECT_NE(third.out.find("settled    in "), std::string::npos) << third.out;
  const Outcome fourth =
      bedload("run dam.toml --backend cpu --until 0.002 --out d --set grain.settle_mu=0.5");
  ASSERT_EQ(fourth.code, 0) << fourth.err;
  EXPECT_NE(fourth.out.find("settled    from cache, cache/bedload/settled-"), std::string::npos)
      << fourth.out;
}

TEST_F(Program, AKeptBedGivesTheSameRunAsAFreshOne) {
  write("dam.toml", kSmall);
  for (const char* folder : {"fresh", "kept"}) {
    const Outcome o =
        bedload(std::string("run dam.toml --backend cpu --quiet --until 0.002 --out ") + folder);
    ASSERT_EQ(o.code, 0) << o.err;
  }
  expect_same_checkpoints("fresh", "kept");
}

/// Settings of batch systems bind threads to cores. The threads of a run are spread over all those that the
/// process was given; what writes its files and serves its page takes any of them.
TEST_F(Program, ThreadsAreSpreadOverTheCoresThatABatchSystemGives) {
  cpu_set_t given;
  ASSERT_EQ(sched_getaffinity(0, sizeof given, &given), 0);
  std::vector<std::string> cores;
  for (int core = 0; core < CPU_SETSIZE; ++core)
    if (CPU_ISSET(core, &given)) cores.push_back(std::to_string(core));
  if (cores.size() < 2) GTEST_SKIP() << "one core";
  const std::string first = cores[0], second = cores[1], pair = first + "," + second,
                    range = std::stoi(second) == std::stoi(first) + 1 ? first + "-" + second : pair;
  write("dam.toml", kSmall);
  int runs = 0;
  /// On which cores each thread of a run may be, in a process that was given `cores`.
  const auto threads = [&](const std::string& settings, const std::string& cores) {
    const std::string out = "out_" + std::to_string(runs++);
    const Outcome o =
        shell("sh -c 'env -u OMP_WAIT_POLICY " + settings + " taskset -c " + cores +
              " " BL_PROGRAM " run dam.toml --backend cpu --quiet --live 0 --until 1000 --out " + out +
              " & run=$!; until [ -s " + out +
              "/diagnostics.csv ]; do sleep 0.05; done; grep -h Cpus_allowed_list "
              "/proc/$run/task/*/status >threads.txt; kill -TERM $run; wait $run'");
    EXPECT_EQ(o.code, 130) << settings << ": " << o.err;
    std::multiset<std::string> all;
    std::ifstream in(dir_ / "threads.txt");
    for (std::string key, list; in >> key >> list;) all.insert(list);
    EXPECT_GT(all.size(), 3u) << settings;
    return all;
  };
  for (const std::string settings :
       {"OMP_PROC_BIND=true", "OMP_PROC_BIND=close", "OMP_PROC_BIND=spread", "OMP_PLACES=threads",
        "OMP_PROC_BIND=spread OMP_PLACES=threads OMP_NUM_THREADS=2"}) {
    const auto all = threads(settings, pair);
    EXPECT_EQ(all.count(first), 1u) << settings;
    EXPECT_EQ(all.count(second), 1u) << settings;
    EXPECT_EQ(all.count(range), all.size() - 2) << settings;
    EXPECT_EQ(threads(settings, second).count(second), all.size()) << settings << " on one core";
  }
  const std::string listed = "GOMP_CPU_AFFINITY=\"" + second + " " + first + "\"";
  EXPECT_EQ(threads(listed, pair).count(range), threads("", pair).size() - 2) << listed;
  for (const std::string settings : {"", "OMP_NUM_THREADS=2", "OMP_PROC_BIND=false OMP_PLACES=threads"}) {
    const auto all = threads(settings, pair);
    EXPECT_EQ(all.count(range), all.size()) << settings;
  }
  const auto all = threads("OMP_PLACES=cores", pair);  // one place, if both are threads of one core
  EXPECT_TRUE(all.count(range) == all.size() || (all.count(first) == 1 && all.count(second) == 1));
}

TEST_F(Program, TheNumberOfThreadsChangesNothing) {
  write("dam.toml", kSmall);
  for (const char* threads : {"1", "2", "7"}) {
    const Outcome o = bedload(std::string("run dam.toml --backend cpu --quiet --threads ") + threads +
                              " --out threads" + threads);
    ASSERT_EQ(o.code, 0) << o.err;
  }
  expect_same_checkpoints("threads1", "threads2");
  expect_same_checkpoints("threads1", "threads7");
}

TEST_F(Program, ARestartedRunEqualsAnUnbrokenOne) {
  write("dam.toml", kSmall);
  const std::string run = "run dam.toml --backend cpu --quiet ";
  ASSERT_EQ(bedload(run + "--out whole").code, 0);
  ASSERT_EQ(bedload(run + "--out parts --until 0.01").code, 0);
  std::filesystem::path middle;
  for (const auto& entry : std::filesystem::directory_iterator(dir_ / "parts/checkpoints"))
    middle = entry.path();
  const Outcome o = bedload(run + "--out parts --restart " + middle.string());
  ASSERT_EQ(o.code, 0) << o.err;

  expect_same_checkpoints("whole", "parts");
}

TEST_F(Program, TwoRunsDoNotShareAFolder) {
  write("dam.toml", kSmall);
  const FolderLock lock(dir_ / "out");
  for (const char* how : {"", " --overwrite"}) {
    const Outcome o = bedload(std::string("run dam.toml --backend cpu --quiet --out out") + how);
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("out: in use by process " + std::to_string(::getpid()) + " on "), o.err.npos)
        << o.err;
    EXPECT_NE(o.err.find("--out"), o.err.npos) << o.err;
  }
  EXPECT_FALSE(std::filesystem::exists(dir_ / "out/case.resolved.toml")) << "nothing has been written";
}

TEST_F(Program, GoesOnOnlyAsItBegan) {
  write("dam.toml", kSmall);
  const std::string run = "run dam.toml --backend cpu --quiet --out out ";
  EXPECT_TRUE(bedload(run + "--restart latest").err.starts_with("out: has no checkpoint"));
  ASSERT_EQ(bedload(run + "--until 0.01").code, 0);
  const Outcome other = bedload(run + "--restart latest --set fluid.mu=0.5 --set out.every=0.02");
  EXPECT_EQ(other.code, 2);
  for (const char* part : {"fluid.mu = 0.5 (0.001 then)", "--allow-changes"})
    EXPECT_NE(other.err.find(part), other.err.npos) << other.err;
  EXPECT_EQ(other.err.find("out.every"), other.err.npos) << "which changes no result";
  const Outcome early = bedload(run + "--restart latest --until 0.005");
  EXPECT_EQ(early.code, 2);
  EXPECT_NE(early.err.find("--until = 0.005 s is before the time of the checkpoint"), early.err.npos)
      << early.err;
  const Outcome told = bedload(run + "--restart latest --set fluid.mu=0.5 --allow-changes");
  EXPECT_EQ(told.code, 0);
  EXPECT_NE(told.err.find("warning: modified since the checkpoint: fluid.mu = 0.5"), told.err.npos)
      << told.err;
}

/// With a motion of any kind that would have taken it elsewhere by now.
TEST_F(Program, TellsHowFarWallsJumpAtARestart) {
  const std::string piston = R"(title = "Piston"
gravity = [0, 0, 0]
[domain]
min = [-0.1, -0.1, -0.1]
max = [0.3, 0.1, 0.1]
[grain]
d = 0.01
[[grain.fill]]
positions = [[0.2, 0, 0]]
[time]
end = 0.05
[out]
every = 0.05
[checkpoint]
every = 0.05
[[wall.body]]
name = "piston"
shape = "box"
min = [-0.05, -0.05, -0.05]
max = [0.0, 0.05, 0.05]
[wall.body.motion]
)";
  write("piston.toml", piston + "kind = \"velocity\"\nvelocity = [0.1, 0, 0]\n");
  const std::string run = " --backend cpu --quiet --out out ", again = run + "--restart latest --until 0.06 ";
  ASSERT_EQ(bedload("run piston.toml" + run).code, 0);
  const auto jumps = [&](const std::string& motion, const std::string& metres) {
    write("other.toml", piston + motion);
    const std::string text = "wall.body \"piston\" jumps " + metres;
    const Outcome refused = bedload("run other.toml" + again);
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find(text), refused.err.npos) << refused.err;
  };
  jumps("kind = \"velocity\"\nvelocity = [0.02, 0, 0]\n", "0.004");
  jumps("kind = \"formula\"\ndisplacement = [\"0\", \"0.4*t\", \"0\"]\n", "0.02");
  jumps("kind = \"rotation\"\nrate = 62.8318531\naxis = [0, 0, 1]\ncentre = [-0.025, 0, 0]\n", "0.11");
  jumps("kind = \"fixed\"\n", "0.005");
  write("other.toml", piston + "kind = \"velocity\"\nvelocity = [0.02, 0, 0]\n");
  const Outcome allowed = bedload("run other.toml" + again + "--allow-changes");
  EXPECT_EQ(allowed.code, 0) << allowed.err;
  EXPECT_NE(allowed.err.find("jumps 0.004"), allowed.err.npos) << allowed.err;
}

TEST_F(Program, BodiesThatHaveBeenRemovedLeaveTheFrames) {
  const std::string gate =
      small_dam() +
      "[time]\nend = 0.02\n[out]\nevery = 0.01\n[[wall.body]]\nname = \"gate\"\nshape = \"box\"\n"
      "min = [0.02, 0.02, 0.08]\nmax = [0.04, 0.04, 0.1]\n[wall.body.motion]\nkind = \"velocity\"\n"
      "velocity = [0, 0, 1]\nremove_when_clear = ";
  const auto points = [&](const std::string& removed) {
    write("dam.toml", gate + removed);
    const Outcome ran = bedload("run dam.toml --backend cpu --quiet --overwrite --out out");
    EXPECT_EQ(ran.code, 0) << ran.err;
    const std::string text = bedload("info out/walls.vtkhdf").out;
    const auto at = text.find("float32", text.find("  Points ")) + 7;
    std::string number = text.substr(at, text.find(" x 3", at) - at);
    std::erase(number, ' ');
    return std::stoi(number);
  };
  const int all = points("false");
  EXPECT_EQ(content_of(dir_ / "out/bodies/gate.csv").find("present"), std::string::npos);
  EXPECT_LT(points("true"), all);
  const std::string table = content_of(dir_ / "out/bodies/gate.csv");
  EXPECT_NE(table.find(",present [-]\n"), table.npos) << table;
  EXPECT_NE(table.find(",1\n"), table.npos) << "at first";
  EXPECT_TRUE(table.ends_with(",0\n")) << table;
}

TEST_F(Program, CheckTellsTheShearThatAnArrangementOfParticlesResists) {
  write("dam.toml", kSmall);
  const std::string check = "check dam.toml --backend cpu ";
  const auto told = [&](const std::string& more, const std::string& what) {
    const Outcome out = bedload(check + more);
    EXPECT_EQ(out.code, 0) << out.err;
    EXPECT_NE(out.out.find(what), out.out.npos) << out.out;
  };
  told("--set fluid.mu=1", "pressure.linear_exact removes it (cell Reynolds number ");
  told("--set fluid.mu=1e-3", "not removed: particles do not shift: there are grains, and the fastest flow");
  told("--set fluid.mu=1e-3",
       "shifting   none: there are grains, and the fastest flow has a cell Reynolds number of");
  told("--set fluid.mu=1 --set pressure.linear_exact=false", "not removed: pressure.linear_exact is false");
}

TEST_F(Program, TellsWhatHasLeftTheDomain) {
  write("dam.toml", kSmall);
  // no floor, an open side
  const std::string run =
      "run dam.toml --backend cpu --out out --overwrite --until 0.2 --set grain.settle=false "
      "--set 'wall.body.0.faces=[\"x-\", \"y-\", \"y+\"]'";
  const Outcome lost = bedload(run);
  EXPECT_EQ(lost.code, 4) << lost.err;
  EXPECT_NE(lost.err.find(" of 40 grains, "), lost.err.npos) << lost.err;
  EXPECT_TRUE(std::regex_search(
      lost.err,
      std::regex("kg of fluid, [0-9.]+ %, left the domain where there is no outlet: [^;\n]*[0-9]+ "
                 "particles through z- from t = 0\\.[01][0-9]* s[^;\n]*; run.max_lost = 0.001 allows "
                 "0.1 %")))
      << lost.err;
  EXPECT_TRUE(std::regex_search(lost.err, std::regex("of 40 grains, [^;\n]*[0-9]+ through z- from t = 0\\.")))
      << lost.err;
  const auto summary = nlohmann::json::parse(content_of(dir_ / "out/summary.json"));
  double fluid = 0, grains = 0;
  for (const auto& side : summary["lost"]["fluid"]) fluid += side["mass"]["value"].get<double>();
  for (const auto& side : summary["lost"]["grains"]) grains += side["count"].get<double>();
  const double expected = summary["metrics"]["lost_fluid_mass"]["value"];
  EXPECT_GT(fluid, 0);
  EXPECT_NEAR(fluid, expected, 1e-9 * expected);
  EXPECT_EQ(grains, summary["metrics"]["grains_outside"]["value"].get<double>());
  const double first = summary["lost"]["fluid"]["z-"]["first"]["value"];
  EXPECT_GT(first, 0);
  EXPECT_LT(first, 0.2);
  const Outcome allowed = bedload(run + " --set run.max_lost=1");
  EXPECT_EQ(allowed.code, 0) << allowed.err;
  EXPECT_NE(allowed.out.find("lost       "), allowed.out.npos) << allowed.out;
  EXPECT_NE(allowed.out.find(" particles through z- from t = "), allowed.out.npos) << allowed.out;
}

TEST_F(Program, TellsOfFreeBodiesThatHaveLeftTheDomain) {
  const auto ball = [](const std::string& name, const std::string& place) {
    return "[[shape]]\nname = \"" + name + "\"\nkind = \"sphere\"\ncentre = " + place +
           "\nradius = 0.01\n[[wall.body]]\nname = \"" + name + "\"\nshape = \"" + name +
           "\"\n[wall.body.free]\ndensity = 1000\n";
  };
  write("balls.toml", "[domain]\nmin = [0, 0, 0]\nmax = [0.2, 0.1, 0.3]\n" +
                          ball("low", "[0.05, 0.05, 0.05]") + ball("high", "[0.15, 0.05, 0.25]") +
                          "[time]\nend = 0.15\n[out]\nevery = 0.05\n");
  const std::string run = "run balls.toml --backend cpu --out out --overwrite ";
  EXPECT_EQ(bedload(run + "--until 0.09").code, 0) << "it has sunk by 4 cm of 5";
  const Outcome lost = bedload(run);
  EXPECT_EQ(lost.code, 4) << lost.err;
  EXPECT_NE(lost.err.find(
                "1 of 2 free bodies, 50 %, left the domain where there is no outlet; run.max_lost = 0.001"),
            lost.err.npos)
      << lost.err;
  const Outcome allowed = bedload(run + "--set run.max_lost=1");
  EXPECT_EQ(allowed.code, 0) << allowed.err;
  EXPECT_NE(allowed.out.find("lost       1 of 2 free bodies"), allowed.out.npos) << allowed.out;
}

/// Each interval once, with how much is left out, by `check` and by the run.
TEST_F(Program, TellsOfIntervalsBelowTheTimeStep) {
  write("dam.toml", kSmall + "[[probe]]\nname = \"front\"\ntype = \"front\"\nevery = 1e-6\n");
  const std::string frames = "out.every = 2e-06 s is below the time step, ";
  const auto count = [](const std::string& text, const std::string& part) {
    int n = 0;
    for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
    return n;
  };
  const std::string options =
      " dam.toml --backend cpu --set grain.settle=false --set out.diagnostics_every=0.01 ";
  for (const bool both : {false, true}) {
    const std::string set = both ? "--set out.every=2e-6 --set checkpoint.every=1e-6 " : "";
    const Outcome check = bedload("check" + options + set);
    EXPECT_EQ(check.code, 0) << check.err;
    const Outcome run = bedload("run --quiet --overwrite --out out --until 0.002" + options + set);
    EXPECT_EQ(run.code, 0) << run.err;
    for (const std::string& text : {check.out, run.err, content_of(dir_ / "out/summary.json")}) {
      EXPECT_EQ(count(text, "below the time step"), both ? 2 : 1) << text;
      EXPECT_EQ(count(text, both ? "checkpoint.every = 1e-06 s" : "= 1e-06 s is below"), 1) << text;
      EXPECT_EQ(count(text, frames), both) << text;
      EXPECT_EQ(count(text, "times less often"), both ? 2 : 1) << text;
    }
  }
}

TEST_F(Program, WarnsOfWallsAndRefusesProbesOutsideTheDomain) {
  write("dam.toml", kSmall);
  const Outcome low = bedload("check dam.toml --set 'wall.body.0.min=[0, 0, -0.05]'");
  EXPECT_EQ(low.code, 0) << low.err;
  EXPECT_NE(low.out.find("face z- of wall.body \"tank\" lies 0.05 m outside the domain"), low.out.npos)
      << low.out;
  write("probe.toml", kSmall + "[[probe]]\nname = \"far\"\ntype = \"point\"\nat = [0.5, 0.03, 0.02]\n");
  const Outcome far = bedload("check probe.toml");
  EXPECT_EQ(far.code, 2);
  EXPECT_NE(far.err.find("probe.at = [0.5, 0.03, 0.02]"), far.err.npos) << far.err;
  write("floor.toml", kSmall +
                          "[[wall.body]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0, 0, -0.01]\n"
                          "normal = [0, 0, 1]\n");
  const Outcome floor = bedload("check floor.toml");
  EXPECT_NE(floor.out.find("wall.body \"floor\" lies 0.01 m outside the domain"), floor.out.npos)
      << floor.out;
}

TEST_F(Program, RefusesWhatIsTooFineForTheMemoryBeforeLayingIt) {
  write("dam.toml", kSmall);
  const Outcome o = bedload("check dam.toml --backend cpu --set grain.resolve=none --set fluid.dx=5e-5");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("fluid.dx = 5e-05 gives 1.2e+09 fluid particles, which need "), o.err.npos) << o.err;
  EXPECT_NE(o.err.find(" free; use at least "), o.err.npos) << o.err;
}

/// From areas, volumes and counts: what the case would hold, and how large its meshes are, in no time.
TEST_F(Program, RefusesTooManyOfAnyKindBeforePlacingThem) {
  std::string stl = "solid cube\n";  // of 60, in millimetres
  const int corners[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                              {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& triangle : corners) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const int k : triangle)
      stl += fmt::format("vertex {} {} {}\n", k & 1 ? 60 : 0, k & 2 ? 60 : 0, k & 4 ? 60 : 0);
    stl += "endloop\nendfacet\n";
  }
  write("cube.stl", stl + "endsolid cube\n");
  const auto body = [](const std::string& rest) { return "[[wall.body]]\nname = \"much\"\n" + rest; };
  struct Much {
    std::string more, message, set;
  };
  const Much cases[]{
      {"[[shape]]\nname = \"cube\"\nkind = \"mesh\"\nfile = \"cube.stl\"\n" + body("shape = \"cube\"\n"),
       "wall.body \"much\", 60 x 60 x 60 m large, with particles 0.002 m apart gives ", "fluid.dx=0.002"},
      {body("shape = \"tank\"\nmin = [0, 0, 0]\nmax = [60, 60, 20]\n"),
       "wall.body \"much\", 60 x 60 x 20 m large, with particles 0.002 m apart gives ", "fluid.dx=0.002"},
      {body("shape = \"box\"\nmin = [0.06, 0.01, 0.01]\nmax = [0.09, 0.05, 0.05]\n[wall.body.free]\n"
            "density = 500\ncontact_spacing = 1e-5\n"),
       "contact_spacing = 1e-05 must be at least about 8.9e-05 m: balls so far apart make ", "grain.d=0.005"},
  };
  for (const Much& much : cases) {
    write("dam.toml", kSmall + much.more);
    const auto from = std::chrono::steady_clock::now();
    const Outcome o = shell("bash -c 'ulimit -v 4000000; " BL_PROGRAM " check dam.toml --backend cpu --set " +
                            much.set + "'");
    EXPECT_LT(std::chrono::steady_clock::now() - from, std::chrono::seconds(20));
    EXPECT_EQ(o.code, 2) << much.message;
    EXPECT_NE(o.err.find(much.message), o.err.npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  }
  write("dam.toml", kSmall + cases[0].more);
  const Outcome o = bedload("check dam.toml --backend cpu --set fluid.dx=0.002");
  EXPECT_NE(o.out.find("mesh       cube: 60 x 60 x 60 m\n"), o.out.npos) << o.out;
  EXPECT_NE(o.err.find("does it need another scale?"), o.err.npos) << o.err;
}

/// Whatever is repeated in a message, and however many tables a key opens.
TEST_F(Program, LongInputHasAShortMessage) {
  std::string key = "a";
  for (int n = 0; n < 30000; ++n) key += ".a";
  for (const std::string& more :
       {key + " = 1\n", "[" + key + "]\n", "x = { " + key + " = 1 }\n",
        "title = \"" + std::string(50000, 'x') + "\"\ntitle = 1\n",
        "[wall]\ntype = \"" + std::string(50000, 'x') + "\"\n", std::string(50000, 'x') + " = 1\n"}) {
    write("dam.toml", more.starts_with("[wall]") ? kSmall + more : more + kSmall);
    const Outcome o = bedload("check dam.toml --backend cpu");
    EXPECT_EQ(o.code, 2) << more.substr(0, 20);
    EXPECT_LT(o.err.size(), 5000u);
    EXPECT_TRUE(o.err.starts_with("dam.toml:")) << o.err;
  }
  write("dam.toml", kSmall);
  const Outcome o = bedload("check dam.toml --backend cpu --set " + key + "=1");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("holds a key of more than 1000 parts"), o.err.npos) << o.err;
}

/// Errors that come up as particles are placed and meshes are read name their place as those of the reader
/// do.
TEST_F(Program, NamesThePlaceOfWhatCannotBeInitialised) {
  const auto refused = [&](const std::string& more, const std::string& message, const std::string& set = "") {
    write("dam.toml", kSmall + more);  // whose next line is the 28th
    for (const std::string command : {"check", "run"}) {
      const Outcome o = bedload(command + " dam.toml --backend cpu" + set);
      EXPECT_EQ(o.code, 2) << command;
      EXPECT_TRUE(o.err.starts_with(message)) << o.err;
      EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    }
  };
  const std::string fill = "[[fluid.fill]]\n", shape = "[[shape]]\nname = \"part\"\n";
  refused("[[wall.body]]\nname = \"side\"\nshape = \"plane\"\npoint = [0.02, 0, 0]\nnormal = [1, 0, 0]\n",
          "dam.toml:7: fluid.fill: 60 fluid particles, the first at (0.005, 0.005, 0.005) m, lie inside "
          "wall.body \"side\"");
  refused(fill + "min = [0.04, 0, 0]\nmax = [0.06, 0.06, 0.05]\n",
          "dam.toml:28: fluid.fill 2 overlaps fluid.fill 1\n");
  refused(
      fill + "min = [0.06, 0, 0]\nmax = [0.08, 0.06, 0.05]\nvelocity = [\"1/(x - 0.065)\", 0, 0]\n",
      "dam.toml:31: fluid.fill.velocity = \"1/(x - 0.065)\" along x must be finite; it is not at (0.065, ");
  refused(fill + "shape = \"part\"\n" + shape + "kind = \"difference\"\nof = [\"all\", \"all\"]\n",
          "dam.toml:30: shape \"part\": of = \"all\" must name a shape listed before it");
  refused(shape +
              "kind = \"sphere\"\ncentre = [0.08, 0.03, 0.05]\nradius = 0.01\n[[shape]]\nname = \"none\"\n"
              "kind = \"difference\"\nof = [\"part\", \"part\"]\n" +
              fill + "shape = \"none\"\n",
          "dam.toml:38: fluid.fill 2: shape \"none\" has no space for a particle of 0.01 m\n");
  refused("", "dam.toml:20: grain.fill 1: 800 grains of 0.005 m need at least ",
          " --set grain.fill.0.count=800");
  const std::string mesh = (dir_ / "part.stl").string();
  refused(shape + "kind = \"mesh\"\nfile = \"part.stl\"\n",
          "dam.toml:31: shape \"part\": " + mesh + ": cannot read: no such file\n");
  const std::string hopper = content_of(BL_SOURCE_DIR "/cases/hopper/hopper.stl");
  write("part.stl", hopper.substr(0, hopper.size() / 2));
  refused(shape + "kind = \"mesh\"\nfile = \"part.stl\"\n", "dam.toml:31: shape \"part\": " + mesh + ": ");
}

TEST_F(Program, TellsHowLargeMeshesAre) {
  const std::string hopper = std::string(BL_SOURCE_DIR) + "/cases/hopper/hopper.stl";
  std::filesystem::copy_file(hopper, dir_ / "hopper.stl");
  write("dam.toml", kSmall + "[[shape]]\nname = \"hopper\"\nkind = \"mesh\"\nfile = \"hopper.stl\"\n");
  const Outcome right = bedload("check dam.toml --backend cpu");
  EXPECT_NE(right.out.find("mesh       hopper: 0.056 x 0.056 x 0.08 m\n"), right.out.npos) << right.out;
  EXPECT_EQ(right.out.find("does it need another scale?"), right.out.npos);
  const Outcome large = bedload("check dam.toml --backend cpu --set shape.0.scale=1000");
  EXPECT_EQ(large.code, 0);
  EXPECT_NE(large.out.find(
                "shape \"hopper\": its mesh is 56 x 56 x 80 m large, the domain 0.1 x 0.06 x 0.12 m; does "
                "it need another scale?"),
            large.out.npos)
      << large.out;
  const Outcome wall = bedload(
      "check dam.toml --backend cpu --set shape.0.scale=1e6 --set 'wall.body=[{name=\"h\", "
      "shape=\"hopper\"}]'");
  EXPECT_EQ(wall.code, 2);
  EXPECT_NE(
      wall.err.find("must be smaller; at 5.6e+04 x 5.6e+04 x 8e+04 m a layer of wall particles 0.01 m apart"),
      wall.err.npos)
      << wall.err;
}

TEST_F(Program, WarnsOfGrainsThatFallIntoTheFluid) {
  write("dam.toml", kSmall);
  const auto warned = [&](const std::string& settings) {
    return bedload("check dam.toml --backend cpu " + settings).out.find("grains that fall ") !=
           std::string::npos;
  };
  const std::string above =
      "--set 'grain.fill.0.min=[0, 0, 0.06]' --set 'grain.fill.0.max=[0.05, 0.06, 0.09]'";
  EXPECT_FALSE(warned(above));  // they settle first
  EXPECT_TRUE(warned(above + " --set grain.settle=false --set grain.settle_time=1"));
  EXPECT_FALSE(warned("--set grain.settle=false"));
}

TEST_F(Program, ListsASection) {
  const Outcome o = bedload("list couple");
  EXPECT_EQ(o.code, 0);
  EXPECT_NE(o.out.find("couple.hc"), o.out.npos);
  EXPECT_EQ(o.out.find("\nfluid.dx"), o.out.npos);
}

TEST_F(Program, OneSentenceForWhatTheSystemRefuses) {
  write("dam.toml", kSmall);
  const auto refused = [&](const Outcome& o, const std::string& sentence) {
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find(sentence), o.err.npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  };
  refused(bedload("run dam.toml --out " + std::string(300, 'x')), "File name too long");
  refused(bedload("run dam.toml --until nan"), "command line: --until must be a finite time in s");
  for (const char* threads : {"0", "100000", "-1"})
    refused(bedload(std::string("run dam.toml --threads ") + threads), "not in range 1 to 1024");
  refused(shell("sh -c 'mkdir gone && cd gone && rmdir ../gone && " BL_PROGRAM " run ../dam.toml --out q'"),
          "cannot write results there: No such file or directory");
  refused(shell("sh -c '" BL_PROGRAM " list > /dev/full'"), "No space left on device");
  refused(bedload("check dam.toml --set 'fluid.fill.0.velocity=[\"0,05*x\", \"0\", \"0\"]'"),
          "it makes 2 values; is a decimal comma meant as a point?");
  refused(bedload("check dam.toml --set 'fluid.fill.0.velocity=[\"x=3\", \"0\", \"0\"]'"),
          "= assigns; == compares");
  write("deep.json", std::string(100000, '[') + std::string(100000, ']'));
  refused(bedload("info deep.json"), "deep.json: not a checkpoint");
  write("odd.json", R"({"a": {"value": 1, "unit": 3}})");
  EXPECT_EQ(bedload("info odd.json").code, 0);
}

TEST_F(Program, ARestartNeedsNoFileOfInitialParticles) {
  for (const bool sizes : {true, false}) expect_restart_without_file(sizes);
}

TEST_F(Program, TheBedFollowsTheContentsOfItsFile) {
  std::string text = kSmall;
  const std::string box = "min = [0, 0, 0]\nmax = [0.05, 0.06, 0.03]\ncount = 40\n";
  text.replace(text.find(box), box.size(), "file = \"grains.csv\"\n");
  write("dam.toml", text);
  const auto run = [&](const std::string& table, const std::string& out) {
    write("grains.csv", table);
    const Outcome o = bedload("run dam.toml --backend cpu --until 0.001 --out " + out);
    EXPECT_EQ(o.code, 0) << o.err;
    return o.out.find("settled    from cache, ") != std::string::npos;
  };
  const std::string three = "x,y,z\n0.01,0.01,0.01\n0.03,0.01,0.02\n0.03,0.01,0.01\n";
  const std::string moved = "x,y,z\n0.01,0.01,0.01\n0.03,0.01,0.02\n0.02,0.01,0.015\n";
  EXPECT_FALSE(run(three, "a"));
  EXPECT_TRUE(run(three, "b"));
  EXPECT_FALSE(run(moved, "c"));  // within the same box
}

TEST_F(Program, GoesOnFromTheFramesOfAFormerRun) {
  write("dam.toml", kSmall);
  ASSERT_EQ(bedload("run dam.toml --backend cpu --quiet --out former").code, 0);
  std::string text = kSmall;
  const std::string box = "min = [0, 0, 0]\nmax = [0.05, 0.06, 0.03]\ncount = 40\n",
                    block = "min = [0, 0, 0]\nmax = [0.05, 0.06, 0.05]\n[[wall";
  text.replace(text.find(box), box.size(), "file = \"former/grains.vtkhdf\"\n");
  text.replace(text.find(block), block.size(), "file = \"former/fluid.vtkhdf\"\nstep = 1\n[[wall");
  text.replace(text.find("settle = true\nsettle_time = 0.05\n"), 33, "");
  write("again.toml", text);
  const Outcome o = bedload("run again.toml --backend cpu --out again");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("fluid 150, walls "), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("grains 40"), std::string::npos) << o.out;
}

TEST_F(Program, ASignalEndsTheRunWithACheckpoint) {
  write("dam.toml", kSmall);
  const Outcome o = shell("timeout --preserve-status -s TERM 4 " + std::string(BL_PROGRAM) +
                          " run dam.toml --backend cpu --out r --until 1000");
  EXPECT_EQ(o.code, 130) << o.err;
  const auto at = o.out.find("; restart with: ");
  ASSERT_NE(at, std::string::npos) << o.out;
  EXPECT_NE(o.out.find(" run dam.toml --backend cpu --out r --until 1000 --restart r/checkpoints/step_", at),
            std::string::npos)
      << o.out;
  EXPECT_NE(content_of(dir_ / "r/summary.json").find("\"status\": \"stopped\""), std::string::npos);
}

TEST_F(Program, ABlowUpEndsWithCode3AndNamesTheWayBack) {
  write("dam.toml", kSmall);
  // Fluid that implodes at hundreds of m/s is denser than its equation of state allows.
  const Outcome o = bedload(
      "run dam.toml --backend cpu --quiet --out r --set "
      "'fluid.fill.0.velocity=[\"-8000*(x-0.025)\", \"-8000*(y-0.03)\", \"-8000*(z-0.025)\"]'");
  EXPECT_EQ(o.code, 3) << o.err;
  EXPECT_NE(o.err.find("; there is no checkpoint (set checkpoint.every)\n"), std::string::npos) << o.err;
  EXPECT_NE(content_of(dir_ / "r/summary.json").find("\"status\": \"failed\""), std::string::npos);
}

TEST_F(Program, TooManySubstepsOfALaterStepNameTheBody) {
  write("ball.toml", R"([domain]
min = [-1, -1, -1]
max = [1, 1, 1]
periodic = [true, false, false]
[[shape]]
name = "sphere"
kind = "sphere"
centre = [0, 0, 0]
radius = 0.1
[[wall.body]]
name = "ball"
shape = "sphere"
[wall.body.free]
density = 1000
velocity = [2e6, 0, 0]  # from 0.015 s on
release_time = 0.015
contacts = false
[time]
end = 1
dt = 0.01
force_dt = true
[out]
every = 1
)");
  const Outcome o = bedload("run ball.toml --backend cpu --quiet --out r");
  EXPECT_EQ(o.code, 3) << o.err;
  EXPECT_NE(
      o.err.find(" s, by the limit \"body turn\" of wall.body \"ball\", at t = 0.02 s; at most 1000000 are "
                 "allowed; "),
      std::string::npos)
      << o.err;
}

TEST_F(Program, FramesHaveTheFieldsThatAreChosen) {
  write("dam.toml", small_dam() + "[time]\nend = 0.01\n[out]\nevery = 0.01\nfields = [\"pressure\"]\n");
  ASSERT_EQ(bedload("run dam.toml --backend cpu --quiet --out out").code, 0);
  const std::string fluid = bedload("info out/fluid.vtkhdf").out,
                    grains = bedload("info out/grains.vtkhdf").out;
  EXPECT_NE(fluid.find(" pressure "), std::string::npos) << fluid;
  EXPECT_EQ(fluid.find(" velocity "), std::string::npos) << fluid;
  EXPECT_NE(grains.find(" radius "), std::string::npos) << grains;  // always
  EXPECT_EQ(grains.find(" angular_velocity "), std::string::npos) << grains;
  for (const std::string command : {"run", "check"}) {
    const Outcome o = bedload(command + " dam.toml --backend cpu --set 'out.fields=[\"presure\"]'" +
                              (command == "run" ? " --out other" : ""));
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("out.fields = \"presure\" must name a field of this case: position, "),
              std::string::npos)
        << o.err;
  }
}

}  // namespace
}  // namespace bedload::test
