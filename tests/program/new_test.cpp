// The cases that come with the program: `bedload new` and `bedload demo`.

#include <vector>

#include "run_program.hpp"

namespace bedload::test {
namespace {

namespace fs = std::filesystem;

class New : public ProgramTest {};

TEST_F(New, EveryTemplateIsACommentedCaseInOrder) {
  std::stringstream list(bedload("new").out);
  std::size_t tried = 0;
  for (std::string line; std::getline(list, line) && !line.empty(); ++tried) {
    const std::string name = line.substr(0, line.find(' '));
    const std::string summary = line.substr(line.find_first_not_of(' ', name.size()));
    SCOPED_TRACE(name);
    ASSERT_EQ(bedload("new " + name).code, 0);
    const std::string text = content_of(dir_ / (name + ".toml"));
    EXPECT_TRUE(text.starts_with("# " + summary + "\n"));
    EXPECT_NE(text.find("#   bedload check " + name + ".toml"), text.npos);
    const Outcome o = bedload("check " + name + ".toml --backend cpu");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(o.out.find("warning"), o.out.npos) << o.out;
  }
  EXPECT_GE(tried, 9u);
}

TEST_F(New, NeverReplacesAFile) {
  write("dam.toml", "mine");
  const Outcome o = bedload("new dam_break dam.toml");
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(o.err, "dam.toml: exists already; choose another name for the new case\n");
  EXPECT_EQ(content_of(dir_ / "dam.toml"), "mine");

  fs::create_directory(dir_ / "mill");
  ASSERT_EQ(bedload("new ball_mill mill/mine.toml").code, 0);
  EXPECT_TRUE(fs::exists(dir_ / "mill/ball_mill.obj"));
  EXPECT_EQ(bedload("new ball_mill mill/other.toml").code, 2);  // its mesh is there already
  EXPECT_FALSE(fs::exists(dir_ / "mill/other.toml"));

  const Outcome unknown = bedload("new dam");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("dam_break"), std::string::npos) << unknown.err;
}

TEST_F(New, TheDemonstrationRunsACaseAndDrawsIt) {
  const std::string demo = "demo --backend cpu --until 0.02 --set grain.settle=false";
  const Outcome o = bedload(demo);
  ASSERT_EQ(o.code, 0) << o.err;
  const fs::path results = dir_ / "results/two_phase_dam_break";
  for (const char* name : {"film.png", "picture.png", "two_phase_dam_break.toml"}) {
    EXPECT_TRUE(fs::exists(results / name)) << name;
    EXPECT_NE(o.out.find("results/two_phase_dam_break/" + std::string(name)), o.out.npos) << name;
  }
  const std::string film = content_of(results / "film.png");
  int frames = 0;
  for (auto at = film.find("fcTL"); at != film.npos; at = film.find("fcTL", at + 4)) ++frames;
  EXPECT_EQ(frames, 41);
  const Outcome again = bedload(demo);
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.err.find("already holds a run"), std::string::npos) << again.err;
}

}  // namespace
}  // namespace bedload::test
