// Two tables of one name are refused, whatever they are.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "bedload/case/parameters.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

/// By the key of the name: a table that a case may have, and its other keys.
const std::map<std::string, std::string> kNamed{
    {"shape", "kind = \"sphere\"\ncentre = [0.1, 0.05, 0.1]\nradius = 0.02\n"},
    {"wall.body", "shape = \"box\"\nmin = [0.1, 0, 0]\nmax = [0.12, 0.1, 0.02]\n"},
    {"inlet", "centre = [0.1, 0.05, 0.15]\ndirection = [0, 0, -1]\nradius = 0.02\nvelocity = 0.5\n"},
    {"outlet", "min = [0.15, 0, 0]\nmax = [0.2, 0.1, 0.02]\n"},
    {"grain_inlet", "min = [0.1, 0, 0.1]\nmax = [0.2, 0.1, 0.2]\nrate = 10\n"},
    {"grain.material", "rho = 2000\n"},
    {"fluid.species", "mu = 0.001\n"},
    {"clump", "spheres = [[0, 0, 0, 1]]\n"},
    {"probe", "type = \"front\"\n"},
};

std::string table(const std::string& of, const std::string& name) {
  return "[[" + of + "]]\nname = \"" + name + "\"\n" + kNamed.at(of);
}

std::string with(const std::string& tables) { return changed("[time]\n", tables + "[time]\n"); }

TEST(Names, OfAllTablesAreLookedAtHere) {
  std::set<std::string> keys, here;
  for (const ParameterRow& row : parameter_table())
    if (row.key.ends_with(".name")) keys.insert(row.key);
  for (const auto& [of, rest] : kNamed) here.insert(of + ".name");
  EXPECT_EQ(keys, here);
}

TEST(Names, MayNotBeThoseOfTwoTables) {
  for (const auto& [of, rest] : kNamed) {
    const std::string coupled = of == "fluid.species" ? "[couple]\nmode = \"off\"\n" : "";
    EXPECT_EQ(error_of(with(coupled + table(of, "one") + table(of, "other"))), "") << of;
    const std::string why = error_of(with(coupled + table(of, "one") + table(of, "one")));
    EXPECT_NE(why.find(of + ".name = \"one\" must differ from other "), std::string::npos)
        << of << ": " << why;
    EXPECT_TRUE(why.starts_with("dam.toml:")) << why;
  }
}

TEST(Names, OfOpeningsDifferThroughout) {
  for (const std::string of : {"outlet", "grain_inlet"}) {
    const std::string why = error_of(with(table("inlet", "one") + table(of, "one")));
    EXPECT_NE(why.find(of + ".name = \"one\" must differ from other inlets' and outlets'"), std::string::npos)
        << why;
  }
}

}  // namespace
}  // namespace bedload::test
