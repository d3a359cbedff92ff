// Completion, manual page, schema and list for programs: what is made from the command line and the
// parameters.

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "bedload/case/parameters.hpp"
#include "run_program.hpp"

namespace bedload::test {
namespace {

class Shell : public ProgramTest {
 protected:
  /// What bash offers at the end of `line`.
  std::set<std::string> offered(const std::string& line) const {
    const Outcome o = shell("bash -c 'source <(" BL_PROGRAM " completion bash); COMP_LINE=\"" + line +
                            "\" COMP_POINT=" + std::to_string(line.size()) +
                            "; _bedload; printf \"%s\\n\" \"${COMPREPLY[@]}\"'");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(o.err, "") << line;
    std::set<std::string> words;
    std::stringstream text(o.out);
    for (std::string word; std::getline(text, word);)
      if (!word.empty()) words.insert(word);
    return words;
  }
};

using Words = std::set<std::string>;

TEST_F(Shell, CompletesCommandsOptionsAndTheirValues) {
  EXPECT_EQ(offered("bedload r"), Words{"run"});
  EXPECT_TRUE(offered("bedload ").contains("schema"));
  EXPECT_EQ(offered("bedload run --prec"), Words{"--precision"});
  EXPECT_EQ(offered("bedload run --precision "), (Words{"single", "mixed", "double"}));
  EXPECT_EQ(offered("bedload run dam.toml --backend c"), (Words{"cpu", "cuda"}));
  EXPECT_EQ(offered("bedload check --quiet"), Words{});
  EXPECT_EQ(offered("bedload list coup"), Words{"couple"});
  EXPECT_EQ(offered("bedload run --threads "), Words{});
}

TEST_F(Shell, CompletesKeysAndFiles) {
  EXPECT_EQ(offered("bedload run dam.toml --set fluid.d"), Words{"fluid.dx="});
  EXPECT_EQ(offered("bedload run dam.toml --set wall.body.0.motion.add.0.ki"),
            Words{"wall.body.0.motion.add.0.kind="});
  write("dam.toml", "");
  write("dam.csv", "");
  std::filesystem::create_directory(dir_ / "dams");
  EXPECT_EQ(offered("bedload run d"), (Words{"dam.toml", "dams"}));
  EXPECT_EQ(offered("bedload run --out d"), Words{"dams"});
  EXPECT_EQ(offered("bedload info d"), (Words{"dam.toml", "dam.csv", "dams"}));
  const Outcome o = bedload("completion fish");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("shell"), std::string::npos) << o.err;
}

TEST_F(Shell, ManualPageHasEveryCommandAndOption) {
  std::string page = bedload("man").out;
  write("bedload.1", page);
  if (shell("which groff").code == 0) {
    const Outcome o = shell("groff -man -Tascii -ww bedload.1");
    EXPECT_EQ(o.code, 0);
    EXPECT_EQ(o.err, "");
  }
  std::erase(page, '\\');
  int options = 0;
  for (const std::string command :
       {"run", "viscometer", "check", "new", "demo", "list", "info", "convert", "bench", "drag", "gui", "schema", "completion", "man"}) {
    EXPECT_NE(page.find(".SH \"bedload " + command + "\"\n"), page.npos) << command;
    std::stringstream help(bedload(command + " --help").out);
    for (std::string word; help >> word;) {
      if (!word.starts_with("--")) continue;
      EXPECT_NE(page.find(word), page.npos) << command << " " << word;
      ++options;
    }
  }
  EXPECT_GT(options, 20);
}

TEST_F(Shell, StartsTheWindowInPython) {
  write("python", "#!/bin/sh\n[ \"$1\" = -c ] && shift 2 && echo \"$@\"\n");
  std::filesystem::permissions(dir_ / "python", std::filesystem::perms::owner_all);
  const Outcome shown = shell("BEDLOAD_PYTHON=./python " BL_PROGRAM " gui dam.toml --port 8100 --no-browser");
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_EQ(shown.out, "dam.toml --port=8100 --no-browser\n");
  EXPECT_EQ(shell("BEDLOAD_PYTHON=./python " BL_PROGRAM " gui").out, "\n");
  const Outcome none = shell("BEDLOAD_PYTHON=./none " BL_PROGRAM " gui");
  EXPECT_EQ(none.code, 2);
  EXPECT_EQ(none.err, "bedload gui needs Python: ./none: No such file or directory\n");
  if (shell("python3 -c 'import sys'").code != 0) return;
  write("isolated", "#!/bin/sh\nexec python3 -I -S \"$@\"\n");  // without any package
  std::filesystem::permissions(dir_ / "isolated", std::filesystem::perms::owner_all);
  const Outcome bare = shell("BEDLOAD_PYTHON=./isolated " BL_PROGRAM " gui");
  EXPECT_EQ(bare.code, 2);
  EXPECT_NE(bare.err.find("pip install \"bedload[gui]\""), bare.err.npos) << bare.err;
}

TEST_F(Shell, ListsParametersForPrograms) {
  const auto rows = parameter_table();
  const auto listed = nlohmann::json::parse(bedload("list --json").out);
  ASSERT_EQ(listed.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(listed[i]["key"], rows[i].key);
  for (const auto& row : listed) {
    if (row["key"] == "wall.body.motion.add.kind") {
      EXPECT_EQ(row["path"], "wall.body[].motion.add[].kind");
      EXPECT_EQ(row["choices"].size(), 8u);
    }
  }
  const auto section = nlohmann::json::parse(bedload("list couple --json").out);
  ASSERT_FALSE(section.empty());
  for (const auto& row : section) EXPECT_TRUE(std::string(row["key"]).starts_with("couple.")) << row;
}

TEST(ParameterTable, KnowsWhatIsRequiredOfEveryTable) {
  std::set<std::string> required;
  for (const ParameterRow& row : parameter_table())
    if (row.required) required.insert(row.key);
  for (const char* key :
       {"domain.min", "time.end", "fluid.dx", "wall.body.name", "probe.type", "inlet.centre"})
    EXPECT_TRUE(required.contains(key)) << key;
  for (const char* key :
       {"shape.radius", "wall.body.min", "grain.fill.min", "fluid.fill.max", "probe.at", "grain.d",
        "wall.body.motion.axis", "wall.body.free.axis", "outlet.min", "inlet.radius"})
    EXPECT_FALSE(required.contains(key)) << key;
  EXPECT_EQ(required_keys(), (std::vector<std::string>{"domain.min", "domain.max", "time.end", "out.every"}));
}

TEST(ParameterTable, LeavesOutRangesThatDependOnOtherKeys) {
  for (const ParameterRow& row : parameter_table()) {
    const bool depends = row.key == "fluid.h_over_dx" || row.key == "grain.e" || row.key.ends_with(".stop");
    if (depends) {
      EXPECT_EQ(row.range, Interval{}) << row.key;
    }
    if (row.key == "grain.mu") {
      EXPECT_EQ(row.range, within(0, 5));
    }
  }
}

}  // namespace
}  // namespace bedload::test
