// Which cases the lattice takes, and what it says of others.

#include <gtest/gtest.h>

#include "bedload/case/lattice_step.hpp"
#include "bedload/geometry/setup.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

const std::string kChannel = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
periodic = [true, true, false]
[fluid]
model = "lattice"
dx = 0.01
mu = 0.1
vmax = 0.1
[[wall.body]]
name = "floor"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
[[wall.body]]
name = "lid"
shape = "plane"
point = [0, 0, 0.1]
normal = [0, 0, -1]
[time]
end = 1
[out]
every = 1
)";

std::string setup_error(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Config config = read(text, overrides);
  std::vector<std::string> warnings;
  try {
    placed(config.places, [&] { build_setup(config, warnings); });
  } catch (const CaseError& error) {
    return error.what();
  }
  return "";
}

TEST(LatticeCase, IsTakenAndReadsBackAsItIsWritten) {
  EXPECT_EQ(setup_error(kChannel), "");
  const Config config = read(kChannel);
  EXPECT_EQ(read(resolved_toml(config)), config);
}

/// The step keeps every limit; the tightest binds.
TEST(LatticeCase, ChoosesItsStep) {
  const LatticeStep by_speed = lattice_step(read(kChannel, {"fluid.mu=0.05"}));
  EXPECT_NEAR(by_speed.dt, 0.05 * 0.01 / 0.1, 1e-12);
  EXPECT_NEAR(by_speed.tau, 0.5 + 3 * 5e-5 * by_speed.dt / 1e-4, 1e-12);
  const LatticeStep by_tau = lattice_step(read(kChannel, {"fluid.mu=10"}));
  EXPECT_NEAR(by_tau.tau, 1, 1e-12);
  EXPECT_EQ(least_of(by_tau.limits).limit, Limit::relaxation);
  const LatticeStep given = lattice_step(read(kChannel, {"lattice.tau=0.6", "fluid.mu=1"}));
  EXPECT_NEAR(given.tau, 0.6, 1e-12);
  EXPECT_NEAR(given.dt, 0.1 * 1e-4 / (3 * 1e-3), 1e-12);
  const LatticeStep pushed = lattice_step(read(kChannel, {"fluid.mu=10", "drive.f=[1e6,0,0]"}));
  EXPECT_EQ(least_of(pushed.limits).limit, Limit::body_force);
  const LatticeStep heavy =
      lattice_step(read(kChannel, {"fluid.mu=1", "fluid.dx=0.005", "gravity=[0,0,-9.81]"}));
  EXPECT_EQ(least_of(heavy.limits).limit, Limit::static_head);
}

TEST(LatticeCase, RefusesWhatItCannotDoWithKeyAndLine) {
  const std::string with = "with fluid.model = \"lattice\"", at = "dam.toml:";
  EXPECT_EQ(error_of(kChannel + "[shift]\nA = 10\n"),
            at + "26: shift.A = 10 is not used " + with + "; remove it");
  EXPECT_EQ(error_of(kChannel + "[[outlet]]\nname = \"drain\"\nshape = \"plane\"\npoint = [0, 0, 0.1]\n"
                                "normal = [0, 0, 1]\n"),
            at + "26: outlet.name = \"drain\" is not used " + with + "; remove it");
  for (const std::string set :
       {"domain.two_d=true", "fluid.kernel=cubic", "fluid.variable_h=true", "eos.gamma=7", "time.dt=0.001",
        "drive.opposed=z", "couple.mode=off", "wall.type=mdbc", "wall.body.0.slip=slip"}) {
    const std::string said = error_of(kChannel, {set});
    EXPECT_NE(said.find("is not used " + with), std::string::npos) << said;
    EXPECT_NE(said.find("--set " + set.substr(0, set.find('='))), std::string::npos) << said;
  }
  const auto says = [&](const std::vector<std::string>& set, const std::string& part) {
    const std::string said = error_of(kChannel, set);
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  says({"fluid.mu=0"}, "fluid.mu = 0 must be > 0 " + with);
  says({"fluid.dx=0.0093"},
       "fluid.dx = 0.0093 must divide the domain's length along x, 0.1 m; 0.0090909091 m does");
  says({"fluid.mu=1e-4"}, "fluid.dx = 0.01 must be at most");
  says({"lattice.tau=2", "fluid.mu=0.001"}, "lattice.tau = 2 must be smaller");
  says({"lattice.tau=0.5"}, "lattice.tau = 0.5 must be within 0.505..2");
  says({"wall.body.0.type=single_layer"}, "wall.body.type = \"single_layer\" must be \"adami\"");
  says({"preset=he2018"}, "preset = \"he2018\" must be left out");
  says({"drive.f=[1,0,0]", "drive.factor=x"}, "drive.factor = \"x\" must be a formula in t");
  says({"drive.f=[1,0,0]", "drive.mode=particle"},
       "drive.mode = \"particle\" must be \"volume\" or \"mass\"");
  EXPECT_NE(error_of(kChannel + "[[probe]]\nname = \"gauge\"\ntype = \"height\"\nat = [0.05, 0.05, 0]\n")
                .find("probe.type = \"height\" must be \"point\", \"box\" or \"force\" " + with),
            std::string::npos);
}

TEST(LatticeCase, TakesGrainsThatItResolves) {
  const std::string with = "with fluid.model = \"lattice\"",
                    grains =
                        kChannel + "[grain]\nd = 0.04\n[[grain.fill]]\npositions = [[0.05, 0.05, 0.05]]\n";
  const std::vector<std::string> fine{"fluid.dx=0.005"};
  const Config config = read(grains, fine);
  EXPECT_EQ(read(resolved_toml(config)), config);
  std::vector<std::string> warnings;
  EXPECT_EQ(build_setup(config, warnings).grains.x.size(), 1u);
  EXPECT_EQ(
      error_of(grains, {}),
      "dam.toml:8: fluid.dx = 0.01 must be at most 0.008 m, for 5 nodes across the smallest grain of 0.04 m");
  const auto says = [&](const std::string& text, std::vector<std::string> set, const std::string& part) {
    set.push_back(fine[0]);
    const std::string said = error_of(text, set);
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  says(grains, {"grain.rho=200"},
       "fluid.dx = 0.005 must be at most 0.0032 m: grains of 200 kg/m3 are too light");
  says(grains, {"out.energy=true"}, "out.energy = true must be false " + with);
  says(grains + "replaces_fluid = true\n", {}, "grain.fill.replaces_fluid = true must be false " + with);
  says(grains + "[grain.fill.rigid]\n", {}, "must be left out " + with);
  says(grains, {"couple.mode=two_way"}, "couple.mode = \"two_way\" is not used " + with);
  says(kChannel, {"drag.law=stokes"}, "drag.law = \"stokes\" is not used " + with);
  EXPECT_EQ(error_of(grains, {"fluid.dx=0.005", "grain.rho=200", "grain.fixed=true"}), "");
}

TEST(LatticeCase, IsShearedByImagesInAPeriodicBoxAlone) {
  std::string box =
      kChannel.substr(0, kChannel.find("[[wall.body]]")) + "[time]\nend = 1\n[out]\nevery = 1\n";
  box.replace(box.find("false"), 5, "true");
  const std::vector<std::string> sheared{"domain.shear_rate=3"};
  const Config config = read(box, sheared);
  EXPECT_EQ(read(resolved_toml(config)), config);
  EXPECT_NEAR(config.fluid.vmax, 0.15, 1e-12) << "half the speed of the images";
  std::vector<std::string> warnings;
  EXPECT_EQ(build_setup(config, warnings).nodes.count, (std::array<std::uint32_t, 3>{10, 10, 12}));
  const auto says = [&](const std::string& text, const std::string& set, const std::string& part) {
    const std::string said = error_of(text, {sheared[0], set});
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  const std::string with = "domain.shear_rate = 3 must be 0 with ",
                    grains = box + "[grain]\nd = 0.04\n[[grain.fill]]\npositions = [[0.05, 0.05, 0.05]]\n";
  says(kChannel, "fluid.mu=0.1", with + "[[wall.body]]");
  says(box, "gravity=[0,0,-1]", with + "gravity");
  says(box, "drive.f=[1,0,0]", with + "[drive]");
  says(box, "domain.periodic=[true,false,true]", "domain.periodic = false along y must be true");
  says(grains, "grain.fixed=true", with + "grain.fixed = true");
  EXPECT_EQ(error_of(grains, {sheared[0], "fluid.dx=0.005"}), "");
}

TEST(LatticeCase, FluidFillsAllBetweenTheWalls) {
  const std::string open = setup_error(kChannel, {"wall.body.1.type=grains_only"});
  EXPECT_NE(open.find("the side z+ of the domain is open"), std::string::npos) << open;
  EXPECT_NE(open.find("dam.toml:5: "), std::string::npos) << open;
  const std::string half =
      setup_error(kChannel + "[[fluid.fill]]\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.05]\n");
  EXPECT_NE(half.find("there is no free surface"), std::string::npos) << half;
  const std::string moved = setup_error(
      kChannel, {"wall.body.0.motion.kind=velocity", "wall.body.0.motion.velocity=[0.01,0,0.01]"});
  EXPECT_NE(moved.find("the surface of \"floor\" must move along itself"), std::string::npos) << moved;
  EXPECT_EQ(setup_error(kChannel,
                        {"wall.body.0.motion.kind=velocity", "wall.body.0.motion.velocity=[0.01,0.01,0]"}),
            "");
}

/// Where a link meets a sphere and a plane between nodes.
TEST(LatticeCase, LinksEndAtTheSurface) {
  const std::string ball = R"([[shape]]
name = "ball"
kind = "sphere"
centre = [0.0513, 0.0487, 0.0502]
radius = 0.0231
[[wall.body]]
name = "ball"
shape = "ball"
)";
  std::vector<std::string> warnings;
  const Config config = read(kChannel + ball, {"wall.body.0.point=[0,0,0.0028]"});
  const Setup::Nodes nodes = build_setup(config, warnings).nodes;
  EXPECT_EQ(nodes.count, (std::array<std::uint32_t, 3>{10, 10, 12}));
  std::size_t of_body[3] = {};
  const auto& links = nodes.links;
  for (std::size_t l = 0; l < links.node.size(); ++l) {
    const std::uint32_t n = links.node[l];
    EXPECT_EQ(nodes.solid[n], 0u);
    const Vec3d at = nodes.first + 0.01 * Vec3d{double(n % 10), double(n / 10 % 10), double(n / 100)};
    const Vec3d way{double(links.direction[l] == 1), 0, 0};
    ++of_body[links.body[l]];
    ASSERT_GT(links.fraction[l], 0);
    ASSERT_LE(links.fraction[l], 1);
    const double surface = norm(at + 0.01 * links.fraction[l] * way - Vec3d{0.0513, 0.0487, 0.0502});
    if (links.body[l] == 2 && links.direction[l] == 1) {
      EXPECT_NEAR(surface, 0.0231, 1e-9);
    } else if (links.body[l] < 2) {
      EXPECT_NEAR(links.fraction[l], links.body[l] == 0 ? 0.22 : 0.5, 1e-9) << "5 - 2.8 mm of 10 mm";
    }
  }
  EXPECT_EQ(of_body[0], 500u);  // five of each node over the plane
  EXPECT_EQ(of_body[1], 500u);
  EXPECT_GT(of_body[2], 60u);
}

}  // namespace
}  // namespace bedload::test
