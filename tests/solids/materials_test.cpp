// Grains of several materials among each other and on walls.
#include "bedload/case/limits.hpp"
#include "tests/support/contact_law.hpp"
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kOfEach = std::numeric_limits<double>::infinity();

/// Glass (grain.*), steel and rubber.
struct MixedBench : GrainBench {
  MixedBench() {
    config.grain.mu = 0.2;
    config.grain.materials = {{"steel", 7800, 2e9, 0.28, 0.6}, {"rubber", 1100, 1e7, 0.45, 0.9}};
    config.grain.fills.resize(3);
    config.grain.fills[1].material = "steel", config.grain.fills[2].material = "rubber";
  }
  /// `material`: of each grain, 0 glass.
  void begin(const std::vector<std::uint32_t>& material) {
    build();
    grains->material.assign(material);
    refresh();
    set_poses(1, 0);
    solver->evaluate(*grains, poses());
  }
  double mass_of(int k) const { return mass() / config.grain.rho * config.grain.all_materials()[k].rho; }
  /// Of two of them that touch.
  double E_star(int i, int j) const {
    const auto all = config.grain.all_materials();
    const auto compliance = [&](int k) { return (1 - all[k].nu * all[k].nu) / all[k].E; };
    return 1 / (compliance(i) + compliance(j));
  }
};

TEST(MaterialsSmall, UnlikeGrainsGiveWayByBothModuli) {
  MixedBench b;
  const double overlap = 1e-6;
  for (int k = 0; k < 3; ++k) {  // glass on glass, on steel, steel on rubber
    const double z = 0.01 * k;
    b.add({0, 0, z});
    b.add({2 * b.R() - overlap, 0, z});
  }
  b.begin({0, 0, 0, 1, 1, 2});
  const std::pair<int, int> pairs[] = {{0, 0}, {0, 1}, {1, 2}};
  for (Id k = 0; k < 3; ++k) {
    const auto [i, j] = pairs[k];
    const double force = 4.0 / 3 * b.E_star(i, j) * std::sqrt(b.R() / 2) * std::pow(overlap, 1.5);
    EXPECT_NEAR(b.force(2 * k + 1).x / force, 1, 1e-3) << k;
  }
  EXPECT_NEAR(b.solver->totals(*b.grains).mass / (3 * b.mass_of(0) + 2 * b.mass_of(1) + b.mass_of(2)), 1,
              1e-6);
}

TEST(Materials, UnlikeMassesReboundAsAskedFor) {
  MixedBench b;
  b.config.grain.e = 0.7;
  b.add({-b.R(), 0, 0}, {0.1, 0, 0});
  b.add({b.R(), 0, 0}, {});
  b.begin({1, 2});
  b.run(1e-7, 8000);
  const double m1 = b.mass_of(1), m2 = b.mass_of(2), common = m1 * 0.1 / (m1 + m2);
  ASSERT_EQ(b.solver->totals(*b.grains).contacts, 0);
  EXPECT_NEAR(b.velocity(0).x, common - 0.7 * 0.1 * m2 / (m1 + m2), 2e-4);
  EXPECT_NEAR(b.velocity(1).x, common + 0.7 * 0.1 * m1 / (m1 + m2), 2e-4);
}

TEST(MaterialsSmall, FrictionIsTheMeanAndTheOwnOnWalls) {
  MixedBench b;
  b.plane({0, 0, -0.05}, {0, 0, 1});
  const double overlap = 1e-6;
  b.add({0, 0, 0}, {1, 0, 0});
  b.add({0, 0, 2 * b.R() - overlap});
  b.add({0.03, 0, -0.05 + b.R() - overlap}, {1, 0, 0});
  b.begin({0, 1, 1});
  b.run(1e-8, 20);  // sliding at once
  EXPECT_NEAR(-b.force(0).x / std::abs(b.force(0).z), 0.4, 1e-3);
  EXPECT_NEAR(-b.force(2).x / b.force(2).z, 0.6, 1e-3);
}

/// Of their pair, else the wall's own, else the mean of both materials.
TEST(MaterialsSmall, WallsMayBeOfAMaterial) {
  MixedBench b;
  b.plane({0, 0, 0}, {0, 0, 1});
  WallBody& wall = b.config.wall.bodies[0];
  wall.name = "liner", wall.material = "steel";
  const auto law = [&](int grain) { return solid_parameters(b.config).wall_laws[std::size_t(grain)]; };
  EXPECT_NEAR(law(0).mu, 0.4, 1e-6) << "mean of 0.2 and 0.6";
  EXPECT_NEAR(law(2).mu, 0.75, 1e-6);
  for (int grain = 0; grain < 3; ++grain) EXPECT_NEAR(law(grain).normal.E_star / b.E_star(grain, 1), 1, 1e-6);
  wall.mu = 0.1;
  EXPECT_NEAR(law(0).mu, 0.1, 1e-6) << "its own";
  b.config.contact.pairs = {{{"steel", "grain"}, 0.33, kOfEach, 0}};
  EXPECT_NEAR(law(0).mu, 0.33, 1e-6) << "of the pair of materials";
  EXPECT_NEAR(law(2).mu, 0.1, 1e-6);
  b.config.contact.pairs.push_back({{"grain", "liner"}, 0.44, kOfEach, 0});
  EXPECT_NEAR(law(0).mu, 0.44, 1e-6) << "of grain and body";
  wall.E = 1e6;
  EXPECT_GT(b.E_star(0, 1) / law(0).normal.E_star, 2) << "its own modulus";
}

/// Head on, of each pair, with the restitution of its own.
TEST(Materials, PairsReboundByTheirOwnRestitution) {
  MixedBench b;
  b.config.contact.pairs = {{{"grain", "steel"}, kOfEach, kOfEach, 0.4},
                            {{"rubber", "grain"}, kOfEach, kOfEach, 0.6},
                            {{"steel", "rubber"}, kOfEach, kOfEach, 0.8}};
  for (int k = 0; k < 3; ++k) {
    b.add({-b.R(), 0, 0.01 * k}, {0.1, 0, 0});
    b.add({b.R(), 0, 0.01 * k});
  }
  b.begin({0, 1, 0, 2, 1, 2});
  b.run(1e-7, 8000);
  ASSERT_EQ(b.solver->totals(*b.grains).contacts, 0);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR((b.velocity(2 * k + 1).x - b.velocity(2 * k).x) / 0.1, 0.4 + 0.2 * k, 1e-3) << k;
}

/// The law is that of both, whichever grain has the lower id.
TEST(Materials, PairsDoNotDependOnTheOrderOfIds) {
  const auto impact = [](bool steel_first) {
    MixedBench b;
    b.config.contact.rolling = "epsd";
    b.config.contact.pairs = {{{"steel", "rubber"}, 0.15, 0.2, 0.8}};
    const Vec3d steel{-b.R(), 0, 0}, rubber{b.R() - 1e-6, 1e-4, 2e-4}, v{0.1, 0.2, -0.1};
    if (steel_first) b.add(steel, v), b.add(rubber, {}, {10, 20, 30});
    if (!steel_first) b.add(rubber, {}, {10, 20, 30}), b.add(steel, v);
    b.begin({steel_first ? 1u : 2u, steel_first ? 2u : 1u});
    b.run(1e-7, 3000);
    const Id id = steel_first ? 0 : 1;
    return std::vector<Vec3d>{b.velocity(id), b.spin(id), b.velocity(1 - id), b.spin(1 - id)};
  };
  const auto one = impact(true), other = impact(false);
  ASSERT_GT(norm(one[3] - Vec3d{10, 20, 30}), 0.1) << "they slid";
  EXPECT_EQ(one, other);
}

/// The rolling couple of a pair is kept, whatever the first material has.
TEST(Materials, PairsRollByTheirOwnFriction) {
  const auto impact = [](double mu_r_of_the_first) {
    MixedBench b;
    b.config.contact.rolling = "epsd";
    b.config.grain.mu_r = mu_r_of_the_first;
    b.config.contact.pairs = {{{"steel", "rubber"}, 0.15, 0.2, 0.8}};
    b.add({-b.R(), 0, 0}, {0.1, 0, 0}, {0, 30, 0});
    b.add({b.R() - 1e-6, 0, 0}, {}, {0, -30, 0});
    b.begin({1, 2});
    b.run(1e-7, 3000);
    return std::vector<Vec3d>{b.spin(0), b.spin(1)};
  };
  const auto spins = impact(0);
  EXPECT_LT(std::abs(spins[0].y), 29.9) << "they rolled";
  EXPECT_EQ(spins, impact(0.3));
}

TEST(MaterialsSmall, OneMaterialHasTheLawsOfGrain) {
  const Config c = MixedBench().config;
  Config one = c;
  one.grain.materials.clear();
  const ElasticCompliance own(c.grain.E, c.grain.nu);
  const ContactLaw asked = make_contact_law({.normal = own.normal + own.normal,
                                             .tangential = own.tangential + own.tangential,
                                             .nu = c.grain.nu,
                                             .mu = c.grain.mu,
                                             .mu_r = c.grain.mu_r,
                                             .e = c.grain.e,
                                             .contact = c.contact});
  for (const Config& config : {one, c}) {
    const ContactLaw law = solid_parameters(config).pair_laws[0];
    EXPECT_EQ(law.mu, asked.mu);
    EXPECT_EQ(law.normal.alpha, asked.normal.alpha);
    EXPECT_EQ(law.normal.E_star, asked.normal.E_star);
    EXPECT_EQ(law.sliding.G_star, asked.sliding.G_star);
  }
}

TEST(MaterialsSmall, StepsFollowTheStiffestAndLightest) {
  Config c = MixedBench().config;
  c.grain.d_min = c.grain.d_max = c.grain.d;
  const auto rayleigh = [](const Config& config) { return SubstepLimits(config).at(0.1)[0].seconds; };
  Config glass = c;
  glass.grain.materials.clear(), glass.grain.fills.resize(1);
  const double G0 = 1e8 / 2.6, G1 = 2e9 / 2.56;
  EXPECT_NEAR(rayleigh(c) / rayleigh(glass),
              std::sqrt(7800 / G1 / (2500 / G0)) * (0.1631 * 0.3 + 0.8766) / (0.1631 * 0.28 + 0.8766), 1e-9);
  c.grain.fills.resize(1);
  EXPECT_EQ(rayleigh(c), rayleigh(glass)) << "of materials that are there";
}

TEST(DemocritusContact, DampsByRootTwoTimesCriticalAndSlidesBySofterSprings) {
  // [tsuzuki] Eqs. 28-33: c_n = 2 sqrt(2 m* k_n), k_t = k_n / (2 (1 + nu)), c_t = 2 sqrt(2 m* k_t)
  Config c;
  c.grain.d = 2.7e-3, c.grain.nu = 0.25;
  c.contact.normal = NormalLaw::democritus, c.contact.tangential = SlidingLaw::democritus;
  c.contact.rolling = RollingLaw::none, c.contact.clip_tension = false;
  c.grain.mu = 1e6;
  const ContactLaw law = contact_law_of(c);
  const Real R = Real(1.35e-3), m = Real(1e-5);
  const double overlap = 1e-6, distance = 2 * double(R) - overlap;
  const NormalState s = law.normal_state(R / 2, m / 2, Real(overlap));
  EXPECT_NEAR(s.damping / (2 * std::sqrt(2 * 0.5 * double(m) * double(s.stiffness))), 1, 1e-6);
  const ContactGeometry at = sphere_contact({R, m}, {R, m}, {0, 0, distance}, distance, overlap);
  ContactHistory h{{1e-8, 0, 0}, {}, overlap};
  const Real3 still = law(at, {}, {}, {}, 0, h).force;
  const double k_t = double(s.stiffness) / 2.5;
  EXPECT_NEAR(-still.x / (k_t * 1e-8), 1, 1e-5);
  h = {{1e-8, 0, 0}, {}, overlap};
  const Real3 slipping = law(at, {Real(0.01), 0, 0}, {}, {}, 0, h).force;
  EXPECT_NEAR((still.x - slipping.x) / 0.01 / (2 * std::sqrt(2 * 0.5 * double(m) * k_t)), 1, 1e-4);
}

}  // namespace
}  // namespace BL_SOLVER
