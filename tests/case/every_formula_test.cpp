// Every key that takes a formula refuses alike what is none, and what has no value.

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "bedload/case/parameters.hpp"
#include "bedload/geometry/setup.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

/// Where a case holds a formula: before `[grain]` the text up to it, and what follows.
struct Place {
  std::string before, after, variables;
};

const std::string kMotion = "kind = \"formula\"\n";
const std::string kMoving = "kind = \"velocity\"\nvelocity = [0.01, 0, 0]\n";
const std::map<std::string, Place> kPlaces{
    {"fluid.fill.velocity", {"", ", 0, 0]", "xyz"}},
    {"drive.factor", {"[drive]\nf = [1, 0, 0]\nfactor = ", "", "xyzt"}},
    {"inlet.factor",
     {"[[inlet]]\nname = \"tap\"\ncentre = [0.1, 0.05, 0.15]\ndirection = [0, 0, -1]\nradius = "
      "0.02\nvelocity = 0.5\n"
      "factor = ",
      "", "t"}},
    {"wall.body.motion.displacement",
     {"[wall.body.motion]\n" + kMotion + "displacement = [", ", 0, 0]", "t"}},
    {"wall.body.motion.rotation", {"[wall.body.motion]\n" + kMotion + "rotation = [", ", 0, 0]", "t"}},
    {"wall.body.motion.add.displacement",
     {"[wall.body.motion]\n[[wall.body.motion.add]]\n" + kMotion + "displacement = [", ", 0, 0]", "t"}},
    {"wall.body.motion.add.rotation",
     {"[wall.body.motion]\n[[wall.body.motion.add]]\n" + kMotion + "rotation = [", ", 0, 0]", "t"}},
    {"wall.body.motion.factor", {"[wall.body.motion]\n" + kMoving + "factor = ", "", "t"}},
    {"wall.body.motion.add.factor",
     {"[wall.body.motion]\n[[wall.body.motion.add]]\n" + kMoving + "factor = ", "", "t"}},
    {"frame.motion.factor", {"[frame.motion]\n" + kMoving + "factor = ", "", "t"}},
    {"frame.motion.add.factor", {"[frame.motion]\n[[frame.motion.add]]\n" + kMoving + "factor = ", "", "t"}},
    {"frame.motion.displacement", {"[frame.motion]\n" + kMotion + "displacement = [", ", 0, 0]", "t"}},
    {"frame.motion.rotation", {"[frame.motion]\n" + kMotion + "rotation = [", ", 0, 0]", "t"}},
    {"frame.motion.add.displacement",
     {"[frame.motion]\n[[frame.motion.add]]\n" + kMotion + "displacement = [", ", 0, 0]", "t"}},
    {"frame.motion.add.rotation",
     {"[frame.motion]\n[[frame.motion.add]]\n" + kMotion + "rotation = [", ", 0, 0]", "t"}},
};

std::string with(const std::string& key, const std::string& formula) {
  const Place& place = kPlaces.at(key);
  const std::string text = place.before + '"' + formula + '"' + place.after + "\n";
  if (key == "fluid.fill.velocity")
    return changed("max = [0.05, 0.1, 0.1]\n", "max = [0.05, 0.1, 0.1]\nvelocity = [" + text);
  return changed("[grain]\n", text + "[grain]\n");
}

/// With which a case is refused as it is read or set up.
std::string refusal(const std::string& text) {
  std::vector<std::string> warnings;
  try {
    build_setup(read_case_text(text, "dam.toml", {}, warnings), warnings);
  } catch (const KeyError& error) {
    return "dam.toml:0: " + std::string(error.what());
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

TEST(EveryFormula, OfTheParametersIsLookedAtHere) {
  std::set<std::string> keys, here;
  for (const ParameterRow& row : parameter_table())
    if (row.kind == ValueKind::formulas || row.meaning.find("a formula in") != std::string::npos)
      keys.insert(row.key);
  for (const auto& [key, place] : kPlaces) here.insert(key);
  EXPECT_EQ(keys, here);
}

TEST(EveryFormula, IsTakenWhereItHasAValue) {
  for (const auto& [key, place] : kPlaces)
    EXPECT_EQ(refusal(with(key, key.starts_with("frame") && key.ends_with("rotation")
                                    ? "0"
                                    : "0.01*" + place.variables.substr(0, 1))),
              "")
        << key;
}

TEST(EveryFormula, IsRefusedWithItsKeyWhereItIsNone) {
  const auto repeated = [](const std::string& text, int n) {
    std::string all;
    for (int k = 0; k < n; ++k) all += text;
    return all;
  };
  const std::vector<std::string> wrong{"sin(",
                                       "1 +",
                                       "",
                                       " ",
                                       "foo",
                                       "foo(1)",
                                       "q",
                                       "1,5",
                                       "1 = 2",
                                       "2 2",
                                       "1e999",
                                       "\u00fc",
                                       "sin(1, 2)",
                                       repeated("(", 30000) + "1" + repeated(")", 30000),
                                       repeated("-", 30000) + "1",
                                       repeated("sin(", 30000) + "1" + repeated(")", 30000),
                                       repeated("2^", 30000) + "1",
                                       repeated("1?", 30000),
                                       repeated("x", 50000)};
  for (const auto& [key, place] : kPlaces)
    for (const std::string& formula : wrong) {
      const std::string why = refusal(with(key, formula));
      EXPECT_TRUE(std::regex_search(why.substr(0, 100), std::regex("^dam.toml:[0-9]+: " + key + " = .")))
          << key << " = " << formula.substr(0, 40) << ": " << why;
      EXPECT_LT(why.size(), 600u) << why;
    }
}

TEST(EveryFormula, IsRefusedWithPlaceOrTimeWhereItIsNotFinite) {
  for (const auto& [key, place] : kPlaces) {
    if (key.starts_with("frame") && key.ends_with("rotation")) continue;  // a frame does not turn at all
    std::vector<std::string> wrong{"1/0", "0/0", "ln(-1)", "1e300*1e300", "exp(1000)"};
    const bool in_time = place.variables.find('t') != std::string::npos;
    wrong.push_back(in_time ? "t > 0.15 ? sqrt(-1) : 1" : "x > 0.03 ? sqrt(-1) : 1");
    for (const std::string& formula : wrong) {
      const std::string why = refusal(with(key, formula));
      EXPECT_TRUE(std::regex_search(
          why, std::regex("^dam.toml:[0-9]+: " + key + " = .*must be .*finite.* (at .* m|t = .* s)$")))
          << key << " = " << formula << ": " << why;
    }
  }
}

}  // namespace
}  // namespace bedload::test
