// `bedload viscometer` as a user runs it: T-45, and what it refuses.

#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace bedload::test {
namespace {

/// Driven one way below z = 10, the other way above; D = 10 = 20 spacings of WCSPH, 4 h of SDPD.
constexpr const char* kReverse = R"(title = "Reverse Poiseuille"
gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [7, 7, 20]
periodic = [true, true, true]
[fluid]
dx = 1
rho0 = 1
mu = 2
vmax = 1
[[fluid.fill]]
min = [0, 0, 0]
max = [7, 7, 20]
[drive]
f = [0.02, 0, 0]
mode = "mass"
opposed = "z"
[time]
end = 72
[out]
every = 72
)";

constexpr const char* kSdpd = R"([eos]
type = "democritus"
p0 = 14.285714
alpha = 7
beta = 14.285714
[sdpd]
kI = 0.4
)";

/// Between walls 10 apart.
std::string walled() {
  std::string text = kReverse;
  const auto change = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  change("min = [0, 0, 0]", "min = [0, 0, -4]");
  change("max = [7, 7, 20]", "max = [7, 7, 14]");
  change("true]", "false]");
  change("max = [7, 7, 20]", "max = [7, 7, 10]");
  change("opposed = \"z\"\n", "");
  return text + R"([[wall.body]]
name = "channel"
shape = "tank"
min = [0, 0, 0]
max = [7, 7, 10]
faces = ["z-", "z+"]
)";
}

/// Between images 7 apart that move at 1.4 against each other; the fluid starts at rest.
std::string between_images() {
  std::string text = kReverse;
  for (std::size_t at; (at = text.find("20]")) != std::string::npos;) text.replace(at, 2, "7");
  text.replace(text.find("[drive]"), text.find("[time]") - text.find("[drive]"), "");
  text.replace(text.find("end = 72"), 8, "end = 12");
  return text.replace(text.find("periodic"), 0, "shear_rate = 0.2\n");
}

class ViscometerTest : public ProgramTest {
 protected:
  nlohmann::json measured(const std::string& text, const std::string& options = "") {
    write("flow.toml", text);
    const Outcome o = bedload("viscometer flow.toml --out run --overwrite --quiet " + options);
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("viscosity  "), o.out.npos) << o.out;
    return nlohmann::json::parse(content_of(dir_ / "run" / "summary.json"))["viscometer"];
  }
  static double value(const nlohmann::json& all, const char* name) { return all[name]["value"]; }
};

TEST_F(ViscometerTest, FindsTheViscosityOfWcsph) {  // T-45
  const auto m = measured(kReverse);
  EXPECT_NEAR(value(m, "viscosity") / 2, 1, 0.03);
  EXPECT_EQ(m["viscosity"]["unit"], "Pa s");
  EXPECT_LT(value(m, "viscosity_error"), 0.02);
  EXPECT_NEAR(value(m, "shear_stress_over_imposed"), 1, 0.01);
  EXPECT_NEAR(value(m, "force_density"), 0.02, 2e-4);
  for (const char* name : {"profile.csv", "result.csv", "stress.csv", "profile.png"})
    EXPECT_TRUE(std::filesystem::exists(dir_ / "run" / "viscometer" / name)) << name;
  const std::string stress = content_of(dir_ / "run" / "viscometer" / "stress.csv");
  EXPECT_EQ(stress.substr(0, stress.find('\n')).find("part,stress_xx [Pa],stress_xy [Pa]"), 0u);
}

TEST_F(ViscometerTest, FindsTheViscosityOfSdpd) {  // T-45
  const auto m = measured(std::string(kReverse) + kSdpd,
                          "--set fluid.model=sdpd_a --set fluid.kernel=lucy --set fluid.h_over_dx=2.5 "
                          "--set time.friction=0.4");
  EXPECT_NEAR(value(m, "viscosity") / 2, 1, 0.03);
  EXPECT_NEAR(value(m, "shear_stress_over_imposed"), 1, 0.02);
}

TEST_F(ViscometerTest, FindsItBetweenWallsToo) {
  const auto driven = measured(walled());
  EXPECT_NEAR(value(driven, "viscosity") / 2, 1, 0.02);
  EXPECT_LT(std::abs(value(driven, "slip_length")), 0.25);
  EXPECT_LT(std::abs(value(driven, "offset")), 0.01);

  std::string sheared = walled();
  sheared.replace(sheared.find("f = [0.02"), 9, "f = [0.00");
  sheared.replace(sheared.find("shape = \"tank\""), std::string::npos, R"(shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
[[wall.body]]
name = "lid"
shape = "plane"
point = [0, 0, 10]
normal = [0, 0, -1]
surface_velocity = [0.3, 0, 0]
)");
  const auto couette = measured(sheared);
  EXPECT_NEAR(value(couette, "viscosity") / 2, 1, 0.02);
  EXPECT_NEAR(value(couette, "wall_shear_stress"), 2 * 0.03, 2 * 0.03 * 0.03);
  EXPECT_NEAR(value(couette, "shear_stress_over_imposed"), 1, 0.01);
}

TEST_F(ViscometerTest, FindsItBetweenImagesThatMove) {
  for (const std::string options :
       {"--set fluid.h_over_dx=1.2",
        "--set fluid.model=sdpd_a --set fluid.kernel=lucy --set fluid.h_over_dx=2.5 "
        "--set time.friction=0.4"}) {
    const auto m = measured(between_images() + (options.find("sdpd") == options.npos ? "" : kSdpd), options);
    EXPECT_NEAR(value(m, "viscosity") / 2, 1, 0.03) << options;
    EXPECT_NEAR(value(m, "shear_stress"), 0.2 * value(m, "viscosity"), 1e-6) << options;
    EXPECT_GT(value(m, "r_squared"), 0.99) << options;
  }
}

/// Of fluid on nodes that flows around a grain: a column of the result.
TEST_F(ViscometerTest, FindsTheRelativeViscosityOfGrainsOnALattice) {
  const std::string fluid = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.012, 0.012, 0.014]
periodic = [true, true, false]
[fluid]
model = "lattice"
dx = 0.001
mu = 0.05
[[wall.body]]
name = "lower"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
[[wall.body]]
name = "upper"
shape = "plane"
point = [0, 0, 0.014]
normal = [0, 0, -1]
surface_velocity = [0.01, 0, 0]
[time]
end = 5.6
[out]
every = 5.6
)";
  const auto bare = measured(fluid);
  EXPECT_NEAR(value(bare, "viscosity") / 0.05, 1, 1e-3);
  EXPECT_NEAR(value(bare, "shear_stress_over_imposed"), 1, 1e-3);
  EXPECT_FALSE(bare.contains("relative_viscosity"));

  const auto m = measured(fluid +
                          "[grain]\nd = 0.0055\n[contact]\nnormal = \"linear\"\nk = 10\n"
                          "[[grain.fill]]\npositions = [[0.0063, 0.0058, 0.0071]]\n");
  const double phi = value(m, "grain_concentration");
  EXPECT_NEAR(phi, M_PI / 6 * 0.166375 / (1.2 * 1.2 * 1.4), 1e-6);
  EXPECT_GT(value(m, "relative_viscosity"), 1 + 2 * phi);
  EXPECT_NEAR(value(m, "relative_viscosity"), value(m, "viscosity") / 0.05, 1e-9);
  EXPECT_NEAR(value(m, "shear_stress_over_imposed"), 1, 0.02);
  EXPECT_NE(content_of(dir_ / "run" / "viscometer" / "stress.csv").find("\nparticles,"), std::string::npos);
}

TEST_F(ViscometerTest, RefusesWithASentence) {
  write("flow.toml", kReverse);
  const auto refused = [&](const std::string& options, const std::string& why) {
    const Outcome o = bedload("viscometer flow.toml --out run " + options);
    EXPECT_EQ(o.code, 2) << why;
    EXPECT_NE(o.err.find(why), o.err.npos) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_FALSE(std::filesystem::exists(dir_ / "run")) << why;
  };
  refused("--set drive.opposed=none", "drive.opposed: the case has neither walls nor an opposed drive");
  refused("--until 5", "time.end = 5 must be >= 70.92 in a viscometer");
  refused("--relative", "--relative: flow.toml has no grains");
  refused("--restart latest", "cannot restart from a checkpoint");
}

TEST_F(ViscometerTest, TellsNoViscosityOfFluidThatHasNone) {  // and so moves as two plugs, ever faster
  write("flow.toml", kReverse);
  const Outcome o =
      bedload("viscometer flow.toml --out run --quiet --set visc.model=none --set fluid.c_factor=50");
  EXPECT_EQ(o.code, 5);
  EXPECT_NE(o.err.find("viscosity not reported"), o.err.npos) << o.err;
  const auto m = nlohmann::json::parse(content_of(dir_ / "run" / "summary.json"))["viscometer"];
  EXPECT_FALSE(m.contains("viscosity"));
  EXPECT_LT(m["r_squared"]["value"], 0.95);
}

/// Before anything is run.
TEST_F(ViscometerTest, CheckTellsWhatItTakesAndRefuses) {
  const auto check = [&](const std::string& settings) {
    write("flow.toml", kReverse);
    return bedload("check flow.toml --backend cpu " + settings).out;
  };
  const std::string taken = check("");
  EXPECT_NE(taken.find("viscometer reverse Poiseuille flow; run `bedload viscometer`"), taken.npos) << taken;
  EXPECT_EQ(taken.find("cavitates at negative"), taken.npos) << taken;
  EXPECT_NE(
      check("--set time.end=20").find("not suitable for `bedload viscometer`: time.end = 20 must be >= "),
      std::string::npos);
  EXPECT_NE(check("--set visc.alpha=0.1")
                .find("not suitable for `bedload viscometer`: visc.alpha: artificial viscosity must be 0"),
            std::string::npos);
}

}  // namespace
}  // namespace bedload::test
