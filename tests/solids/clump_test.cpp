// Clumps that fall, turn, strike and collide.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bedload/case/read.hpp"
#include "bedload/geometry/body.hpp"
#include "bedload/geometry/clump.hpp"
#include "tests/support/free_body.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// A case of 0.4 m each way without gravity, of grains that rebound fully without friction.
std::string in_space(const std::string& rest) {
  return R"(gravity = [0, 0, 0]
[domain]
min = [-0.2, -0.2, -0.2]
max = [0.2, 0.2, 0.2]
[time]
end = 100
[out]
every = 100
[contact]
rolling = "none"
[grain]
d = 0.01
E = 1e7
mu = 0
e = 1
)" + rest;
}

Config config_of(const std::string& text) {
  std::vector<std::string> warnings;
  return read_case_text(text, "clump.toml", {}, warnings);
}

/// An array of the clumps, by id, as vectors of n.
template <int n>
std::vector<std::array<double, n>> of_clumps(Simulation& s, const char* name) {
  const HostStore store = s.snapshot("clumps");
  const HostArray& a = *store.find(name);
  const auto* id = store.find("id")->as<std::uint32_t>();
  std::vector<std::array<double, n>> out(store.count);
  for (std::size_t c = 0; c < store.count; ++c)
    for (int k = 0; k < n; ++k)
      out[id[c] - 1][k] = a.type == Scalar::f64 ? a.as<double>()[n * c + k] : a.as<float>()[n * c + k];
  return out;
}
Vec3d vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
Quat<double> turn_of(Simulation& s, std::size_t clump) {
  const auto q = of_clumps<4>(s, "rotation")[clump];
  return {q[3], q[0], q[1], q[2]};
}
double kinetic(Simulation& s) {
  const auto d = s.diagnostics();
  return reading(d, "grain_kinetic_energy") + reading(d, "grain_rotational_energy");
}

TEST(Clump, OfOneSphereMovesAsAGrain) {
  // two columns: a loose grain, or a clump of one sphere, on a floor, and a loose grain that strikes it
  const Config c = config_of(R"([domain]
min = [0, 0, 0]
max = [0.2, 0.1, 0.1]
[time]
end = 1
[out]
every = 1
[[wall.body]]
name = "floor"
shape = "plane"
point = [0, 0, 0.01]
normal = [0, 0, 1]
[[clump]]
name = "ball"
spheres = [[1, 2, 3, 4]]
[grain]
d = 0.01
E = 1e6
[[grain.fill]]
positions = [[0.05, 0.05, 0.02], [0.053, 0.052, 0.035], [0.153, 0.052, 0.035]]
velocity = [0.1, 0, -0.2]
spin = [3, -5, 7]
[[grain.fill]]
positions = [[0.15, 0.05, 0.02]]
velocity = [0.1, 0, -0.2]
spin = [3, -5, 7]
clump = "ball"
orientation = [20, 30, 40]
)");
  auto s = started(c);
  run_until(*s, 0.15);
  const HostStore grains = s->snapshot("grains");
  const auto x = vectors(grains, "position"), v = vectors(grains, "velocity"),
             w = vectors(grains, "angular_velocity");
  EXPECT_GT(norm(x[0] - Vec3d{0.05, 0.05, 0.02}), 5e-3);
  const double near = tolerance(1e-9, 1e-5, 1e-4);  // of a diameter, of the speed
  for (const auto& [clump, grain] : {std::pair{3, 0}, {2, 1}}) {
    EXPECT_LT(norm(x[clump] - x[grain] - Vec3d{0.1, 0, 0}), near * 0.01);
    EXPECT_LT(norm(v[clump] - v[grain]), near * 0.3);
    EXPECT_LT(norm(w[clump] - w[grain]), near * 30);
  }
}

TEST(Clump, FreeTumblesWithThePeriodOfEulersEquations) {
  const Config c = config_of(in_space(R"([[clump]]
name = "stone"
spheres = [[-1, 0, 0, 1], [0.8, 0.3, 0, 0.9], [0, 1.4, 0.2, 0.6]]
[[grain.fill]]
positions = [[0, 0, 0]]
spin = [10, 25, 8]
velocity = [0.01, 0, 0]
clump = "stone"
orientation = [0, 0, 0]
)"));
  auto s = started(c);
  const ClumpShape& shape = c.grain.clumps[0].shape;
  const PrincipalInertia principal = principal_inertia(shape.inertia);
  std::array<double, 3> I{};  // rising, in units of rho d^5, as angular momenta here
  for (int k = 0; k < 3; ++k) I[k] = principal.moments[k];
  const auto in_body = [&] {
    const Quat<double> frame = turn_of(*s, 0) * principal.axes;
    return frame.conjugate().rotate(vector(of_clumps<3>(*s, "angular_momentum")[0])) *
           (1 / (2500 * std::pow(0.01, 5)));
  };
  const Vec3d l = in_body(), L0 = vector(of_clumps<3>(*s, "angular_momentum")[0]);
  const double energy = 0.5 * (l.x * l.x / I[0] + l.y * l.y / I[1] + l.z * l.z / I[2]), l2 = norm2(l);
  ASSERT_TRUE(I[0] < I[1] && I[1] < I[2]);
  if (l2 < 2 * energy * I[1]) std::swap(I[0], I[2]);  // it turns about the axis of the least moment
  // Landau and Lifshitz, Mechanics, section 37
  const double down = l2 - 2 * energy * I[0], up = 2 * energy * I[2] - l2;
  const double k = std::sqrt((I[1] - I[0]) * up / ((I[2] - I[1]) * down));
  const double period = 4 * std::comp_ellint_1(k) * std::sqrt(I[0] * I[1] * I[2] / ((I[2] - I[1]) * down));
  const double before = kinetic(*s);
  std::vector<double> crossings;
  for (double t = s->time(), last = l.y; crossings.size() < 5;) {
    s->step();
    const double now = in_body().y;
    if (last < 0 && now >= 0) crossings.push_back(t + (s->time() - t) * last / (last - now));
    last = now, t = s->time();
    ASSERT_LT(t, 20 * period);
  }
  EXPECT_NEAR((crossings[4] - crossings[0]) / 4 / period, 1, 1e-3);
  EXPECT_NEAR(kinetic(*s) / before, 1, 1e-6);
  EXPECT_LT(norm(vector(of_clumps<3>(*s, "angular_momentum")[0]) - L0), 1e-12 * norm(L0));
  const auto at = vectors(s->snapshot("grains"), "position");
  const double side = norm(at[1] - at[0]) / norm(vector({1.8, 0.3, 0}));
  EXPECT_NEAR(norm(at[2] - at[1]) / norm(vector({0.8, 1.1, 0.2})) / side, 1, 1e-5) << "it is rigid";
}

TEST(Clump, RodOnItsEndReboundsAsARigidBody) {
  for (const double angle : {45.0, 60.0, 80.0}) {
    const Config c = config_of(in_space(R"([[wall.body]]
name = "floor"
shape = "plane"
point = [0, 0, -0.1]
normal = [0, 0, 1]
[[clump]]
name = "rod"
spheres = [[-1.2, 0, 0, 1], [0, 0, 0, 1], [1.2, 0, 0, 1]]
[[grain.fill]]
positions = [[0, 0, -0.08]]
velocity = [0, 0, -0.05]
clump = "rod"
orientation = [0, )" + std::to_string(angle) +
                                        ", 0]\n"));
    auto s = started(c);
    const ClumpShape& shape = c.grain.clumps[0].shape;
    run_until(*s, 0.5);
    const double v = vector(of_clumps<3>(*s, "velocity")[0]).z + 0.05;
    const Vec3d w = vector(of_clumps<3>(*s, "angular_velocity")[0]);
    const double m = M_PI / 6, I = shape.inertia[1], x = shape.spheres[2][0] * std::cos(angle * M_PI / 180);
    const double J = 2 * m * 0.05 / (1 + m * x * x / I);  // [rho d^3 m/s], lengths in d
    EXPECT_NEAR(v / (J / m), 1, 5e-3) << angle;
    EXPECT_NEAR(w.y / (-J * x / I / 0.01), 1, 5e-3) << angle;
    EXPECT_LT(std::abs(w.x) + std::abs(w.z), 1e-3 * std::abs(w.y));
  }
}

TEST(Clump, FallsWithoutTurning) {
  const Config c = config_of(R"([domain]
min = [0, 0, 0]
max = [0.2, 0.2, 1]
[time]
end = 1
[out]
every = 1
[[clump]]
name = "drop"
spheres = [[0, 0, 0, 1], [0.9, 0, 0, 0.6], [1.2, 0.3, 0, 0.5]]
[grain]
d = 0.01
[[grain.fill]]
positions = [[0.1, 0.1, 0.9]]
clump = "drop"
)");
  ASSERT_GT(norm(c.grain.clumps[0].shape.offset), 0.01) << "its spheres' centre is not that of its mass";
  auto s = started(c);
  run_until(*s, 0.3);
  const double t = s->time();
  EXPECT_NEAR(vector(of_clumps<3>(*s, "velocity")[0]).z / (-9.81 * t), 1, tolerance(1e-12, 1e-6, 1e-5));
  EXPECT_LT(norm(vector(of_clumps<3>(*s, "angular_velocity")[0])), tolerance(1e-9, 1e-3, 1e-3));
}

std::string list_of(const Vec3d& v) {
  return "[" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + "],";
}

/// Rods and grains that fly at each other's centre.
std::string swarm(const std::string& of_grains = "") {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-1, 1);
  std::string places[2], speeds[2];
  int n = 0;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k, ++n) {
        const Vec3d x{0.03 * i, 0.03 * j, 0.03 * k};
        const Vec3d v{-8 * x.x + 0.05 * u(rng), -8 * x.y + 0.05 * u(rng), -8 * x.z + 0.05 * u(rng)};
        places[n % 2] += list_of(x);
        speeds[n % 2] += list_of(v);
      }
  const auto fill = [&](int k) {
    return "[[grain.fill]]\npositions = [" + places[k] + "]\nvelocities = [" + speeds[k] + "]\n";
  };
  return in_space(of_grains + R"([[clump]]
name = "rod"
spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1.2, 0.2, 0, 0.7]]
)" + fill(0) + "clump = \"rod\"\n" +
                  fill(1));
}

TEST(Clump, CollisionsKeepMomentaAndEnergy) {
  const Config c = config_of(swarm());
  auto s = started(c);
  const auto before = s->diagnostics();
  const double energy = kinetic(*s), mass = reading(before, "grain_mass");
  EXPECT_NEAR(mass, 27 * 2500 * M_PI / 6 * 1e-6, 1e-6 * mass);
  run_until(*s, 0.2);
  const auto after = s->diagnostics();
  const double p = std::sqrt(2 * mass * energy);
  EXPECT_LT(norm(vector_of(after, "grain_momentum") - vector_of(before, "grain_momentum")),
            10 * kInvariant * p);
  EXPECT_LT(norm(vector_of(after, "grain_angular_momentum") - vector_of(before, "grain_angular_momentum")),
            10 * kInvariant * p * 0.05);
  EXPECT_NEAR((kinetic(*s) + reading(after, "grain_elastic_energy")) / energy, 1, 5e-3);
  EXPECT_GT(reading(after, "grain_rotational_energy"), 0.05 * energy) << "they have struck each other";
}

TEST(SmallClump, GoesOnFromACheckpointBitForBit) {
  const Config c = config_of(swarm("mu_r = 0.1\n"));
  auto whole = started(c), again = started(c);
  run_until(*whole, 0.1);
  run_until(*again, 0.1);
  EXPECT_EQ(bits(*whole), bits(*again)) << "the same run twice";
  auto parted = make_coupled(c, {});
  parted->load(whole->save());
  for (int k = 0; k < 60; ++k) whole->step(), parted->step();
  EXPECT_GT(reading(whole->diagnostics(), "grain_rotational_energy"), 0);
  EXPECT_EQ(bits(*whole), bits(*parted));
}

/// Rods, whose spheres' centre is not that of mass, and grains that fall on a floor that slides: what they
/// gain and lose of energy is work of gravity and the floor and what contacts dissipate.
TEST(SmallClump, EnergyIsCounted) {
  const Config c = config_of(R"([domain]
min = [0, 0, 0]
max = [0.06, 0.06, 0.2]
periodic = [true, true, false]
[time]
end = 100
[out]
every = 100
spectra = true
[[wall.body]]
name = "floor"
shape = "plane"
point = [0, 0, 0.01]
normal = [0, 0, 1]
surface_velocity = [0.2, 0, 0]
[[clump]]
name = "rod"
spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1.2, 0.2, 0, 0.7]]
[grain]
d = 0.01
E = 1e7
mu = 0.5
e = 0.6
[[grain.fill]]
min = [0, 0, 0.02]
max = [0.06, 0.06, 0.1]
count = 20
clump = "rod"
[[grain.fill]]
min = [0, 0, 0.02]
max = [0.06, 0.06, 0.1]
count = 20
)");
  auto s = started(c);
  run_until(*s, 0.15);
  const auto d = s->diagnostics();
  const auto term = [&](const char* name) { return reading(d, std::string("grain_") + name); };
  const double lost = term("dissipated_normal") + term("dissipated_sliding") + term("dissipated_rolling");
  EXPECT_GT(lost, 0.3 * term("work_gravity"));
  EXPECT_GT(term("work_walls"), 0);
  EXPECT_LT(std::abs(term("energy_residual")), 1e-3 * lost);
  EXPECT_NEAR(term("work_gravity"),
              reading(started(c)->diagnostics(), "grain_potential_energy") - term("potential_energy"),
              1e-3 * lost);
  EXPECT_EQ(s->spectra()[0][9].name, "rod_of_grain_rod_of_grain_normal_count");
}

/// Still water around a clump that is denser.
std::string in_water(const std::string& rest) {
  return R"(gravity = [0, 0, -9.81]
[domain]
min = [0, 0, 0]
max = [0.08, 0.08, 0.08]
periodic = [true, true, false]
[fluid]
dx = 0.005
vmax = 0.5
[[fluid.fill]]
min = [0, 0, 0]
max = [0.08, 0.08, 0.06]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.08, 0.08, 0.08]
faces = ["z-"]
[drag]
law = "stokes"
[[clump]]
name = "rod"
spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]
[time]
end = 1
[out]
every = 1
[grain]
d = 0.004
)" + rest;
}

TEST(Clump, InFluidHasTheDragOfItsVolumeAndDisplacesIt) {
  const Config c = config_of(in_water(R"([[grain.fill]]
positions = [[0.04, 0.04, 0.03]]
clump = "rod"
[[grain.fill]]
positions = [[0.01, 0.04, 0.03]]
)"));
  auto s = started(c);
  s->step();
  const HostStore grains = s->snapshot("grains"), sums = s->rheology("grains");
  const auto volume = scalars({"grains", sums.count, {*sums.find("volume"), *grains.find("id")}}, "volume");
  const double v = M_PI / 6 * std::pow(0.004, 3);
  EXPECT_NEAR((volume[0] + volume[1] + volume[2]) / v, 1, 1e-5);
  EXPECT_NEAR(volume[3] / v, 1, 1e-5);
  double K[4] = {};
  for (const HostStore& store : s->save().stores)
    if (store.name == "grains") {
      const auto all = scalars(store, "drag_coefficient");
      for (int k = 0; k < 4; ++k) K[k] = all[k];
    }
  ASSERT_GT(K[3], 0);
  EXPECT_NEAR((K[0] + K[1] + K[2]) / K[3], 1, 0.02) << "Stokes: 3 pi mu d; porosities differ a little";
  EXPECT_NEAR(K[0] / K[1], 1, 0.02);
  const auto buoyancy = vectors(grains, "fluid_force");
  EXPECT_NEAR((buoyancy[0].z + buoyancy[1].z + buoyancy[2].z) / buoyancy[3].z, 1, 0.1);
}

/// Fluid at rest, ten times as viscous as glycerol-water, in a periodic box without gravity. one_way: the
/// grains do not act on it.
std::string at_rest(const std::string& rest, bool one_way = true) {
  return std::string(R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.06, 0.06, 0.06]
periodic = [true, true, true]
[time]
end = 1
[out]
every = 1
energy = true
[fluid]
dx = 0.006
mu = 0.1
vmax = 0.1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.06, 0.06, 0.06]
[drag]
law = "stokes"
)") + (one_way ? "[couple]\nmode = \"one_way\"\n" : "") +
         R"([grain]
d = 0.004
E = 1e6
[[clump]]
name = "ball"
spheres = [[1, 2, 3, 4]]
drag = "clump"
[[clump]]
name = "marble"
spheres = [[1, 2, 3, 4]]
drag = "members"
)" + rest;
}
std::string clump(const std::string& name, const std::string& spheres, const std::string& drag) {
  return "[[clump]]\nname = \"" + name + "\"\nspheres = " + spheres + "\ndrag = \"" + drag + "\"\n";
}
const std::string kRodSpheres = "[[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]",
                  kDropSpheres = "[[0, 0, 0, 1], [0.9, 0, 0, 0.6], [1.2, 0.3, 0, 0.5]]";

TEST(Clump, FallsAtTheSpeedOfItsVolumeOrOfItsSpheres) {
  const double a = 2, d = 0.004, mass = 2500 * M_PI / 6 * d * d * d;
  for (const std::string drag : {"clump", "members"}) {
    const Config c = config_of(at_rest(clump("rod", kRodSpheres, drag) + R"([[grain.fill]]
positions = [[0.03, 0.03, 0.03]]
clump = "rod"
[drive]
f = [0, 0, -2]
mode = "mass"
on = "grains"
)"));
    auto s = started(c);
    run_until(*s, 0.3);
    double of_spheres = 0;
    for (const ClumpSphere& sphere : c.grain.clumps[2].shape.spheres) of_spheres += 2 * sphere[3];
    EXPECT_GT(of_spheres, 1.5);
    const double K = 3 * M_PI * 0.1 * d * (drag == "clump" ? 1 : of_spheres);
    EXPECT_NEAR(vector(of_clumps<3>(*s, "velocity")[0]).z / (-a * mass / K), 1, 0.01) << drag;
  }
}

TEST(Clump, OfOneSphereHasTheDragOfAGrain) {
  std::vector<Vec3d> v, w;
  for (const std::string of : {"", "clump = \"ball\"\n", "clump = \"marble\"\n"}) {
    auto s = started(config_of(at_rest("[[grain.fill]]\npositions = [[0.031, 0.03, 0.029]]\n" + of +
                                           "velocity = [0.05, 0.01, 0]\nspin = [0, 10, 0]\n",
                                       false)));
    run_until(*s, 0.01);
    const HostStore grains = s->snapshot("grains");
    v.push_back(vectors(grains, "velocity")[0]), w.push_back(vectors(grains, "angular_velocity")[0]);
  }
  ASSERT_LT(norm(v[0]), 0.9 * std::hypot(0.05, 0.01));
  for (const int clump : {1, 2}) {
    EXPECT_LT(norm(v[clump] - v[0]), tolerance(1e-12, 1e-6, 1e-5) * norm(v[0])) << clump;
    EXPECT_LT(norm(w[clump] - w[0]), tolerance(1e-12, 1e-6, 1e-5) * norm(w[0])) << clump;
  }
}

TEST(Clump, DragActsAtItsCentre) {
  const Config c = config_of(at_rest(clump("drop", kDropSpheres, "clump") + R"([[grain.fill]]
positions = [[0.03, 0.03, 0.03]]
velocity = [0.02, 0, 0.01]
clump = "drop"
orientation = [20, 50, 0]
)"));
  ASSERT_GT(norm(c.grain.clumps[2].shape.offset), 0.01) << "its spheres' centre is not that of its mass";
  auto s = started(c);
  run_until(*s, 0.02);
  const double k = 18 * 0.1 / (2500 * 0.004 * 0.004);  // 1/s
  EXPECT_NEAR(
      norm(vector(of_clumps<3>(*s, "velocity")[0])) / (std::hypot(0.02, 0.01) * std::exp(-k * s->time())), 1,
      0.01);
  EXPECT_LT(norm(vector(of_clumps<3>(*s, "angular_velocity")[0])), tolerance(1e-9, 1e-4, 1e-4));
}

/// Drops that hit each other in fluid that they stir.
TEST(Clump, ExchangesMomentumWithTheFluidAndCountsItsWork) {
  const Config c = config_of(at_rest(clump("drop", kDropSpheres, "clump") + R"([[grain.fill]]
positions = [[0.025, 0.03, 0.03], [0.034, 0.03, 0.031], [0.03, 0.036, 0.03]]
velocities = [[0.08, 0.01, 0], [-0.08, 0, 0], [0, -0.06, 0]]
clump = "drop"
)",
                                     false));
  auto whole = started(c);
  const auto momentum = [](const std::vector<Quantity>& d) {
    return vector_of(d, "grain_momentum") + vector_of(d, "fluid_momentum");
  };
  const auto before = whole->diagnostics();
  const double p = 3 * 2500 * M_PI / 6 * std::pow(0.004, 3) * 0.08;
  ASSERT_GT(norm(vector_of(before, "grain_momentum")), 0.1 * p);
  run_until(*whole, 0.02);
  const auto after = whole->diagnostics();
  EXPECT_LT(norm(momentum(after) - momentum(before)), tolerance(1e-12, 1e-5, 1e-4) * p);
  EXPECT_GT(norm(vector_of(after, "fluid_momentum") - vector_of(before, "fluid_momentum")), 0.03 * p);
  const double work = -reading(after, "grain_work_fluid");
  EXPECT_GT(work, 0.3 * kinetic(*started(c)));
  EXPECT_LT(std::abs(reading(after, "grain_energy_residual")), 5e-3 * work);
  auto parted = make_coupled(c, {});
  parted->load(whole->save());
  for (int k = 0; k < 5; ++k) whole->step(), parted->step();
  EXPECT_EQ(bits(*whole), bits(*parted));
}

TEST(Clump, BedsSettleForCasesWithFluidAndInletsOfClumps) {
  for (const std::string clump : {"", "clump = \"rod\"\n"}) {
    const Config c = config_of(in_water(R"([[grain.fill]]
min = [0, 0, 0.01]
max = [0.08, 0.08, 0.05]
count = 10
)" + clump + R"([[grain_inlet]]
name = "feed"
min = [0.02, 0.02, 0.05]
max = [0.06, 0.06, 0.07]
rate = 1e5
clump = "rod"
)"));
    auto bed = started(settling_case(c));
    bed->settle(1e-3, [](double) {});
    auto s = started(c);
    s->load_grains(bed->save_grains());
    for (int k = 0; k < 3; ++k) s->step();
    const double filled = clump.empty() ? 0 : 10, come = reading(s->diagnostics(), "grain_inlet_feed_count");
    EXPECT_GT(come, 0);
    EXPECT_EQ(reading(s->diagnostics(), "clump_count"), filled + come);
  }
}

TEST(SmallClump, InFluidGoesOnFromACheckpointBitForBit) {
  const Config c = config_of(in_water(R"([[grain.fill]]
min = [0, 0, 0.01]
max = [0.08, 0.08, 0.05]
count = 40
clump = "rod"
)"));
  auto whole = started(c);
  for (int k = 0; k < 30; ++k) whole->step();
  auto parted = make_coupled(c, {});
  parted->load(whole->save());
  for (int k = 0; k < 20; ++k) whole->step(), parted->step();
  EXPECT_EQ(bits(*whole), bits(*parted));
}

}  // namespace
}  // namespace BL_SOLVER
