// The sentence that a user reads for each way in which a case can be wrong.

#include <gtest/gtest.h>

#include <algorithm>

#include "bedload/case/choices.hpp"
#include "bedload/case/parameters.hpp"
#include "bedload/case/section.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

struct Wrong {
  const char* from;
  const char* to;
  std::string message;
};

void PrintTo(const Wrong& w, std::ostream* out) { *out << w.to; }

class CaseErrors : public testing::TestWithParam<Wrong> {};

TEST_P(CaseErrors, AreOneSentenceWithFileLineAndRemedy) {
  const Wrong& w = GetParam();
  EXPECT_EQ(error_of(changed(w.from, w.to)), w.message);
}

INSTANTIATE_TEST_SUITE_P(
    Text, CaseErrors,
    testing::Values(
        Wrong{"dx = 0.004", "dx = 0.004\ndx = 0.005", "dam.toml:7: dx is given twice"},
        Wrong{"[domain]", "[domain", "dam.toml:2: is not TOML: table header: expected ']', saw '\\n'"},
        Wrong{"dx = 0.004", "rho = 900\ndx = 0.004",
              "dam.toml:6: fluid.rho is not a parameter; did you mean fluid.rho0?"},
        Wrong{"[grain]", "[grian]", "dam.toml:16: grian.d is not a parameter; did you mean grain.d?"},
        Wrong{
            "[grain]", "[contact]\ne = 0.5\n[grain]",
            "dam.toml:16: contact.e is not a parameter; e is grain.e here (of two materials contact.pair.e)"},
        Wrong{"dx = 0.004", "nu = 900\ndx = 0.004",
              "dam.toml:6: fluid.nu is not a parameter; what PySPH calls nu is fluid.mu here (rho0 times the "
              "kinematic viscosity)"},
        Wrong{"end = 0.3", "edn = 0.3", "dam.toml:22: time.edn is not a parameter; did you mean time.end?"}));

constexpr const char* kOneDensity =
    "all fluid has the density fluid.rho0, kg/m3; [[fluid.species]] differ in viscosity alone, fluid.mu";
constexpr const char* kOpeningsRest =
    "openings rest in the domain; where a tank moves with its inlets, write its motion as [frame.motion], "
    "which "
    "takes the whole domain along";

TEST(MissingKeys, SayWhatToDoInstead) {
  const auto error = [](const std::string& to) { return error_of(changed("[grain]\n", to + "[grain]\n")); };
  const std::string inlet = R"([[inlet]]
name = "feed"
centre = [0.1, 0.05, 0.1]
direction = [1, 0, 0]
radius = 0.02
rate = 1e-4
)";
  EXPECT_EQ(error(inlet + "body = \"tank\"\n"),
            std::string("dam.toml:21: inlet.body is not a parameter; ") + kOpeningsRest);
  EXPECT_EQ(error(inlet + "[inlet.motion]\nkind = \"velocity\"\n"),
            std::string("dam.toml:22: inlet.motion.kind is not a parameter; ") + kOpeningsRest);
  EXPECT_EQ(error("[[outlet]]\nmotion = \"tank\"\n"),
            std::string("dam.toml:16: outlet.motion is not a parameter; ") + kOpeningsRest);
  EXPECT_EQ(error(inlet + "rho0 = 800\n"),
            std::string("dam.toml:21: inlet.rho0 is not a parameter; ") + kOneDensity);
  EXPECT_EQ(error("[[fluid.species]]\nname = \"oil\"\nmu = 0.1\nrho0 = 800\n"),
            std::string("dam.toml:18: fluid.species.rho0 is not a parameter; ") + kOneDensity);
  EXPECT_EQ(error("[fluid.2]\nrho0 = 800\n"),
            std::string("dam.toml:15: [fluid.2] must be one table, [fluid]; ") + kOneDensity);
  EXPECT_EQ(error_of(changed("max = [0.05, 0.1, 0.1]\n[[wall", "max = [0.05, 0.1, 0.1]\nrho0 = 800\n[[wall")),
            std::string("dam.toml:10: fluid.fill.rho0 is not a parameter; ") + kOneDensity);
  EXPECT_EQ(error_of("[[fluid]]\nrho0 = 1000\n[[fluid]]\nrho0 = 800\n"),
            std::string("dam.toml:1: [[fluid]] must be one table, [fluid]; ") + kOneDensity);
}

INSTANTIATE_TEST_SUITE_P(
    Type, CaseErrors,
    testing::Values(
        Wrong{"dx = 0.004", "dx = \"4mg\"",
              "dam.toml:6: fluid.dx = \"4mg\" must be a number in m, or in quotes with another unit; mg is "
              "no unit of "
              "that kind"},
        Wrong{"dx = 0.004", "dx = nan", "dam.toml:6: fluid.dx = nan must be finite"},
        Wrong{"dx = 0.004", "dx = inf", "dam.toml:6: fluid.dx = inf must be finite"},
        Wrong{"dx = 0.004", "dx = 1e308", "dam.toml:6: fluid.dx = 1e+308 must be below 1e30 in size"},
        Wrong{"dx = 0.004", "dx = 0.004\nkernel = 2",
              "dam.toml:7: fluid.kernel = 2 must be one of wendland_c2, cubic, lucy"},
        Wrong{"d = 0.002", "d = 0.002\nfixed = 2", "dam.toml:17: grain.fixed = 2 must be true or false"},
        Wrong{"count = 500", "count = 5.5", "dam.toml:20: grain.fill.count = 5.5 must be a whole number"},
        Wrong{"min = [0, 0, 0]\nmax = [0.2, 0.1, 0.2]\n[fluid]",
              "min = [0, 0]\nmax = [0.2, 0.1, 0.2]\n[fluid]",
              "dam.toml:3: domain.min = [0, 0] must be three numbers [x, y, z]"},
        Wrong{"title = \"dam\"", "title = 1979-05-27", "dam.toml:1: title = a date must be a text in quotes"},
        Wrong{"[time]", "[[time]]", "dam.toml:21: time must be a single table; write [time]"},
        Wrong{"[[fluid.fill]]", "[fluid.fill]",
              "dam.toml:7: fluid.fill must be a list of tables; write [[fluid.fill]]"},
        Wrong{"shape = \"tank\"", "shape = \"tank\"\nfaces = [\"top\"]",
              "dam.toml:13: wall.body.faces = [\"top\"] must be a list of some of \"x-\", \"x+\", \"y-\", "
              "\"y+\", \"z-\", "
              "\"z+\""},
        Wrong{"[[wall.body]]", "velocity = [0, 0, \"2*q\"]\n[[wall.body]]",
              "dam.toml:10: fluid.fill.velocity = [0, 0, \"2*q\"] must hold formulas in x, y, z: Unexpected "
              "token \"q\" "
              "found at position 2"}));

INSTANTIATE_TEST_SUITE_P(
    Missing, CaseErrors,
    testing::Values(
        Wrong{"dx = 0.004\n", "",
              "dam.toml:5: fluid.dx must be given (initial particle spacing; lattice: spacing of the nodes, "
              "which "
              "must divide the domain, m)"},
        Wrong{"[time]\nend = 0.3\n", "", "dam.toml: time.end must be given (end time of the run, s)"},
        Wrong{"shape = \"tank\"", "shape = \"tnk\"",
              "dam.toml:12: wall.body.shape = \"tnk\" must be tank, box, plane or the name of a [[shape]]; "
              "this case has none"},
        Wrong{"shape = \"tank\"\n", "", "dam.toml:10: wall.body.shape must be given (shape of the body)"},
        Wrong{"d = 0.002\n", "",
              "dam.toml:15: grain.d must be given (diameter, m, where a grain.fill or grain_inlet has no "
              "sizes)"},
        Wrong{"count = 500\n", "",
              "dam.toml:17: grain.fill must have exactly one of count, mass and packing_fraction"},
        Wrong{"count = 500\n", "count = 500\nmass = 1\n",
              "dam.toml:17: grain.fill must have exactly one of count, mass and packing_fraction"},
        Wrong{"[grain]\n", "[contact]\nnormal = \"linear\"\n[grain]\n",
              "dam.toml:15: contact.k must be given (spring, N/m, with contact.normal = \"linear\")"},
        Wrong{"title = \"dam\"\n", "gravity = [0, 0, 0]\n",
              "dam.toml:5: fluid.vmax must be given (m/s; neither gravity nor a wall or inlet sets a speed "
              "here)"}));

INSTANTIATE_TEST_SUITE_P(
    FluidModel, CaseErrors,
    testing::Values(
        Wrong{"dx = 0.004", "dx = 0.004\nmodel = \"spdp\"",
              "dam.toml:7: fluid.model = \"spdp\" must be one of wcsph, sdpd, sdpd_a, lattice"},
        Wrong{"[fluid]", "[sdpd]\nkT = 1\n[fluid]",
              "dam.toml:6: sdpd.kT = 1 is not used by the chosen options; remove it"},
        Wrong{
            "[fluid]", "[shift]\nA = 5\n[fluid]\nmodel = \"sdpd\"",
            "dam.toml:6: shift.A = 5 must be 0 with fluid.model = \"sdpd\"; thermal noise would trigger it"},
        Wrong{"[fluid]", "[visc]\nmodel = \"morris\"\n[fluid]\nmodel = \"sdpd\"",
              "dam.toml:6: visc.model = \"morris\" must be \"none\" with fluid.model = \"sdpd\", which "
              "brings its "
              "own viscosity"},
        Wrong{"[fluid]", "[fluid]\nmodel = \"sdpd_a\"\nzeta = 1",
              "dam.toml:7: fluid.zeta = 1 must be within 0..0.00166667, 0..5/3 of fluid.mu"},
        Wrong{"[fluid]", "[sdpd]\nforce_scale = [1, 1]\n[fluid]\nmodel = \"sdpd\"",
              "dam.toml:6: sdpd.force_scale = [1, 1] must be four numbers: pressure, friction, friction of "
              "spins, "
              "noise"},
        Wrong{"[fluid]", "[sdpd]\nnoise = \"tensor\"\nkT = 1e-20\n[fluid]\nmodel = \"sdpd_a\"\nzeta = 5e-4",
              "dam.toml:10: fluid.zeta = 0.0005 must be within 0.000784314..0.00166667, 40/51..5/3 of "
              "fluid.mu with "
              "sdpd.noise = \"tensor\""}));

INSTANTIATE_TEST_SUITE_P(
    VariableH, CaseErrors,
    testing::Values(
        Wrong{"[fluid]", "[fluid]\nsigma_h = 1.5",
              "dam.toml:6: fluid.sigma_h = 1.5 is not used by the chosen options; remove it"},
        Wrong{"[fluid]", "[fluid]\nvariable_h = true\nsigma_h = 2.5",
              "dam.toml:7: fluid.sigma_h = 2.5 must be within 1.2..2"},
        Wrong{"[fluid]", "[fluid]\nvariable_h = true\nmodel = \"sdpd\"",
              "dam.toml:7: fluid.model = \"sdpd\" must be \"wcsph\" with fluid.variable_h"},
        Wrong{"[fluid]", "[fluid]\nvariable_h = true\nkernel = \"lucy\"\nh_over_dx = 3",
              "dam.toml:7: fluid.kernel = \"lucy\" must be wendland_c2 or cubic with fluid.variable_h"},
        Wrong{"[fluid]", "[shift]\nA = 5\n[fluid]\nvariable_h = true",
              "dam.toml:6: shift.A = 5 must be 0 with fluid.variable_h"},
        Wrong{"[fluid]", "[wall]\ntype = \"mdbc\"\n[fluid]\nvariable_h = true",
              "dam.toml:13: wall.body.type = \"mdbc\" must be adami, single_layer, grains_only or "
              "fluid_only with fluid.variable_h"},
        Wrong{
            "[domain]\nmin = [0, 0, 0]\nmax = [0.2, 0.1, 0.2]\n[fluid]",
            "[domain]\nmin = [0, 0, 0]\nmax = [0.2, 0.04, 0.2]\nperiodic = [false, true, false]\n[fluid]\n"
            "variable_h = true",
            "dam.toml:5: domain.periodic = 0.04 m along y must be a period > 4 kappa h = 0.048; enlarge the "
            "domain or refine"}));

INSTANTIATE_TEST_SUITE_P(
    Bounds, CaseErrors,
    testing::Values(
        Wrong{"dx = 0.004", "dx = 0", "dam.toml:6: fluid.dx = 0 must be > 0"},
        Wrong{"dx = 0.004", "dx = 0.004\nh_over_dx = 1",
              "dam.toml:7: fluid.h_over_dx = 1 must be within 1.2..3"},
        Wrong{"dx = 0.004", "dx = 0.004\nkernel = \"lucy\"\nh_over_dx = 1.5",
              "dam.toml:8: fluid.h_over_dx = 1.5 must be within 2..4"},
        Wrong{"d = 0.002", "d = 0.002\ne = 1.4",
              "dam.toml:17: grain.e = 1.4 must be within 0.05..1; give a fraction, not percent?"},
        Wrong{"[grain]\nd = 0.002", "[contact]\nnormal = \"linear\"\nk = 1e4\n[grain]\nd = 0.002\ne = 0.1",
              "dam.toml:20: grain.e = 0.1 must be within 0.136..1; give a fraction, not percent?"},
        Wrong{"[grain]\nd = 0.002", "e = 0.1\n[contact]\nnormal = \"linear\"\nk = 1e4\n[grain]\nd = 0.002",
              "dam.toml:15: wall.body.e = 0.1 must be within 0.136..1; give a fraction, not percent?"},
        Wrong{"[grain]\nd = 0.002", "mu = -0.1\n[grain]\nd = 0.002",
              "dam.toml:15: wall.body.mu = -0.1 must be within 0..5"},
        Wrong{"d = 0.002", "d = 0.002\nnu = 0.5", "dam.toml:17: grain.nu = 0.5 must be > -1 and < 0.5"},
        Wrong{"end = 0.3", "end = 0.3\ncfl = 0.6", "dam.toml:23: time.cfl = 0.6 must be > 0 and <= 0.5"},
        Wrong{"end = 0.3", "end = 0.3\nintegrator = \"ab3\"",
              "dam.toml:23: time.integrator = \"ab3\" must be \"kdk\" with grains that the fluid feels"},
        Wrong{"[time]\nend = 0.3",
              "[couple]\nmode = \"one_way\"\n[time]\nend = 0.3\ncfl = 0.4\nintegrator = \"ab3\"",
              "dam.toml:25: time.cfl = 0.4 must be <= 0.3 with time.integrator = \"ab3\""},
        Wrong{"count = 500", "packing_fraction = 0.7",
              "dam.toml:20: grain.fill.packing_fraction = 0.7 must be <= 0.64, the densest random packing of "
              "these sizes"},
        Wrong{"count = 500", "packing_fraction = 1.1",
              "dam.toml:20: grain.fill.packing_fraction = 1.1 must be > 0 and <= 1"},
        Wrong{"every = 0.01", "every = 0.01\nspectra = true\nspectra_sizes = [0.002, 0.001]",
              "dam.toml:26: out.spectra_sizes = [0.002, 0.001] must be up to 7 diameters in rising order"},
        Wrong{"[grain]\nd = 0.002", "wear = \"archard\"\n[grain]\nd = 0.002",
              "dam.toml:10: wall.body.k_over_H must be given (dimensionless wear coefficient of Archard's "
              "law over the hardness of the wall; of Finnie's, c/(psi K p), 1/Pa)"},
        Wrong{"[grain]\nd = 0.002",
              "wear = \"archard\"\nk_over_H = 1e-13\nwear_patch = 1e-5\n[grain]\nd = 0.002",
              "dam.toml:17: wall.body.wear_patch = 1e-05 m must be larger: the map of the body has 4e+12 "
              "patches, of at most 4e+06"},
        Wrong{"[grain]\nd = 0.002", "material = \"iron\"\n[grain]\nd = 0.002",
              "dam.toml:15: wall.body.material = \"iron\" must name a grain.material; this case has none"},
        Wrong{"[time]", "[drag]\nlaw = \"gidspow\"\n[time]",
              "dam.toml:22: drag.law = \"gidspow\" must be one of " + names_of<DragLaw>()},
        Wrong{"title = \"dam\"", "preset = \"hee\"",
              "dam.toml:1: preset = \"hee\" must be one of default, he2018, democritus, robinson2014"}));

INSTANTIATE_TEST_SUITE_P(
    Together, CaseErrors,
    testing::Values(
        Wrong{"max = [0.2, 0.1, 0.2]\n[fluid]", "max = [0.2, 0, 0.2]\n[fluid]",
              "dam.toml:4: domain.max = [0.2, 0, 0.2] must exceed domain.min = [0, 0, 0] on every axis"},
        Wrong{"max = [0.05, 0.1, 0.1]\n[[wall", "max = [0.05, 0.1, 0.3]\n[[wall",
              "dam.toml:9: fluid.fill.max = [0.05, 0.1, 0.3] must lie in the domain [0, 0, 0]..[0.2, 0.1, "
              "0.2]"},
        Wrong{"max = [0.2, 0.1, 0.2]\n[fluid]\ndx = 0.004",
              "max = [0.2, 0.1, 0.2]\nperiodic = [0, 1, 0]\n[fluid]\ndx = 0.02",
              "dam.toml:5: domain.periodic = [0, 1, 0] must be three of true or false"},
        Wrong{"max = [0.2, 0.1, 0.2]\n[fluid]\ndx = 0.004",
              "max = [0.2, 0.1, 0.2]\nperiodic = [false, true, false]\n[fluid]\ndx = 0.02",
              "dam.toml:5: domain.periodic = 0.1 m along y must be a period > 2 kappa h = 0.12; enlarge the "
              "domain or "
              "refine"},
        Wrong{"dx = 0.004", "dx = 1e-6",
              "dam.toml:6: fluid.dx = 1e-06 must be larger; it makes 5e+14 fluid particles of at most "
              "2147483647"},
        Wrong{"dx = 0.004", "dx = 0.004\nmu = 0",
              "dam.toml:7: fluid.mu = 0 must be > 0 with grains; drag needs mu"},
        Wrong{"[[wall.body]]", "[wall]\ndx = 0.005\n[[wall.body]]",
              "dam.toml:11: wall.dx = 0.005 must be within 0.001..0.004; a quarter of fluid.dx to fluid.dx"},
        Wrong{"[[wall.body]]", "[[wall.body]]\ntype = \"single_layer\"\ndx = 0.003",
              "dam.toml:12: wall.body.dx = 0.003 must be within 0.001..0.002; a quarter of fluid.dx to half "
              "of it "
              "for a single_layer"},
        Wrong{"[[wall.body]]", "[wall]\nlayer_r0 = 0.001\n[[wall.body]]\ntype = \"single_layer\"",
              "dam.toml:11: wall.layer_r0 = 0.001 must be within 0.002..0.004; the spacing of wall.body "
              "\"tank\" "
              "to fluid.dx"},
        Wrong{"[[wall.body]]", "[[wall.body]]\ntype = \"mdbc\"\nforce = \"kajtar\"",
              "dam.toml:12: wall.body.force = \"kajtar\" is not used by the chosen options; remove it"},
        Wrong{"[[wall.body]]", "[[wall.body]]\ntype = \"single_layer\"\nrepulsion = true",
              "dam.toml:12: wall.body.repulsion = true is not used by the chosen options; remove it"},
        Wrong{"[time]", "[couple]\nhc = 0.001\n[time]",
              "dam.toml:22: couple.hc = 0.001 must be >= 0.002; unresolved coupling needs kappa h_c >= 2 "
              "d_max"},
        Wrong{"[time]", "[couple]\nmode = \"one_way\"\nundisturbed = true\n[time]",
              "dam.toml:23: couple.undisturbed = true must be false without couple.mode = \"two_way\""},
        Wrong{
            "[time]", "[couple]\nsuspension_viscosity = \"maron_pierce\"\n[visc]\nmodel = \"none\"\n[time]",
            "dam.toml:22: couple.suspension_viscosity = \"maron_pierce\" must be \"none\" with visc.model = "
            "\"signal\" or \"none\""},
        Wrong{"[time]", "[couple]\nS_dry = 0.6\nS_wet = 0.5\n[time]",
              "dam.toml:23: couple.S_wet = 0.5 must be > couple.S_dry = 0.6"},
        Wrong{"end = 0.3", "end = 0.3\ndt_dem = 1e-4",
              "dam.toml:23: time.dt_dem = 0.0001 must be <= 5.473e-06; limited by rayleigh (time.rayleigh)"},
        Wrong{"d = 0.002", "d = 0.02",
              "dam.toml:20: grain.fill.count = 500 must fit the space to fill; it takes 419 % where 64 % is "
              "the densest random packing of these sizes"},
        Wrong{"shape = \"tank\"", "shape = \"tank\"\nnormal = [0, 0, 1]",
              "dam.toml:13: wall.body.normal = [0, 0, 1] is not used by the chosen options; remove it"},
        Wrong{"[out]", "[[probe]]\nname = \"f\"\ntype = \"force\"\nbody = \"gate\"\n[out]",
              "dam.toml:26: probe.body = \"gate\" must name a wall.body; this case has tank"},
        Wrong{"[out]", "[[probe]]\nname = \"../f\"\ntype = \"height\"\nat = [0, 0, 0]\n[out]",
              "dam.toml:24: probe.name = \"../f\" must consist of letters, digits, '_', '-' and '.'"}));

/// Every key of a case, given what it cannot be: one sentence that names place and key.
TEST(CaseError, EveryKeySaysWhatItCannotBe) {
  const std::string text = kCase + R"([[shape]]
name = "ball"
kind = "sphere"
centre = [0.1, 0.05, 0.1]
radius = 0.02
copies = { count = 2, about = [0, 0, 1] }
[[outlet]]
name = "drain"
shape = "box"
min = [0.18, 0, 0]
max = [0.2, 0.1, 0.02]
[[probe]]
name = "top"
type = "height"
at = [0.01, 0.05, 0]
)";
  ASSERT_EQ(error_of(text), "");
  int tried = 0;
  for (const ParameterRow& row : parameter_table()) {
    std::string path = row.key;
    bool listed = true;  // in the lists that this case has
    for (const std::string list : {"inlet.", "grain_inlet.", "wall.body.motion.add.", "frame.motion.add.",
                                   "wall.body.free.contact.", "wall.body.free.scatter.", "grain.fill.sizes.",
                                   "grain.material.", "contact.pair.", "clump.", "fluid.species."})
      listed = listed && !row.key.starts_with(list);
    if (!listed) continue;
    for (const std::string list : {"fluid.fill.", "wall.body.", "grain.fill.", "shape.", "outlet.", "probe."})
      if (path.starts_with(list)) path.insert(list.size(), "0.");
    std::vector<std::string> wrong{"1979-05-27", "[[1, 2]]", "{odd = 1}"};
    if (!row.allowed.empty() && row.allowed.find("..") != row.allowed.npos) wrong.push_back("-1e29");
    for (const std::string& value : wrong) {
      const std::string assignment = path + "=" + value, message = error_of(text, {assignment});
      EXPECT_TRUE(message.starts_with("--set " + assignment + ": ") || message.starts_with("dam.toml"))
          << message;
      const std::string leaf = row.key.substr(row.key.rfind('.') + 1);
      EXPECT_NE(message.find(leaf, message.starts_with("--set") ? assignment.size() : 0), message.npos)
          << assignment << ": " << message;
      EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
      ++tried;
    }
  }
  EXPECT_GT(tried, 600);
}

TEST(CaseError, NamesTheOverrideAtFault) {
  EXPECT_EQ(error_of(kCase, {"grain.e=2"}),
            "--set grain.e=2: grain.e = 2 must be within 0.05..1; give a fraction, not percent?");
  EXPECT_EQ(error_of(kCase, {"grian.e=0.5"}),
            "--set grian.e=0.5: grian.e is not a parameter; did you mean grain.e?");
  EXPECT_EQ(error_of(kCase, {"grain.e"}), "--set grain.e: must have the form key=value");
  EXPECT_EQ(error_of(kCase, {"grain.fill.3.count=1"}),
            "--set grain.fill.3.count=1: grain.fill is a list of 1, so name it by grain.fill.0");
  EXPECT_EQ(error_of(kCase, {"fluid.dx.a=1"}), "--set fluid.dx.a=1: fluid.dx holds no keys");
  EXPECT_EQ(error_of(kCase, {"couple.hc=1e-3"}),
            "--set couple.hc=1e-3: couple.hc = 0.001 must be >= 0.002; unresolved coupling needs kappa h_c "
            ">= 2 d_max");
  EXPECT_EQ(error_of(kCase, {"fluid=3"}), "--set fluid=3: fluid = 3 must be a table; write [fluid]");
}

TEST(CaseError, SaysHowManyEntriesAListHas) {
  const auto answer = [](const std::string& assignment) { return error_of(kCase, {assignment}); };
  EXPECT_EQ(answer("probe.0.every=1"),
            "--set probe.0.every=1: this case has no probe; write a [[probe]] in its file first");
  EXPECT_EQ(
      answer("grain.fill.0.sizes.0.d=1"),
      "--set grain.fill.0.sizes.0.d=1: this case has no grain.fill.sizes; write a [[grain.fill.sizes]] in "
      "its file first");
  EXPECT_EQ(answer("wall.body.0.motion.add.2.kind=fixed"),
            "--set wall.body.0.motion.add.2.kind=fixed: this case has no wall.body.motion.add; write a "
            "[[wall.body.motion.add]] in its file first");
  EXPECT_EQ(answer("wall.body.1.mu=1"),
            "--set wall.body.1.mu=1: wall.body is a list of 1, so name it by wall.body.0");
  const std::string two =
      kCase + "[[probe]]\nname = \"a\"\ntype = \"front\"\n[[probe]]\nname = \"b\"\ntype = \"front\"\n";
  EXPECT_EQ(error_of(two, {"probe.7.every=1"}),
            "--set probe.7.every=1: probe is a list of 2, so name one of probe.0 to probe.1");
  EXPECT_EQ(error_of(two, {"probe=[]", "probe.0.every=1"}),
            "--set probe.0.every=1: this case has no probe; write a [[probe]] in its file first");
}

TEST(CaseError, AsksForSomethingToCompute) {
  EXPECT_EQ(error_of("[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[time]\nend = 1\n[out]\nevery = 1\n"),
            "dam.toml: nothing to compute; give [fluid], [grain] or both");
}

TEST(NearestKey, PrefersAWrongTableToAWrongName) {
  const std::vector<std::string> known{"contact.k", "grain.e", "fluid.dx", "grain.d", "time.end"};
  EXPECT_EQ(nearest_key("contact.e", known), "grain.e");
  EXPECT_EQ(nearest_key("fluid.xd", known), "fluid.dx");
  EXPECT_EQ(nearest_key("grian.d", known), "grain.d");
  EXPECT_EQ(nearest_key("end", known), "time.end");
  EXPECT_EQ(nearest_key("frame.motion.rate", {"wall.body.motion.rate", "wall.body.mu"}),
            "wall.body.motion.rate");
}

TEST(NearestKey, IsNoneWhereNoneIsNear) {
  const std::vector<std::string> known{"title",   "tensile",  "grain.nu",
                                       "grain.d", "time.end", "density.delta"};
  for (const char* key :
       {"DensityDT", "TimeMax", "grain.youngsModulus", "surface_tension", "grain.z", "x", ""})
    EXPECT_EQ(nearest_key(key, known), "") << key;
}

}  // namespace
}  // namespace bedload::test
