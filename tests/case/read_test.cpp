#include "bedload/case/read.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "bedload/case/parameters.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

TEST(ReadCase, TakesDefaultsFromThePhysics) {
  const Config c = read(kCase);
  EXPECT_EQ(c.title, "dam");
  EXPECT_DOUBLE_EQ(c.fluid.h_over_dx, 1.5);
  EXPECT_EQ(c.fluid.kernel, "wendland_c2");
  EXPECT_DOUBLE_EQ(c.density.delta, 0.1);
  EXPECT_EQ(c.couple.drag, "di_felice");
  EXPECT_EQ(c.contact.rolling, "epsd");
  EXPECT_EQ(c.time.integrator, "kdk");
  EXPECT_EQ(c.precision, "mixed");
  EXPECT_EQ(c.gravity, (Vec3d{0, 0, -9.81}));
}

TEST(ReadCase, ResolvesWhatFollowsFromTheRest) {
  const Config c = read(kCase);
  EXPECT_DOUBLE_EQ(c.fluid.depth, 0.1);
  EXPECT_DOUBLE_EQ(c.fluid.vmax, std::sqrt(2 * 9.81 * 0.1));
  EXPECT_DOUBLE_EQ(c.fluid.c, 10 * c.fluid.vmax);
  EXPECT_DOUBLE_EQ(c.wall.dx, 0.004);
  EXPECT_DOUBLE_EQ(c.wall.rep_D, 5 * 9.81 * 0.1);
  EXPECT_DOUBLE_EQ(c.wall.rep_r0, 0.002);
  EXPECT_DOUBLE_EQ(c.couple.hc, 0.006);  // h = 6 mm exceeds 2 d = 4 mm
  EXPECT_DOUBLE_EQ(c.grain.d_max, 0.002);
  EXPECT_DOUBLE_EQ(c.out.diagnostics_every, 0.01);
  EXPECT_DOUBLE_EQ(read(changed("d = 0.002", "d = 0.004")).couple.hc, 0.008);
}

TEST(ReadCase, GrainsOfUnlikeSizesHaveTheirOwnAveragingLengths) {
  const auto sizes = [](const std::string& smaller, const std::vector<std::string>& set = {}) {
    return read(changed("count = 500", "count = 500\nsizes = [{ d = 0.008 }, { d = " + smaller + " }]"), set);
  };
  const Config like = sizes("0.0041"), unlike = sizes("0.004"), one = sizes("0.004", {"couple.own_hc=false"});
  EXPECT_FALSE(like.own_lengths());
  EXPECT_DOUBLE_EQ(like.couple.hc, 0.016);  // 2 d_max
  EXPECT_TRUE(unlike.own_lengths());
  EXPECT_DOUBLE_EQ(unlike.couple.hc, 0.008);  // 2 d_min
  EXPECT_DOUBLE_EQ(unlike.farthest_average(), 0.032);
  EXPECT_FALSE(one.own_lengths());
  EXPECT_DOUBLE_EQ(one.couple.hc, 0.016);
}

TEST(ReadCase, SoundSpeedFollowsTheFastestOfUserDepthAndWalls) {
  EXPECT_DOUBLE_EQ(read(kCase, {"fluid.vmax=3"}).fluid.c, 30);
  EXPECT_DOUBLE_EQ(read(kCase, {"fluid.vmax=0.1"}).fluid.vmax, std::sqrt(2 * 9.81 * 0.1));
  const auto moving = [](const std::string& motion) {
    return read(changed("[grain]\n", "[wall.body.motion]\n" + motion + "\n[grain]\n")).fluid.vmax;
  };
  EXPECT_DOUBLE_EQ(moving("kind = \"velocity\"\nvelocity = [0, 0, 2]"), 2);
  EXPECT_NEAR(moving("kind = \"oscillation\"\namplitude = [0.1, 0, 0]\nfrequency = 4"), 2.51327, 1e-5);
  // The outermost corner of the tank is sqrt(0.1^2 + 0.1^2) from the axis.
  EXPECT_NEAR(moving("kind = \"rotation\"\naxis = [0, 5, 0]\ncentre = [0.1, 0, 0.1]\nrate = 20"), 2.82843,
              1e-5);
}

TEST(ReadCase, DemocritusEquationDerivesItsSoundSpeed) {
  const Config c = read(kCase, {"eos.type=democritus", "eos.p0=4000", "eos.alpha=7"});
  EXPECT_DOUBLE_EQ(c.fluid.c, std::sqrt(7 * 4000.0 / 1000));
}

TEST(ReadCase, DepthIsMeasuredAlongGravity) {
  EXPECT_NEAR(read(kCase, {"gravity=[-9.81, 0, 0]"}).fluid.depth, 0.05, 1e-15);
  EXPECT_NEAR(read(kCase, {"gravity=[-1, 0, -1]"}).fluid.depth, 0.15 / std::sqrt(2), 1e-15);
}

TEST(ReadCase, HonoursPresetsUnderTheCasesOwnKeys) {
  const Config he = read("preset = \"he2018\"\n" + kCase);
  EXPECT_DOUBLE_EQ(he.fluid.h_over_dx, 1.3);
  EXPECT_DOUBLE_EQ(he.xsph, 0.3);
  EXPECT_DOUBLE_EQ(he.tensile, 1);
  EXPECT_TRUE(he.tensile_one_sign);
  EXPECT_DOUBLE_EQ(he.density.delta, 0);
  EXPECT_EQ(he.contact.tangential, "mindlin_deresiewicz");
  EXPECT_TRUE(he.contact.he_damping);
  EXPECT_FALSE(he.contact.clip_tension);
  EXPECT_TRUE(he.contact.cap_rolling);
  EXPECT_EQ(he.contact.rolling, "cdt");
  EXPECT_EQ(he.couple.drag, "gidaspow");
  EXPECT_EQ(he.couple.integrator, "explicit");
  EXPECT_FALSE(he.couple.torque);
  EXPECT_EQ(he.time.integrator, "euler");
  ASSERT_EQ(he.wall.bodies.size(), 1u);
  EXPECT_TRUE(he.wall.bodies[0].repulsion);
  EXPECT_DOUBLE_EQ(read("preset = \"he2018\"\n" + kCase, {"drag.law=ergun"}).fluid.h_over_dx, 1.3);
  EXPECT_EQ(read("preset = \"he2018\"\n" + kCase, {"drag.law=ergun"}).couple.drag, "ergun");
}

TEST(ReadCase, RobinsonHasLengthsOfItsOwn) {
  const Config c = read("preset = \"robinson2014\"\n" + kCase, {"contact.k=1000"});
  EXPECT_TRUE(c.fluid.variable_h);
  EXPECT_DOUBLE_EQ(c.fluid.h(), 1.5 * 0.004);
  EXPECT_EQ(c.fluid.kernel, "cubic");
  EXPECT_EQ(c.visc.model, "signal");
  EXPECT_EQ(c.wall.bodies[0].type, "single_layer");
  EXPECT_EQ(c.contact.normal, "linear");
  EXPECT_EQ(c.contact.tangential, "none");
  EXPECT_DOUBLE_EQ(c.density.delta, 0);
  EXPECT_DOUBLE_EQ(c.shift, 0);
  EXPECT_NEAR(c.couple.S_dry, c.couple.S_wet, 0.01) << "grains dry in a step";
  const Config constant =
      read("preset = \"robinson2014\"\n" + kCase, {"contact.k=1000", "fluid.variable_h=false"});
  EXPECT_DOUBLE_EQ(constant.shift, 200);
  EXPECT_DOUBLE_EQ(read(kCase, {"fluid.variable_h=true"}).shift, 0);
}

TEST(ReadCase, BodiesInheritFromWall) {
  const Config c =
      read(changed("[[wall.body]]", "[wall]\nslip = \"slip\"\nrepulsion = false\n[[wall.body]]"));
  EXPECT_EQ(c.wall.bodies[0].slip, "slip");
  EXPECT_FALSE(c.wall.bodies[0].repulsion);
  const Config own =
      read(changed("name = \"tank\"", "name = \"tank\"\nslip = \"noslip\""), {"wall.slip=slip"});
  EXPECT_EQ(own.wall.bodies[0].slip, "noslip");
}

TEST(ReadCase, ReadsFacesProbesSizesAndFormulas) {
  const Config c =
      read(changed("shape = \"tank\"", "shape = \"tank\"\nfaces = [\"x-\", \"z-\"]") +
               "[[probe]]\nname = \"toe\"\ntype = \"front\"\nphase = \"grains\"\ndirection = \"z-\"\n"
               "[[probe]]\nname = \"lift\"\ntype = \"force\"\nbody = \"tank\"\nevery = 0.002\n",
           {"fluid.fill.0.velocity=[1, \"-0.5*z\", \"sin(pi*x)\"]",
            "grain.fill.0.sizes=[{d = 0.001}, {d = 0.002, number_fraction = 3}]"});
  EXPECT_EQ(c.wall.bodies[0].faces, (std::array<bool, 6>{true, false, false, false, true, false}));
  ASSERT_EQ(c.out.probes.size(), 2u);
  EXPECT_EQ(c.out.probes[0].axis, 2);
  EXPECT_EQ(c.out.probes[0].sign, -1);
  EXPECT_DOUBLE_EQ(c.out.probes[0].every, 0.01);
  EXPECT_DOUBLE_EQ(c.out.probes[1].every, 0.002);
  EXPECT_EQ(c.fluid.fills[0].velocity, (std::array<std::string, 3>{"1", "-0.5*z", "sin(pi*x)"}));
  ASSERT_EQ(c.grain.fills[0].sizes.size(), 2u);
  EXPECT_DOUBLE_EQ(c.grain.fills[0].sizes[1].number_fraction, 3);
  EXPECT_DOUBLE_EQ(c.grain.d_min, 0.001);
}

TEST(ReadCase, OverridesWinAndTakeBareWords) {
  const Config c = read(kCase, {"grain.e=0.5", "contact.rolling = cdt", "grain.fill.0.count=7", "run.seed=9",
                                "visc.alpha=0.02", "domain.periodic=[false, true, false]"});
  EXPECT_DOUBLE_EQ(c.grain.e, 0.5);
  EXPECT_EQ(c.contact.rolling, "cdt");
  EXPECT_EQ(c.grain.fills[0].count, 7);
  EXPECT_EQ(c.seed, 9u);
  EXPECT_EQ(c.grain.seed, 9u);
  EXPECT_DOUBLE_EQ(c.visc.alpha, 0.02);
  EXPECT_TRUE(c.domain.periodic[1]);
  EXPECT_EQ(read(kCase, {"title=../meshes/none-2.stl"}).title, "../meshes/none-2.stl");
}

TEST(ReadCase, GrainsAloneNeedNoFluid) {
  const auto from = kCase.find("[fluid]"), to = kCase.find("[[wall.body]]");
  const Config c = read(kCase.substr(0, from) + kCase.substr(to));
  EXPECT_FALSE(c.fluid.present);
  EXPECT_TRUE(c.grain.present);
}

TEST(ResolvedToml, ReadsBackToTheSameCase) {
  const std::string rich =
      changed("[[grain.fill]]",
              "settle = true\n[[grain.fill]]\npositions = [[0.1, 0.05, 0.03]]\n[[grain.fill]]") +
      "[[probe]]\nname = \"p\"\ntype = \"box\"\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\n";
  const std::vector<std::vector<std::string>> variations = {
      {},
      {"preset=he2018"},
      {"preset=robinson2014", "contact.k=1000", "fluid.sigma_h=1.4"},
      {"run.precision=double", "visc.alpha=0.1", "gravity=[0.3, 0.1, -9.7]"},
      {"title=\"a \\\"quoted\\\" \\\\ name\"", "contact.normal=linear", "contact.k=1e4", "fluid.kernel=lucy",
       "fluid.h_over_dx=3"},
      {"wall.body.0.motion={kind=\"rotation\", axis=[1, 2, 3], centre=[0.1, 0.1, 0.1], rate=3.3, stop=2}"},
  };
  for (const auto& overrides : variations) {
    const Config c = read(rich, overrides);
    const std::string text = resolved_toml(c);
    const Config again = read(text);
    EXPECT_TRUE(again == c) << text;
    EXPECT_EQ(resolved_toml(again), text);
  }
}

TEST(SettlingCase, ForgetsWhatSettlingDoesNotDependOn) {
  const auto key = [](const std::vector<std::string>& overrides) {
    return resolved_toml(settling_case(read(kCase, overrides)));
  };
  EXPECT_EQ(key({}), key({"fluid.mu=0.01", "fluid.dx=0.005", "time.end=9", "drag.law=ergun", "out.every=1",
                          "wall.body.0.surface_velocity=[1, 0, 0]"}));
  for (const char* relevant :
       {"grain.e=0.5", "run.seed=2", "contact.rolling=none", "gravity=[0, 0, -1.6]", "grain.fill.0.count=499",
        "wall.body.0.max=[0.2, 0.1, 0.19]", "run.precision=double"})
    EXPECT_NE(key({}), key({relevant})) << relevant;
  EXPECT_EQ(key({"grain.settle_mu=0.1", "grain.mu=0.4"}), key({"grain.mu=0.1"}));
}

/// Keys of the version before are read, from files and --set, and warned of where they stand.
TEST(RenamedKeys, AreReadWithAWarning) {
  const std::string sizes =
      changed("count = 500", "count = 500\nsizes = [{d = 0.002}, {d = 0.001, share = 3}]");
  std::vector<std::string> warnings;
  Config c = read_case_text(sizes, "dam.toml", {"density.tension=0.02"}, warnings);
  EXPECT_EQ(c.grain.fills[0].sizes[1].number_fraction, 3);
  EXPECT_EQ(c.density.cavitation_limit, 0.02);
  EXPECT_EQ(
      warnings,
      (std::vector<std::string>{
          "--set density.tension=0.02: density.tension is now called density.cavitation_limit; the next "
          "version will not read the former name",
          "dam.toml:21: grain.fill.sizes.share is now called grain.fill.sizes.number_fraction; the next "
          "version will not read the former name"}));
  EXPECT_EQ(resolved_toml(c).find("share"), std::string::npos);

  // what wins does not depend on which name it has
  const std::string before = changed("[grain]", "[density]\ntension = 0.03\n[grain]");
  const std::string now = changed("[grain]", "[density]\ncavitation_limit = 0.03\n[grain]");
  for (const std::string& text : {before, now})
    for (const char* override : {"density.tension=0.04", "density.cavitation_limit=0.04"})
      EXPECT_EQ(read(text, {override}).density.cavitation_limit, 0.04) << override;
  EXPECT_EQ(
      error_of(changed("[grain]", "[density]\ntension = 0.03\ncavitation_limit = 0.03\n[grain]")),
      "dam.toml:16: density.tension is the former name of density.cavitation_limit, which is given too; "
      "leave it out");
  EXPECT_EQ(
      error_of(kCase, {"density.tension=0.03", "density.cavitation_limit=0.04"}),
      "--set density.tension=0.03: density.tension is the former name of density.cavitation_limit, which "
      "is given too; leave it out");
  EXPECT_EQ(error_of(changed("[grain]", "[density]\ntension = 2\n[grain]")),
            "dam.toml:16: density.cavitation_limit = 2 must be within 0.0001..0.5");
  // nor is a run that goes on one of another case
  EXPECT_TRUE(changes_between(before, now).empty());
}

/// Errors that come up later than reading still tell where the case gives a key.
TEST(Places, AreThoseOfTheDeepestPartThatTheCaseGives) {
  const Places places = read(kCase, {"grain.fill.0.count=400", "couple.hc=0.01"}).places;
  EXPECT_EQ(places.of("fluid.dx"), "dam.toml:6");
  EXPECT_EQ(places.of("wall.body.0.min"), "dam.toml:13");
  EXPECT_EQ(places.of("fluid.fill.0.velocity"), "dam.toml:7") << "not given: its table";
  EXPECT_EQ(places.of("fluid.fill.0.max.2"), "dam.toml:9") << "a number of a list";
  EXPECT_EQ(places.of("grain.fill.0.count"), "--set grain.fill.0.count=400");
  EXPECT_EQ(places.of("couple.hc"), "--set couple.hc=0.01");
  EXPECT_EQ(places.of("drag.law"), "dam.toml") << "no table of it either";
  EXPECT_EQ(places.of("inlet.3"), "dam.toml");
}

TEST(Places, BeginWhatAKeyErrorSays) {
  const Config c = read(kCase);
  const auto message = [&](const auto& f) -> std::string {
    try {
      placed(c.places, f);
    } catch (const KeyError&) {
      return "still a KeyError";
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([] { throw KeyError("fluid.dx", "fluid.dx is wrong"); }),
            "dam.toml:6: fluid.dx is wrong");
  EXPECT_EQ(message([] { throw CaseError("a table is wrong"); }), "a table is wrong");
  EXPECT_EQ(message([] {}), "");
}

/// What of the case sets defaults of others, however it is written.
TEST(Defaults, FollowTheModelAndVariableH) {
  for (const char* yes : {"true", "1"}) {
    const Config c = read(changed("dx = 0.004", std::string("dx = 0.004\nvariable_h = ") + yes));
    EXPECT_TRUE(c.fluid.variable_h) << yes;
    EXPECT_EQ(c.shift, 0) << yes;
    EXPECT_FALSE(c.pressure.linear_exact) << yes;
  }
  EXPECT_EQ(read(kCase, {"preset=he2018"}).time.integrator, TimeIntegrator::euler);
  EXPECT_EQ(read(kCase, {"preset=he2018", "fluid.model=sdpd"}).time.integrator, TimeIntegrator::kdk);
  EXPECT_EQ(error_of(kCase, {"preset=he2019"}),
            "--set preset=he2019: preset = \"he2019\" must be one of default, he2018, democritus, "
            "robinson2014");
}

TEST(Warnings, TellThatEnergyConsistentWallsNeedSuction) {
  const auto with = [](const std::string& keys) {
    return warnings_of(changed("[[wall.body]]", "[wall]\n" + keys + "[[wall.body]]"));
  };
  EXPECT_EQ(
      with("energy_consistent = true\n"),
      (std::vector<std::string>{"wall.energy_consistent = true: not used, since wall.suction = false"}));
  EXPECT_TRUE(with("energy_consistent = true\nsuction = true\n").empty());
  EXPECT_TRUE(with("energy_consistent = false\n").empty());
  EXPECT_TRUE(warnings_of(resolved_toml(read(kCase))).empty()) << "which gives both";
}

TEST(Walls, PlanesMustRepeatWithTheDomain) {
  const std::string plane =
      "[[wall.body]]\nname = \"slope\"\nshape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0.6, 0, "
      "0.8]\n[grain]\n";
  const std::string text = changed("[grain]\n", plane);
  EXPECT_EQ(error_of(text), "");
  EXPECT_EQ(
      error_of(text, {"domain.periodic=[true, false, false]"}),
      "dam.toml:19: wall.body.normal = [0.6, 0, 0.8] must be 0 along x, in which the domain is periodic; "
      "the plane would not repeat");
  EXPECT_EQ(error_of(text, {"domain.periodic=[false, true, false]"}), "");
}

/// Frames are of floats, which are coarse far from the origin.
TEST(Warnings, TellHowFinePositionsAreWrittenFarFromTheOrigin) {
  const auto at = [](const std::string& x, const std::string& more = "") {
    std::string text = kCase + more;
    for (const std::string from : {"min = [0, 0, 0]", "max = [0.2,", "max = [0.05,"})
      for (auto found = text.find(from); found != text.npos; found = text.find(from, found + 1)) {
        const bool least = from[1] == 'i';
        text.replace(found + 7, from.size() - 7,
                     least ? x + ", 0, 0]" : x + (from.find("0.2") != from.npos ? ".2," : ".05,"));
      }
    return warnings_of(text);
  };
  EXPECT_EQ(at("20"), std::vector<std::string>{});
  EXPECT_EQ(
      at("4000"),
      std::vector<std::string>{
          "frames hold positions in steps of 0.00024 m at the far side of the domain, 4000 m from the "
          "origin, 0.12 times the smallest grain of 0.002 m; bring the case nearer to the origin, or write "
          "doubles with run.precision = \"double\""});
  EXPECT_EQ(at("4000", "[run]\nprecision = \"double\"\n"), std::vector<std::string>{});
}

TEST(Warnings, NameWhatIsDoubtful) {
  EXPECT_TRUE(warnings_of(kCase).empty());
  EXPECT_EQ(warnings_of(changed("dx = 0.004", "dx = 0.004\nc_factor = 5")),
            (std::vector<std::string>{
                "fluid.c_factor: sound is only 5 times as fast as the flow (Mach 0.2); density "
                "will vary by more than 1 %"}));
  EXPECT_EQ(warnings_of(changed("[time]", "[couple]\nhc = 0.0025\n[time]")),
            (std::vector<std::string>{
                "couple.hc: kappa h_c is 2.5 diameters of the largest grain; below 4 a grain's "
                "own wake reduces its drag"}));
  EXPECT_EQ(
      warnings_of(changed("dx = 0.004", "dx = 0.004\nvmax = \"50 cm/s\"")),
      std::vector<std::string>{"fluid.vmax = 0.5 m/s: not used, since a fall through the fluid's height, a "
                               "wall or an inlet reaches 1.4 m/s"});
  EXPECT_EQ(warnings_of(changed("name = \"tank\"", "type = \"grains_only\"\nname = \"tank\"")),
            std::vector<std::string>{"no wall.body stops the fluid, which leaves the domain along gravity"});
  EXPECT_EQ(warnings_of(changed("end = 0.3", "end = 0.3\nintegrator = \"euler\"")),
            (std::vector<std::string>{"time.integrator = \"euler\" is first order in time"}));
  EXPECT_EQ(warnings_of(changed("d = 0.002", "d = 0.002\nE = 1e4")).size(), 1u);
  EXPECT_EQ(warnings_of(changed("d = 0.002", "d = 0.002\nsettle_time = 0.1\nsettle_mu = 0.1")),
            (std::vector<std::string>{"grain.settle_time: not used, since grain.settle = false",
                                      "grain.settle_mu: not used, since grain.settle = false"}));
  EXPECT_EQ(
      warnings_of(changed("max = [0.05, 0.1, 0.1]\n[[wall",
                          "max = [0.05, 0.1, 0.1]\n"
                          "velocity = [0, 0, \"20*z\"]\n[[wall")),
      (std::vector<std::string>{"fluid.fill.velocity reaches 2 m/s, above fluid.vmax = 1.4, from which the "
                                "sound speed follows"}));
}

/// docs/howto/resolution.md: drag laws up to two spacings, free bodies from eight on.
TEST(Warnings, TellOfGrainsThatAreNeitherAveragedNorResolved) {
  const auto of = [](const char* dx) {
    return warnings_of(changed("dx = 0.004", std::string("dx = ") + dx));
  };
  EXPECT_TRUE(of("0.001").empty());
  ASSERT_EQ(of("0.0005").size(), 1u);
  EXPECT_EQ(
      of("0.0005")[0],
      "grains of 0.002 m are 4 times fluid.dx: too large for drag laws, which take what is up to 2 times as "
      "large, and too small for the fluid to flow around them, as it does from 8 times on: their volume does "
      "not displace the flow, and they have no wake; take a fluid.dx of 0.001 m or more, or 0.00025 m or "
      "less");
  const std::string fine = changed("dx = 0.004", "dx = 0.00022");
  std::vector<std::string> warnings;
  read_case_text(fine, "dam.toml", {"grain.resolve=none"}, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0],
            "grains of 0.002 m are 9.09 times fluid.dx: too large for drag laws, which take what is up to 2 "
            "times as "
            "large; let the fluid flow around them (grain.resolve), or take a fluid.dx of 0.001 m or more");
  EXPECT_TRUE(warnings_of(changed("dx = 0.004", "dx = 0.0005") + "[couple]\nmode = \"off\"\n").empty());
}

/// docs/faq.md: splashes rise higher than the column that makes them.
TEST(Warnings, TellOfADomainThatEndsAtARim) {
  const std::string open = "max = [0.2, 0.1, 0.2]\nfaces = [\"x-\", \"x+\", \"y-\", \"y+\", \"z-\"]\n[grain]";
  const auto warned = [&](std::string from = "", const std::string& to = "") {
    std::string text = changed("max = [0.2, 0.1, 0.2]\n[grain]", open);
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    const auto warnings = warnings_of(text);
    EXPECT_LE(warnings.size(), 1u);
    return !warnings.empty() && warnings[0].starts_with(
                                    "the domain ends at z = 0.2 m, at the rim of wall.body "
                                    "\"tank\" and 2 times the fluid's depth above its floor");
  };
  EXPECT_TRUE(warned());
  EXPECT_TRUE(warnings_of(kCase).empty()) << "it is closed";
  EXPECT_FALSE(warned("max = [0.2, 0.1, 0.2]\n[fluid]", "max = [0.2, 0.1, 0.25]\n[fluid]"));
  EXPECT_FALSE(
      warned("max = [0.2, 0.1, 0.2]\n[fluid]", "max = [0.2, 0.1, 0.2]\nreflect.slip = [\"z+\"]\n[fluid]"));
  EXPECT_FALSE(warned("max = [0.05, 0.1, 0.1]\n[[wall", "max = [0.05, 0.1, 0.06]\n[[wall")) << "out of reach";
  EXPECT_FALSE(warned("max = [0.05, 0.1, 0.1]\n[[wall", "max = [0.2, 0.1, 0.1]\n[[wall"))
      << "it stands still";
  EXPECT_TRUE(warned("max = [0.05, 0.1, 0.1]\n[[wall",
                     "max = [0.2, 0.1, 0.1]\nvelocity = [\"0.1\", \"0\", \"0\"]\n[[wall"));
  EXPECT_FALSE(warned(
      "[time]",
      "[[outlet]]\nname = \"top\"\nshape = \"plane\"\npoint = [0, 0, 0.2]\nnormal = [0, 0, 1]\n[time]"));
}

/// A block that hangs together across a period cannot turn.
TEST(Warnings, TellOfABlockThatFillsThePeriodAndTurns) {
  const auto warned = [](const std::string& turn) {
    std::string text = changed("max = [0.2, 0.1, 0.2]\n[fluid]",
                               "max = [0.2, 0.1, 0.2]\nperiodic = [false, true, false]\n[fluid]");
    text.replace(text.find("count = 500\n"), 12, "count = 500\n[grain.fill.rigid]\n" + turn);
    const auto warnings = warnings_of(text);
    return !warnings.empty() &&
           warnings[0].starts_with("grain.fill.rigid: the group fills the period along y");
  };
  EXPECT_TRUE(warned(""));
  EXPECT_FALSE(warned("turn = \"none\"\n"));
}

/// The surface of a belt is a wall's.
TEST(ReadCase, SoundSpeedFollowsSurfacesThatSlide) {
  EXPECT_DOUBLE_EQ(
      read(changed("name = \"tank\"", "name = \"tank\"\nsurface_velocity = [3, 0, 0]")).fluid.vmax, 3);
}

TEST(ParameterTable, HoldsEveryKeyOnceWithUnitAndMeaning) {
  const auto rows = parameter_table();
  EXPECT_GT(rows.size(), 100u);
  std::set<std::string> keys;
  for (const auto& row : rows) {
    EXPECT_TRUE(keys.insert(row.key).second) << row.key;
    EXPECT_FALSE(row.meaning.empty()) << row.key;
    EXPECT_FALSE(row.unit.empty()) << row.key;
    EXPECT_FALSE(row.fallback.empty()) << row.key;
  }
  for (const auto& row : rows)
    EXPECT_FALSE(keys.contains(row.formerly)) << "the former name of " << row.key << " is taken";
  for (const char* key :
       {"fluid.dx", "wall.body.motion.rate", "grain.fill.sizes.number_fraction", "probe.at", "drag.law"})
    EXPECT_EQ(keys.count(key), 1u) << key;
}

/// What `bedload list` shows of a key is what its type can be, `or_else` besides.
template <class E>
void expect_choices(const std::string& key, const std::string& or_else = "") {
  int seen = 0;
  for (const ParameterRow& row : parameter_table()) {
    if (row.key != key) continue;
    ++seen;
    EXPECT_EQ(row.allowed, names_of<E>() + or_else) << key;
    ASSERT_EQ(row.choices.size(), kNames<E>.size()) << key;
    for (std::size_t k = 0; k < row.choices.size(); ++k)
      EXPECT_EQ(row.choices[k].meaning, kNames<E>[k].meaning) << key;
  }
  EXPECT_EQ(seen, 1) << key;
}

TEST(ParameterTable, TakesChoicesFromTheirRegistry) {
  expect_choices<NormalLaw>("contact.normal");
  expect_choices<SlidingLaw>("contact.tangential");
  expect_choices<RollingLaw>("contact.rolling");
  expect_choices<KernelFunction>("fluid.kernel");
  expect_choices<EosType>("eos.type");
  expect_choices<ViscosityModel>("visc.model");
  expect_choices<WallType>("wall.type");
  expect_choices<WallType>("wall.body.type");
  expect_choices<WearLaw>("wall.body.wear");
  expect_choices<WallSlip>("wall.slip");
  expect_choices<LayerForce>("wall.force");
  expect_choices<CouplingMode>("couple.mode");
  expect_choices<DragSlip>("couple.slip");
  expect_choices<DragLaw>("drag.law");
  expect_choices<DragIntegrator>("drag.integrator");
  expect_choices<TimeIntegrator>("time.integrator");
  expect_choices<Preset>("preset");
  expect_choices<Precision>("run.precision");
  expect_choices<Simd>("run.simd");
  expect_choices<ShapeKind>("shape.kind");
  expect_choices<PipeEnds>("shape.ends");
  expect_choices<WallShape>("wall.body.shape", " or the name of a [[shape]]");
  for (const char* at :
       {"frame.motion.", "frame.motion.add.", "wall.body.motion.", "wall.body.motion.add."}) {
    expect_choices<MotionKind>(std::string(at) + "kind");
    expect_choices<TableSpline>(std::string(at) + "spline");
  }
  for (const char* at : {"wall.body.free.", "grain.fill.rigid."}) {
    expect_choices<BodyMove>(std::string(at) + "move");
    expect_choices<BodyTurn>(std::string(at) + "turn");
  }
  expect_choices<OrificeShape>("inlet.shape");
  expect_choices<OutletShape>("outlet.shape", " or the name of a [[shape]]");
  expect_choices<OutletPhase>("outlet.phase");
  expect_choices<GrainInletShape>("grain_inlet.shape");
  expect_choices<SizeKind>("grain.fill.sizes.kind");
  expect_choices<SizeKind>("grain_inlet.sizes.kind");
  expect_choices<ClumpDrag>("clump.drag");
  expect_choices<ProbeType>("probe.type");
  expect_choices<Phase>("probe.phase");
  expect_choices<ForceSample>("probe.sample");
  expect_choices<ContactFrames>("out.contacts");
  expect_choices<BodyTables>("out.bodies");
}

TEST(Choices, OrTheNameOfSomethingElse) {
  const ChosenOrNamed<WallShape> box("box"), drum("drum");
  EXPECT_EQ(box, WallShape::box);
  EXPECT_EQ(box.value(), WallShape::box);
  EXPECT_EQ(box, ChosenOrNamed<WallShape>(WallShape::box));
  EXPECT_FALSE(drum.choice().has_value());
  EXPECT_EQ(drum.name(), "drum");
  EXPECT_NE(drum, WallShape::box);
  EXPECT_THROW((void)drum.value(), CaseError);
}

TEST(Choices, NameThoseWithATrait) {
  EXPECT_EQ(names_with(&Named<FluidModel>::variable_h), "wcsph");
  EXPECT_EQ(names_with(&Named<FluidModel>::thermal), "sdpd or sdpd_a");
  EXPECT_EQ(names_with(&Named<WallType>::variable_h), "adami, single_layer, grains_only or fluid_only");
  EXPECT_EQ(names_with(&Named<WallType>::thermal), "adami, frozen or grains_only");
  const Chosen<FluidModel> model("sdpd");
  EXPECT_TRUE(model->own_viscosity);
  EXPECT_FALSE(model->spins);
}

/// A name that nobody listed is an error wherever it comes from, never a default.
TEST(Choices, RefuseWhatIsNotListed) {
  Config c;
  EXPECT_THROW(c.contact.normal = "hertzz", CaseError);
  EXPECT_THROW((void)(c.visc.model == "moris"), CaseError);
  EXPECT_EQ(c.contact.normal, NormalLaw::hertz);
  EXPECT_EQ(error_of(kCase, {"eos.type=tate"}),
            "--set eos.type=tate: eos.type = \"tate\" must be one of tait, democritus");
}

TEST(ReadCase, NamesAFileThatIsNotThere) {
  std::vector<std::string> warnings;
  try {
    read_case("/nonexistent/dam.toml", {}, warnings);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_STREQ(error.what(), "/nonexistent/dam.toml: cannot read this case file: no such file");
  }
}

}  // namespace
}  // namespace bedload::test
