// What a restart makes of the results folder, and leaves alone.

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "bedload/output/h5_table.hpp"
#include "bedload/output/vtkhdf.hpp"
#include "run_program.hpp"
#include "tests/support/cases.hpp"

namespace bedload::test {
namespace {

namespace fs = std::filesystem;

const std::string kCase = small_dam() +
                          "[time]\nend = 0.03\n[out]\nevery = 0.002\nbodies = \"all\"\n"
                          "[checkpoint]\nevery = 0.004\n[[probe]]\nname = \"gauge\"\n";
const std::string kFront = "type = \"front\"\n",
                  kBox = "type = \"box\"\nmin = [0, 0, 0]\nmax = [0.1, 0.06, 0.03]\n";
const std::string kRun = "run case.toml --backend cpu --threads 1 --quiet --out out ";

class Restart : public ProgramTest {
 protected:
  void SetUp() override {
    write("case.toml", kCase + kFront);
    const Outcome o = bedload(kRun);
    ASSERT_EQ(o.code, 0) << o.err;
  }

  /// Everything in the results folder, by name.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(out_)) {
      const std::string name = entry.path().lexically_relative(out_);
      if (name != ".lock") all[name] = entry.is_regular_file() ? content_of(entry.path()) : "no file";
    }
    return all;
  }
  std::vector<fs::path> checkpoints() const {
    std::vector<fs::path> all;
    for (const auto& entry : fs::directory_iterator(out_ / "checkpoints")) all.push_back(entry.path());
    std::sort(all.begin(), all.end());
    return all;
  }
  std::vector<double> times(const std::string& table) const {
    std::stringstream text(content_of(out_ / table));
    std::vector<double> all;
    std::string line;
    for (std::getline(text, line); std::getline(text, line);) all.push_back(std::stod(line));
    return all;
  }
  std::string status() const {
    return nlohmann::json::parse(content_of(out_ / "summary.json"), nullptr, false).value("status", "none");
  }
  void rewrite(const std::string& file, const std::function<void(std::string&)>& change) const {
    std::string text = content_of(out_ / file);
    change(text);
    std::ofstream(out_ / file, std::ios::binary) << text;
  }

  const fs::path out_ = dir_ / "out";
};

/// Whatever is wrong with the folder is seen before anything in it is changed.
TEST_F(Restart, ThatIsRefusedLeavesEveryByte) {
  struct Harm {
    std::string file, message;
    std::function<void()> doing;
  };
  const std::string gauge = "probes/gauge.csv", rows = "diagnostics.csv", fluid = "fluid.vtkhdf";
  const auto remove = [&](const std::string& file) { fs::remove_all(out_ / file); };
  const auto replace = [&](const std::string& file, const std::function<void(const fs::path&)>& by) {
    return [=, this] {
      remove(file);
      by(out_ / file);
    };
  };
  const auto folder = [](const fs::path& path) { fs::create_directory(path); };
  const auto lost_link = [](const fs::path& path) { fs::create_symlink("nowhere", path); };
  std::vector<Harm> harms{
      {gauge, "has the columns ", [&] { write("case.toml", kCase + kBox); }},
      {rows, "has the columns ", [&] { rewrite(rows, [](std::string& s) { s.replace(11, 1, "F"); }); }},
      {rows, "CR LF", [&] { rewrite(rows, [](std::string& s) { s.insert(s.find('\n'), "\r"); }); }},
      {rows, ":3: must be a row of",
       [&] { rewrite(rows, [](std::string& s) { s.insert(s.find("\n0.00") + 1, "x\n"); }); }},
      {rows, "comes before",
       [&] { rewrite(rows, [](std::string& s) { s += s.substr(s.find("\n0,") + 1); }); }},
      {fluid, "cannot read", replace(fluid, [](const fs::path& p) { std::ofstream(p) << "text"; })},
      // what a run had written until the checkpoint
      {gauge, "is empty", replace(gauge, [](const fs::path& p) { std::ofstream out(p); })},
      {gauge, "ends at t = 0 s",
       [&] { rewrite(gauge, [](std::string& s) { s.resize(s.find("\n0.00") + 1); }); }},
      {gauge, "is missing", [&] { remove(gauge); }},
      {"grains.vtkhdf", "is missing", [&] { remove("grains.vtkhdf"); }},
  };
  for (const std::string& file :
       {gauge, rows, fluid, std::string("fluid.xdmf"), std::string("bodies/tank.csv"),
        std::string("summary.json"), std::string("case.resolved.toml")}) {
    harms.push_back({file, "it is a folder", replace(file, folder)});
    harms.push_back({file, "a broken link", replace(file, lost_link)});
  }
  for (const std::string name : {"bodies", "probes"})
    harms.push_back(
        {name, "it is not a folder", replace(name, [](const fs::path& p) { std::ofstream out(p); })});

  fs::copy(out_, dir_ / "kept", fs::copy_options::recursive);
  for (const Harm& harm : harms) {
    fs::remove_all(out_);
    fs::copy(dir_ / "kept", out_, fs::copy_options::recursive);
    write("case.toml", kCase + kFront);
    harm.doing();
    const auto before = contents();
    for (const auto& from : {checkpoints().at(2), checkpoints().back()}) {
      const Outcome o = bedload(kRun + "--until 0.04 --restart " + from.string());
      EXPECT_EQ(o.code, 2) << harm.file << ": " << harm.message;
      EXPECT_EQ(o.err.find("out/" + harm.file), 0u) << o.err;
      EXPECT_NE(o.err.find(harm.message), o.err.npos) << o.err;
      EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
      EXPECT_TRUE(contents() == before) << harm.file << ": " << harm.message;
    }
  }
}

/// As after an older version, or with a law that adds a field.
TEST_F(Restart, AddsArraysThatFormerFramesLack) {
  const FrameFile fluid(out_ / "fluid.vtkhdf");
  const HostStore before = fluid.read(1);
  {
    const h5::Handle file = h5::open_file(fluid.path(), h5::Mode::append);
    for (const char* name : {"VTKHDF/PointData/density", "VTKHDF/Steps/PointDataOffsets/density"})
      ASSERT_GE(H5Ldelete(file, name, H5P_DEFAULT), 0);
  }
  const double former = fluid.times().back();
  const Outcome o = bedload(kRun + "--restart latest --until 0.04");
  ASSERT_EQ(o.code, 0) << o.err;
  ASSERT_GT(fluid.times().back(), former);
  for (std::size_t frame = 0; frame < fluid.times().size(); ++frame) {
    const HostStore store = fluid.read(frame);
    const HostArray* density = store.find("density");
    ASSERT_NE(density, nullptr);
    ASSERT_EQ(density->count(), store.count);
    for (std::size_t a = 0; a < store.count; ++a)
      EXPECT_EQ(std::isnan(density->as<float>()[a]), fluid.times()[frame] <= former) << fluid.times()[frame];
  }
  EXPECT_EQ(fluid.read(1).find("position")->bytes, before.find("position")->bytes);
}

TEST_F(Restart, GoesOnWithoutWhatIsMissingIfAllowed) {
  fs::remove(out_ / "grains.vtkhdf");
  const Outcome o = bedload(kRun + "--restart latest --until 0.04 --allow-changes");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.err.find("warning: out/grains.vtkhdf is missing"), o.err.npos) << o.err;
  EXPECT_TRUE(fs::exists(out_ / "grains.vtkhdf"));
}

/// Probes may come, go and change their intervals; another folder begins its series anew.
TEST_F(Restart, NewProbesAndFoldersLackNothing) {
  const std::string from = "--restart " + checkpoints().at(2).string() + " ";
  write("case.toml", kCase + kFront + "[[probe]]\nname = \"new\"\n" + kBox);
  Outcome o = bedload(kRun + from + "--until 0.018 --set out.every=0.001");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_GT(times("probes/new.csv").front(), 0.01);
  o = bedload(kRun + "--restart latest --set out.every=0.003");
  EXPECT_EQ(o.code, 0) << o.err;
  o = bedload("run case.toml --backend cpu --quiet --out elsewhere " + from);
  EXPECT_EQ(o.code, 0) << o.err;
}

/// With the table of a probe that the case no longer has, and the summary of the end.
TEST_F(Restart, WhatLiesAfterItIsOutOfDate) {
  const auto all = checkpoints();
  write("case.toml", kCase.substr(0, kCase.find("[[probe]]")));
  const Outcome o = shell(
      "sh -c '" BL_PROGRAM " " + kRun + "--set time.end=1000 --restart " + all.at(1).string() +
      " & run=$!; n=0; until grep -q \"end = 1000\" out/case.resolved.toml && [ -e " + all.at(2).string() +
      " ] || [ $((n += 1)) -gt 3000 ]; do sleep 0.01; done; kill -KILL $run; wait $run'");
  EXPECT_EQ(o.code, 137);
  EXPECT_FALSE(fs::exists(out_ / "summary.json"));
  const double gone_on = times("diagnostics.csv").back();
  EXPECT_LT(times("probes/gauge.csv").back(), 0.0085);
  const Outcome on = bedload(kRun + "--restart latest --until " + std::to_string(gone_on + 0.01));
  EXPECT_EQ(on.code, 0) << on.err;
  const auto rows = times("diagnostics.csv");
  for (std::size_t k = 1; k < rows.size(); ++k) EXPECT_LT(rows[k] - rows[k - 1], 0.004) << rows[k];
}

TEST_F(Restart, RemovesLaterCheckpointsOnceAStepIsMade) {
  const auto all = checkpoints();
  const std::string from = "--restart " + all.at(1).string() + " --until ";
  const auto before = contents();
  EXPECT_EQ(bedload(kRun + from + "0.001").code, 2);
  EXPECT_TRUE(contents() == before);
  EXPECT_EQ(bedload(kRun + from + "0.0087").code, 0);
  EXPECT_EQ(checkpoints().size(), 3u);
  EXPECT_TRUE(fs::exists(all.at(1)));
  EXPECT_FALSE(fs::exists(all.at(2)));
  const Outcome o = bedload(kRun + "--restart latest");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(content_of(all.back()), before.at("checkpoints/" + all.back().filename().string()));
  EXPECT_EQ(content_of(out_ / "diagnostics.csv"), before.at("diagnostics.csv"));
}

/// From a checkpoint, and from where a run ended between two rows.
TEST_F(Restart, MeansGoOnInTheMiddleOfAnInterval) {
  write("case.toml", kCase + kFront +
                         "[[probe]]\nname = \"load\"\ntype = \"force\"\nbody = \"tank\"\n"
                         "every = 0.007\n");
  const std::string load = "probes/load.csv";
  Outcome o = bedload(kRun + "--overwrite");
  ASSERT_EQ(o.code, 0) << o.err;
  const std::string unbroken = content_of(out_ / load);
  ASSERT_EQ(times(load).size(), 6u);
  o = bedload(kRun + "--restart " + checkpoints().at(1).string());
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(content_of(out_ / load), unbroken);
  o = bedload(kRun + "--overwrite --until 0.0093");
  ASSERT_EQ(o.code, 0) << o.err;
  o = bedload(kRun + "--restart latest");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(content_of(out_ / load), unbroken);
}

/// Killed after its last checkpoint, and asked once more by a chain of jobs.
TEST_F(Restart, AFinishedRunIsFinished) {
  const auto before = contents();
  fs::remove(out_ / "summary.json");
  Outcome o = bedload(kRun + "--restart latest");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(status(), "completed");
  auto after = contents();
  const auto metrics = [](const std::map<std::string, std::string>& in) {
    return nlohmann::json::parse(in.at("summary.json"))["metrics"].dump();
  };
  EXPECT_EQ(metrics(after), metrics(before));
  for (const auto& [name, content] : before) {
    if (name.ends_with(".csv") || name.ends_with(".h5") || name.ends_with(".toml")) {
      EXPECT_TRUE(after[name] == content) << name;
    }
  }
  o = bedload(kRun + "--restart latest");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_TRUE(contents() == after) << "and tells how long it took";
}

TEST_F(Restart, AnOverwrittenFolderHoldsOneRun) {
  std::ofstream(out_ / "probes/measured.csv") << "x,y\n1,2\n";
  write("case.toml", kCase.substr(0, kCase.find("[[probe]]")));
  const Outcome o = bedload(kRun + "--overwrite --set out.bodies=none --set out.walls=false");
  EXPECT_EQ(o.code, 0) << o.err;
  const auto after = contents();
  for (const char* name : {"probes/gauge.csv", "bodies/tank.csv", "walls.vtkhdf", "walls.xdmf"})
    EXPECT_FALSE(after.contains(name)) << name;
  EXPECT_TRUE(after.contains("probes/measured.csv")) << "which is no run's";
  EXPECT_TRUE(after.contains("fluid.vtkhdf"));
}

TEST_F(Restart, AnEmptyNameIsNoName) {
  const auto before = contents();
  for (const std::string option : {"--restart \"\"", "--overwrite --restart=", "--out \"\""}) {
    const Outcome o = bedload(kRun + option);
    EXPECT_EQ(o.code, 2) << option;
    EXPECT_EQ(o.err.find("command line: --"), 0u) << o.err;
  }
  EXPECT_TRUE(contents() == before);
}

TEST_F(Restart, TellsThatOtherSkinsChangeResults) {
  const Outcome o = bedload(kRun + "--restart latest --until 0.04 --set run.skin_grain=0.5");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("run.skin_grain = 0.5"), o.err.npos) << o.err;
}

}  // namespace
}  // namespace bedload::test
