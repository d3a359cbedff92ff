// Motions in case files: tables, sums, the frame, what is said about them.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "bedload/core/error.hpp"
#include "bedload/motion/law.hpp"
#include "tests/case/support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace bedload::test {
namespace {

/// A folder with a table beside a case, removed at the end.
class TableCase : public testing::Test {
 protected:
  Config with(const std::string& table, const std::string& keys = "") {
    std::ofstream(folder_ / "gate.csv") << table;
    std::ofstream(folder_ / "dam.toml") << moving("kind = \"table\"\nfile = \"gate.csv\"\n" + keys);
    warnings.clear();
    return read_case(folder_ / "dam.toml", {}, warnings);
  }
  /// What is wrong, without the folder's name.
  std::string error(const std::string& table) {
    try {
      with(table);
    } catch (const CaseError& e) {
      return folder_.left_out_of(e.what());
    }
    return "";
  }
  static std::string moving(const std::string& motion) {
    return changed("[grain]\n", "[wall.body.motion]\n" + motion + "[grain]\n");
  }

  const TemporaryFolder folder_;
  std::vector<std::string> warnings;
};

TEST_F(TableCase, IsReadFromAFileBesideTheCase) {
  const Config c = with(
      "# measured\n"
      "time [s],z [m],x,ry [deg]\r\n"
      "\n"
      "0,0,0,0\r\n"
      " 0.1 , 2e-3,+0.5,-90\n"
      "0.2,4e-3,1,-180");
  const auto& m = c.wall.bodies[0].motion;
  EXPECT_EQ(m.rows,
            (std::vector<MotionRow>{
                {0, 0, 0, 0, 0, 0, 0}, {0.1, 0.5, 0, 2e-3, 0, -90, 0}, {0.2, 1, 0, 4e-3, 0, -180, 0}}));
  EXPECT_TRUE(m.file.empty());
  EXPECT_NEAR(MotionLaw(m, 1).at(0.1).v.x, 5, 1e-12);
}

TEST_F(TableCase, MistakesNameFileLineAndColumn) {
  EXPECT_EQ(error("t,x\n0,0\n0.1,1\n0.1,2\n"),
            "gate.csv:4: t = 0.1 must exceed 0.1, the t of the row before");
  EXPECT_EQ(error("t,x\n0,0\n0.1,1m\n"), "gate.csv:3: column 2: x = \"1m\" must be a finite number");
  EXPECT_EQ(error("t,x\n0,0\n0.1,nan\n"), "gate.csv:3: column 2: x = \"nan\" must be a finite number");
  EXPECT_EQ(error("t,x\n0,0\n0.1,\n"), "gate.csv:3: column 2: x = \"\" must be a finite number");
  EXPECT_EQ(error("t,x\n0,0\n"), "gate.csv: must have two rows or more, not 1");
  EXPECT_EQ(error("t,x\n0,0\n1\n"), "gate.csv:3: has 1 columns, the header 2");
  EXPECT_EQ(error("t,q\n"), "gate.csv:1: column 2: \"q\" must be one of t, x, y, z, rx, ry, rz");
  EXPECT_EQ(error("t,x [mm]\n"), "gate.csv:1: column 2: x must be in m, not [mm]");
  EXPECT_EQ(error("t,x,x\n"), "gate.csv:1: column 3: x is given twice");
  EXPECT_EQ(error("x,y\n"), "gate.csv:1: the header must name a column t");
  EXPECT_EQ(error("0,0\n1,1\n"), "gate.csv:1: column 1: \"0\" must be one of t, x, y, z, rx, ry, rz");
  EXPECT_EQ(error(""), "gate.csv: must begin with a header that names its columns");
}

TEST_F(TableCase, JumpsAreWarnedOf) {
  with("t,x\n0,0\n0.1,0.05\n0.2,0.1\n");
  EXPECT_EQ(warnings,
            (std::vector<std::string>{"wall.body \"tank\": its velocity jumps by 0.5 m/s at t = 0 s",
                                      "wall.body \"tank\": its velocity jumps by 0.5 m/s at t = 0.2 s"}));
}

TEST_F(TableCase, ReadsBackWithoutItsFile) {
  const Config c = with("t,x,rz\n0,0,0\n0.125,0.1,30\n0.3,0.2,33.3\n", "spline = \"monotone\"\n");
  const std::string text = resolved_toml(c);
  std::vector<std::string> none;
  EXPECT_TRUE(read_case_text(text, c.file, {}, none) == c) << text;
}

TEST(MotionCase, TablesMayStandInTheCase) {
  const std::string from = "[grain]\n";
  const auto rows = [&](const std::string& text) {
    return changed(from, "[wall.body.motion]\nkind = \"table\"\n" + text + "\n" + from);
  };
  const Config c = read(rows("rows = [[0, 0, 0, 0], [0.1, 0, 0, 0.2], [0.2, 0, 0, 0.3, 0, 45, 0]]"));
  EXPECT_EQ(c.wall.bodies[0].motion.rows[2], (MotionRow{0.2, 0, 0, 0.3, 0, 45, 0}));
  EXPECT_EQ(error_of(rows("rows = [[0, 0, 0, 0], [0, 0, 0, 1]]")),
            "dam.toml:17: wall.body.motion.rows, row 2: t = 0 must exceed 0, the t of the row before");
  EXPECT_EQ(error_of(rows("rows = [[0, 0, 0, 0]]")),
            "dam.toml:17: wall.body.motion.rows: must have two rows or more, not 1");
  EXPECT_EQ(error_of(rows("rows = [[0, 0, 0]]")),
            "dam.toml:17: wall.body.motion.rows = [[0, 0, 0]] must be a list of rows [[t, x, y, z], ...] or "
            "[[t, x, y, z, rx, ry, rz], ...]");
  EXPECT_EQ(error_of(rows("rows = [[0, 0, 0, nan], [1, 0, 0, 0]]")),
            "dam.toml:17: wall.body.motion.rows = [[0, 0, 0, nan], [1, 0, 0, 0]] must be finite");
  EXPECT_EQ(error_of(rows("start = 0.1")),
            "dam.toml:16: wall.body.motion must have one of file and rows with kind = \"table\"");
  EXPECT_EQ(error_of(rows("file = \"none.csv\"")),
            "dam.toml:17: wall.body.motion.file = \"none.csv\" must name a table; there is no file none.csv");
}

TEST(MotionCase, FormulasMayBreakButNotJump) {
  const auto with = [](const std::string& displacement, const std::string& rotation = "0") {
    return changed("[grain]\n", "[wall.body.motion]\nkind = \"formula\"\ndisplacement = [0, 0, \"" +
                                    displacement + "\"]\nrotation = [\"" + rotation + "\", 0, 0]\n[grain]\n");
  };
  EXPECT_EQ(error_of(with("t < 0.2 ? 0 : 0.01")),
            "dam.toml:17: wall.body.motion.displacement = [0, 0, \"t < 0.2 ? 0 : 0.01\"] must not jump; \"t "
            "< 0.2 ? 0 "
            ": 0.01\" does by 0.01 m at t = 0.2 s");
  EXPECT_EQ(error_of(with("0", "rint(5*t)")),
            "dam.toml:18: wall.body.motion.rotation = [\"rint(5*t)\", 0, 0] must not jump; \"rint(5*t)\" "
            "does by 1 deg "
            "at t = 0.1 s");
  EXPECT_EQ(error_of(with("t < 0.4 ? 0 : 0.01")), "") << "the run ends before";
  const std::string jump = "wall.body \"tank\": its velocity jumps ";
  EXPECT_EQ(warnings_of(with("max(0, t - 0.15)^1")),
            (std::vector<std::string>{jump + "by 1 m/s at t = 0.15 s"}));
  EXPECT_TRUE(warnings_of(with("0.001*(1 - cos(5000*t))")).empty());
  const auto teeth = warnings_of(with("0.001*abs(sin(pi*t/0.01 + pi/2))"));  // one every 10 ms
  ASSERT_EQ(teeth.size(), 6u) << "the motion begins elsewhere as well";
  EXPECT_EQ(teeth.back(), jump + "26 times more until t = 0.295 s");
}

TEST(MotionCase, SteadyMotionsJumpWithoutWarningOnlyAtTheVeryStart) {
  const auto warnings = [](const std::string& text) {
    return warnings_of(changed("[grain]\n", "[wall.body.motion]\n" + text + "\n[grain]\n"));
  };
  const std::string gate = "kind = \"velocity\"\nvelocity = [0, 0, 0.68]\n";
  const std::string jump = "wall.body \"tank\": its velocity jumps by ";
  EXPECT_TRUE(warnings(gate).empty());
  EXPECT_EQ(warnings(gate + "stop = 0.25"), (std::vector<std::string>{jump + "0.68 m/s at t = 0.25 s"}));
  EXPECT_EQ(warnings(gate + "start = 0.1"), (std::vector<std::string>{jump + "0.68 m/s at t = 0.1 s"}));
  EXPECT_EQ(warnings("kind = \"oscillation\"\namplitude = [7.1e-3, 0, 0]\nfrequency = 4.06"),
            (std::vector<std::string>{jump + "0.1811 m/s at t = 0 s"}));
  EXPECT_EQ(warnings("kind = \"oscillation\"\namplitude = [7.1e-3, 0, 0]\nfrequency = 4.06\nstop = 0.2")[1],
            jump + "0.06879 m/s at t = 0.2 s");
}

TEST(MotionCase, AWallThatBeginsElsewhereIsWarnedOf) {
  EXPECT_EQ(
      warnings_of(changed("[grain]\n",
                          "[wall.body.motion]\nkind = \"formula\"\n"
                          "displacement = [\"0.01*cos(t)\", 0, 0]\n[grain]\n")),
      (std::vector<std::string>{"wall.body \"tank\": its motion begins 0.01 m away from where fluid and "
                                "grains start for it"}));
}

TEST(MotionCase, FormulasAreInTAndHaveValues) {
  const std::string from = "[grain]\n";
  const auto moving = [&](const std::string& text) {
    return changed(from, "[wall.body.motion]\nkind = \"formula\"\n" + text + "\n" + from);
  };
  const Config c =
      read(moving("displacement = [\"0.02*(1-cos(2*pi*3*t))\", 0, 0]\nrotation = [0, \"20*sin(t)\", 0]\n"
                  "centre = [0.1, 0, 0.1]"));
  EXPECT_EQ(c.wall.bodies[0].motion.rotation[1], "20*sin(t)");
  EXPECT_EQ(error_of(moving("displacement = [\"x\", 0, 0]")),
            "dam.toml:17: wall.body.motion.displacement = [\"x\", 0, 0] must hold formulas in t: Unexpected "
            "token \"x\" found at position 0");
  EXPECT_EQ(error_of(moving("displacement = [\"1/(t-0.1)^0.5\", 0, 0]")),
            "dam.toml:17: wall.body.motion.displacement = [\"1/(t-0.1)^0.5\", 0, 0] must be finite at all "
            "times, as "
            "must its rates; it is not at t = 0 s");
}

TEST(MotionCase, RatesMayRampByAFactor) {
  const auto turning = [](const std::string& factor) {
    return changed("[grain]\n",
                   "[wall.body.motion]\nkind = \"rotation\"\naxis = [0, 1, 0]\ncentre = [0, 0, 0]\n"
                   "rate = \"60 rpm\"\nstart = 0.1\nfactor = \"" +
                       factor + "\"\n[grain]\n");
  };
  const Config c = read(turning("min(1, t/0.05)"));
  const auto& m = c.wall.bodies[0].motion;
  EXPECT_EQ(m.factor, "min(1, t/0.05)");
  EXPECT_NEAR(MotionLaw(m, 1).at(0.125).omega.y, M_PI, 1e-12) << "t counts from the start";
  EXPECT_TRUE(read(resolved_toml(c)) == c);
  EXPECT_TRUE(warnings_of(turning("min(1, t/0.05)")).empty()) << "it starts from rest";
  EXPECT_EQ(warnings_of(turning("t < 0.05 ? t/0.05 : 0")).size(), 1u) << "and stops at once";
  EXPECT_EQ(error_of(turning("x")),
            "dam.toml:21: wall.body.motion.factor = \"x\" must be a formula in t: Unexpected token \"x\" "
            "found at position 0");
  EXPECT_EQ(error_of(turning("sqrt(0.1-t)")),
            "dam.toml:21: wall.body.motion.factor = \"sqrt(0.1-t)\" must be finite at all times; it is not "
            "at t = 0.2001 s");
}

TEST(MotionCase, SoundSpeedFollowsTheFastestWall) {
  const std::string from = "[grain]\n";
  const auto vmax = [&](const std::string& text) {
    return read(changed(from, "[wall.body.motion]\n" + text + "\n" + from)).fluid.vmax;
  };
  EXPECT_NEAR(vmax("kind = \"formula\"\ndisplacement = [\"0.1*sin(40*t)\", 0, 0]"), 4, 1e-6);
  EXPECT_NEAR(vmax("kind = \"table\"\nrows = [[0, 0, 0, 0], [0.1, 0.3, 0, 0]]"), 3, 1e-9);
  EXPECT_NEAR(vmax("kind = \"velocity\"\nvelocity = [2, 0, 0]\nfactor = \"3*t/0.3\""), 6, 1e-9);
  EXPECT_NEAR(vmax("kind = \"velocity\"\nvelocity = [2, 0, 0]\n"
                   "[[wall.body.motion.add]]\nkind = \"velocity\"\nvelocity = [1, 0, 0]"),
              3, 1e-12);
}

TEST(MotionCase, SumsReadBack) {
  const Config c =
      read(changed("[grain]\n",
                   "[wall.body.motion]\nkind = \"rotation\"\naxis = [0, 0, 2]\n"
                   "centre = [0.1, 0, 0]\nrate = 2\nstart = 0.1\n"
                   "[[wall.body.motion.add]]\nkind = \"oscillation\"\namplitude = [0, 0, 0.01]\n"
                   "frequency = 3\n"
                   "[[wall.body.motion.add]]\nkind = \"formula\"\ndisplacement = [\"t^2\", 0, 0]\n"
                   "[grain]\n"));
  const auto& m = c.wall.bodies[0].motion;
  ASSERT_EQ(m.add.size(), 2u);
  EXPECT_EQ(m.add[0].kind, "oscillation");
  EXPECT_EQ(m.axis, (Vec3d{0, 0, 1}));
  const std::string text = resolved_toml(c);
  EXPECT_TRUE(read(text) == c) << text;
}

const std::string kShaken =
    "[frame.motion]\nkind = \"oscillation\"\namplitude = [7.1e-3, 0, 0]\nfrequency = 4.06\n";

TEST(FrameCase, RaisesTheSpeedsExpected) {
  const Config still = read(kCase), shaken = read(kCase + kShaken);
  EXPECT_EQ(still.frame.acceleration, 0);
  EXPECT_NEAR(shaken.frame.acceleration, 4.6203, 1e-4);
  // gravity askew reaches across the fluid: g x is largest from corner to corner
  EXPECT_NEAR(shaken.fluid.vmax, std::sqrt(2 * (9.81 * 0.1 + 4.6203 * 0.05)), 1e-4);
  EXPECT_EQ(shaken.fluid.depth, still.fluid.depth);
  const Config weightless = read(kCase + kShaken, {"gravity=[0, 0, 0]"});
  EXPECT_NEAR(weightless.fluid.vmax, std::sqrt(2 * 4.6203 * 0.05), 1e-4);
  EXPECT_TRUE(read(resolved_toml(shaken)) == shaken);
}

TEST(FrameCase, BeginsWithItsContentsAndMayNotTurn) {
  EXPECT_TRUE(warnings_of(kCase + kShaken).empty()) << "no blow at t = 0";
  EXPECT_EQ(warnings_of(kCase + kShaken + "start = 0.1\n"),
            (std::vector<std::string>{"frame.motion: its velocity jumps by 0.1811 m/s at t = 0.1 s; it "
                                      "does not act on what is inside"}));
  const std::string must = " must not turn; a frame can only be translated";
  EXPECT_EQ(
      error_of(kCase + "[frame.motion]\nkind = \"rotation\"\naxis = [0, 0, 1]\ncentre = [0, 0, 0]\nrate = 1"),
      "dam.toml:26: frame.motion.kind = \"rotation\"" + must);
  EXPECT_EQ(error_of(kCase + "[frame.motion]\nkind = \"formula\"\nrotation = [0, 0, \"3*t\"]\n"),
            "dam.toml:27: frame.motion.rotation = [0, 0, 3*t]" + must);
  EXPECT_EQ(
      error_of(kCase + kShaken +
               "[[frame.motion.add]]\nkind = \"table\"\nrows = [[0, 0, 0, 0], [1, 0, 0, 0, 0, 0, 9]]\n"),
      "dam.toml:30: frame.motion.add.kind = a table with rx, ry, rz = 0, 0, 9 deg" + must);
  EXPECT_EQ(error_of(kCase +
                     "[frame.motion]\nkind = \"velocity\"\nvelocity = [1, 0, 0]\nremove_when_clear = true\n"),
            "dam.toml:28: frame.motion.remove_when_clear is not a parameter; did you mean "
            "wall.body.motion.remove_when_clear?");
}

TEST_F(TableCase, WaveMakersMoveAlongTheirWaves) {
  const std::string wave =
      "wave_height = 0.01\nwave_period = 1\nwave_depth = 0.1\nwave_direction = [0, -2, 5]\nwave_ramp = 0\n";
  const Config piston = read(moving("kind = \"piston\"\n" + wave));
  const auto at = MotionLaw(piston.wall.bodies[0].motion, 1).at(0.25).place({});
  EXPECT_EQ(at.x, 0);
  EXPECT_LT(at.y, -1e-3);
  EXPECT_NEAR(at.z, 0, 1e-15);
  const Config flap = read(moving("kind = \"flap\"\ncentre = [0, 0.02, 0]\n" + wave));
  const auto top = MotionLaw(flap.wall.bodies[0].motion, 1).at(0.25).place({0, 0.02, 0.1});
  EXPECT_LT(top.y, 0.02 - 1e-3);
  EXPECT_NEAR(top.x, 0, 1e-15);
  Config again = read(resolved_toml(flap));
  again.file = flap.file;
  EXPECT_EQ(flap, again);

  const auto refused = [&](const std::string& kind, double height, const std::string& more = "") {
    return error_of(moving("kind = \"" + kind + "\"\nwave_height = " + std::to_string(height) +
                           "\nwave_period = 1\nwave_depth = 0.1\n" + more));
  };
  EXPECT_NE(refused("piston", 0.5).find("wave_height = 0.5 must be below 0.07"), std::string::npos);
  EXPECT_NE(refused("piston", 0.05).find("up to which second-order theory holds"), std::string::npos);
  EXPECT_EQ(refused("piston", 0.05, "wave_order = 1\n"), "");
  EXPECT_NE(refused("flap", 0.05, "centre = [0, 0, 0]\n").find("up to which second-order theory holds"),
            std::string::npos);
  EXPECT_EQ(refused("flap", 0.05, "centre = [0, 0, 0]\nwave_order = 1\n"), "");
  EXPECT_NE(error_of(moving("kind = \"piston\"\nwave_height = 0.004\nwave_period = 0.2\nwave_depth = 0.2\n"))
                .find("wave_depth = 0.2 must be at most 0.1874 m, 3 wavelengths, with wave_order = 2"),
            std::string::npos);
  for (const auto& [period, key] : {std::pair{"1e-300", "wave_depth"}, {"1e300", "wave_period"}})
    for (const char* order : {"1", "2"})
      EXPECT_NE(error_of(moving(fmt::format("kind = \"piston\"\nwave_height = 0.004\nwave_period = {}\n"
                                            "wave_depth = 0.2\nwave_order = {}\n",
                                            period, order)))
                    .find(fmt::format("wall.body.motion.{} = ", key)),
                std::string::npos);
  EXPECT_NE(refused("piston", 0.01, "wave_direction = [0, 0, 1]\n").find("must not be vertical"),
            std::string::npos);
  EXPECT_NE(refused("flap", 0.01).find("motion.centre"), std::string::npos);
}

}  // namespace
}  // namespace bedload::test
