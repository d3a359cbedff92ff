// Words of other programs, and what is suggested for keys that are none.

#include "bedload/case/words.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "bedload/case/parameters.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

/// What a case says that has this in addition.
std::string answer(const std::string& assignment) { return error_of(kCase, {assignment}); }

TEST(Words, AreOfSixProgramsAndNameWhatThereIs) {
  const std::vector<ParameterRow> rows = parameter_table();
  std::set<std::string_view> programs;
  std::set<std::tuple<std::string_view, std::string_view, std::string_view>> names;
  int of_programs = 0, named = 0;
  for (const Word& word : words()) {
    if (!word.program.empty()) programs.insert(word.program), ++of_programs;
    EXPECT_TRUE(names.insert({word.program, word.name, word.within}).second)
        << word.name << " is there twice";
    EXPECT_FALSE(words_named(word.name).empty()) << word.name;
    EXPECT_TRUE(!word.keys.empty() || !word.note.empty()) << word.name;
    for (const std::string& key : keys_of(word)) {
      const bool there = std::any_of(rows.begin(), rows.end(), [&](const ParameterRow& row) {
        return row.key == key || row.key.starts_with(key + ".");
      });
      EXPECT_TRUE(there) << word.name << ": " << key;
      ++named;
    }
    for (const std::string& table : tables_of(word))
      EXPECT_TRUE(std::any_of(rows.begin(), rows.end(),
                              [&](const ParameterRow& row) { return row.key.starts_with(table + "."); }))
          << word.name << ": " << table;
  }
  EXPECT_EQ(programs, (std::set<std::string_view>{"DualSPHysics", "DesignSPHysics", "LIGGGHTS", "LAMMPS",
                                                  "PySPH", "SPHinXsys"}));
  EXPECT_GE(of_programs, 200);
  EXPECT_GE(named, 200);
}

TEST(Words, AreFoundHoweverTheyAreWritten) {
  for (const char* name : {"TimeMax", "timemax", "time_max", "TIME-MAX", "time max"}) {
    ASSERT_EQ(words_named(name).size(), 1u) << name;
    EXPECT_EQ(words_named(name)[0].keys, "time.end") << name;
  }
  EXPECT_EQ(words_named("gamma").size(), 2u);  // of DualSPHysics and of PySPH
  EXPECT_TRUE(words_named("timemaxx").empty());
  EXPECT_TRUE(words_named("_").empty());
}

TEST(Words, OfOtherProgramsAreAnsweredWithTheirKey) {
  EXPECT_EQ(error_of(changed("end = 0.3", "TimeMax = 0.3")),
            "dam.toml:22: time.TimeMax is not a parameter; what DualSPHysics calls TimeMax is time.end here");
  EXPECT_EQ(
      answer("DensityDT=2"),
      "--set DensityDT=2: DensityDT is not a parameter; what DualSPHysics calls DensityDT is density.delta "
      "here (0: none)");
  EXPECT_EQ(answer("grain.youngsModulus=1e7"),
            "--set grain.youngsModulus=1e7: grain.youngsModulus is not a parameter; what LIGGGHTS calls "
            "youngsModulus is grain.E here (on a wall wall.body.E)");
  EXPECT_EQ(answer("wall.body.0.youngsModulus=1e7"),
            "--set wall.body.0.youngsModulus=1e7: wall.body.youngsModulus is not a parameter; what LIGGGHTS "
            "calls youngsModulus is wall.body.E here");
  EXPECT_EQ(answer("constants.rhop0=1"),
            "--set constants.rhop0=1: constants.rhop0 is not a parameter; what DualSPHysics calls rhop0 is "
            "fluid.rho0 here");
  EXPECT_EQ(answer("grain.rolling_friction=1"),
            "--set grain.rolling_friction=1: grain.rolling_friction is not a parameter; rolling friction is "
            "grain.mu_r here");
  EXPECT_EQ(
      answer("contact.rolling_friction=cdt"),
      "--set contact.rolling_friction=cdt: contact.rolling_friction is not a parameter; what LIGGGHTS calls "
      "rolling_friction is contact.rolling here (of pair_style gran)");
  EXPECT_EQ(
      answer("fluid.nu=1e-6"),
      "--set fluid.nu=1e-6: fluid.nu is not a parameter; what PySPH calls nu is fluid.mu here (rho0 times "
      "the kinematic viscosity)");
}

TEST(Words, OfWhatThereIsNoneAreAnsweredWithASentence) {
  EXPECT_EQ(answer("fluid.surface_tension=0.07"),
            "--set fluid.surface_tension=0.07: fluid.surface_tension is not a parameter; there is no surface "
            "tension; results hold where Weber and Bond numbers are large");
  EXPECT_NE(answer("waves.piston_focused.amplitude=1").find("; wave makers are for regular waves"),
            std::string::npos);
  EXPECT_NE(answer("surface_tension.gamma=0.07").find("; there is no surface tension"), std::string::npos);
  EXPECT_NE(answer("fluid.yield_stress=1").find("; fluids are Newtonian"), std::string::npos);
  EXPECT_NE(answer("species.tau_yield=1").find("; fluids are Newtonian"), std::string::npos);
  EXPECT_NE(answer("contact.cohesionEnergyDensity=1").find("; grains do not cohere"), std::string::npos);
}

TEST(Words, OfSomeTablesMeanNothingInOthers) {
  EXPECT_EQ(
      answer("grain.motion=1"),
      "--set grain.motion=1: grain.motion is not a parameter; `bedload list grain` shows what there is");
  EXPECT_EQ(answer("fluid.density=800"),
            "--set fluid.density=800: fluid.density is not a parameter; density is fluid.rho0 here");
}

TEST(Words, AreNotThoseOfTablesOfACase) {
  EXPECT_EQ(
      answer("density.blah=1"),
      "--set density.blah=1: density.blah is not a parameter; `bedload list density` shows what there is");
}

TEST(UnknownKeys, SuggestNothingWhereNothingIsNear) {
  EXPECT_EQ(answer("fluid.xyzzy=1"),
            "--set fluid.xyzzy=1: fluid.xyzzy is not a parameter; `bedload list fluid` shows what there is");
  EXPECT_EQ(answer("wall.body.0.motion.speedy=1"),
            "--set wall.body.0.motion.speedy=1: wall.body.motion.speedy is not a parameter; `bedload list "
            "wall.body.motion` shows what there is");
  for (const std::string key :
       {"time.stop", "time.dt_max", "grain.size_of_all"})  // stop: of inlets and motions
    EXPECT_EQ(answer(key + "=1").find("did you mean"), std::string::npos) << answer(key + "=1");
  EXPECT_EQ(answer("xyzzy=1"),
            "--set xyzzy=1: xyzzy is not a parameter; `bedload list parameters` shows all there are");
}

TEST(UnknownKeys, OfContactsAreThoseOfGrainsOrOfPairs) {
  for (const std::string name : {"mu", "mu_r", "e"})
    EXPECT_EQ(answer("contact." + name + "=1"), "--set contact." + name + "=1: contact." + name +
                                                    " is not a parameter; " + name + " is grain." + name +
                                                    " here (of two materials contact.pair." + name + ")");
}

TEST(UnknownKeys, SuggestWhatIsNear) {
  const auto suggests = [](const std::string& assignment, const std::string& key) {
    EXPECT_NE(answer(assignment).find(" did you mean " + key + "?"), std::string::npos) << answer(assignment);
  };
  suggests("time_end=1", "time.end");
  suggests("time.edn=1", "time.end");
  suggests("grian.fixed=1", "grain.fixed");
  suggests("body.motion.frequency=1", "wall.body.motion.frequency");
  suggests("contact.reyleigh=1", "time.rayleigh");
  suggests("fluid.kernal=cubic", "fluid.kernel");
}

}  // namespace
}  // namespace bedload::test
