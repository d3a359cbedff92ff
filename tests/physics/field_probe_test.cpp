// Coarse-grained fields of grains, against sums over all grains and against the momentum balance.

#include <gtest/gtest.h>

#include <cmath>

#include "bedload/case/read.hpp"
#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kWidth = 0.012;  // m, of the kernel

/// Grains pressed together over a floor, across the periods of x and y: two sizes and two densities, as they
/// are at t = 0.
struct Heap {
  Config config;
  bedload::Setup setup;
  std::unique_ptr<Simulation> s;

  explicit Heap(int layers = 5) {
    Config& c = config;
    c.domain.min = {0, 0, 0}, c.domain.max = {0.05, 0.06, 0.05};
    c.domain.periodic = {true, true, false};
    c.gravity = {0, 0, -9.81};
    c.fluid.present = false;
    c.grain.present = true;
    c.grain.d = 5e-3, c.grain.d_min = 5e-3, c.grain.d_max = 6e-3;
    c.grain.materials.resize(1);
    c.grain.materials[0].name = "steel", c.grain.materials[0].rho = 7800;
    c.grain.materials[0] = c.grain.completed(c.grain.materials[0]);
    c.grain.fills.resize(2);
    c.grain.fills[1].material = "steel";
    c.wall.bodies = {test::tank(c.domain.min, c.domain.max, "z-")};
    for (int k = 0; k < layers; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
          const int n = int(setup.grains.x.size());
          const Vec3d jitter{std::sin(7.0 * n), std::sin(11.0 * n), std::sin(13.0 * n)};
          Vec3d x = 5.2e-3 * Vec3d{i - 1.5, j - 1.5, k + 0.5} + 2e-4 * jitter;
          for (int a = 0; a < 2; ++a) x[a] += x[a] < 0 ? c.domain.max[a] : 0;
          setup.grains.x.push_back(x);
          setup.grains.v.push_back(0.1 * Vec3d{1 + jitter.y, jitter.z, 40 * x.z});
          setup.grains.radius.push_back(n % 3 ? 2.5e-3 : 3e-3);
          setup.grains.fill.push_back(n % 5 == 0);
        }
    s = started(c, setup);
  }
  std::size_t size() const { return setup.grains.x.size(); }
  double volume(std::size_t i) const { return 4.0 / 3 * M_PI * cube(setup.grains.radius[i]); }
  double mass(std::size_t i) const { return volume(i) * (i % 5 == 0 ? 7800 : config.grain.rho); }
  /// Lucy's function at a point, from grain i.
  double W(std::size_t i, const Vec3d& at) const {
    return kernel(frame_of(config).separation(at, setup.grains.x[i]));
  }
  static double kernel(const Vec3d& from) {
    const double q = norm(from) / kWidth;
    return q < 1 ? 105 / (16 * M_PI * cube(kWidth)) * (1 + 3 * q) * cube(1 - q) : 0;
  }
};

ProbeConfig field(const Vec3d& at, std::vector<Vec3d> span = {}, std::vector<double> count = {}) {
  ProbeConfig p;
  p.name = "field", p.type = "field", p.at = at, p.radius = kWidth;
  p.span = std::move(span), p.count = std::move(count);
  return p;
}

TEST(SmallFieldProbe, IsTheSumOfTheGrainsAround) {
  const Heap heap;
  const std::vector<Vec3d> span{{0.01, 0.002, 0}, {0, 0.012, 0.003}, {0.001, 0, 0.02}};
  const ProbeConfig p = field({0.0005, 0.001, 0.002}, span, {3, 2, 4});
  const auto found = heap.s->measure(p);
  ASSERT_EQ(found.size(), 24u * 27);
  const double close = tolerance(1e-12, 1e-6, 1e-6);  // of radii and velocities
  for (int n = 0; n < 24; ++n) {
    const Vec3d at = p.at + (n % 3) / 2.0 * span[0] + (n / 3 % 2) / 1.0 * span[1] + (n / 6) / 3.0 * span[2];
    double volume = 0, mass = 0, twice = 0;  // twice the kinetic energy
    Vec3d momentum;
    for (std::size_t i = 0; i < heap.size(); ++i) {
      const double W = heap.W(i, at), m = heap.mass(i) * W;
      const Vec3d& v = heap.setup.grains.v[i];
      volume += heap.volume(i) * W, mass += m, momentum += m * v, twice += m * norm2(v);
    }
    ASSERT_GT(volume, 1e-3);
    const auto value = [&](const std::string& name) {
      return reading(found, name + "_" + std::to_string(n));
    };
    EXPECT_NEAR(value("solid_fraction") / volume, 1, close);
    EXPECT_NEAR(value("density") / mass, 1, close);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(value(std::string("velocity_") + "xyz"[k]), momentum[k] / mass, close);
    const double temperature = (twice / mass - norm2(momentum * (1 / mass))) / 3;
    EXPECT_NEAR(value("granular_temperature"), temperature, close * twice / mass);
    EXPECT_NEAR(value("kinetic_stress_xx") + value("kinetic_stress_yy") + value("kinetic_stress_zz"),
                -3 * mass * temperature, close * twice);
  }
  const auto far = heap.s->measure(field({0.025, 0.03, 0.045}));
  EXPECT_EQ(reading(far, "solid_fraction"), 0);
  EXPECT_EQ(reading(far, "contact_stress_zz"), 0);
  EXPECT_TRUE(std::isnan(reading(far, "velocity_x")));
  EXPECT_TRUE(std::isnan(reading(far, "granular_temperature")));
}

/// By differences over points, Pa/m.
Vec3d divergence_of_stress(Simulation& s, const Vec3d& at) {
  constexpr double kStep = 0.004 * kWidth;
  Vec3d divergence;
  for (int b = 0; b < 3; ++b) {
    Vec3d along;
    along[b] = 4 * kStep;
    const auto line = s.measure(field(at - 0.5 * along, {along}, {5}));
    for (int a = 0; a < 3; ++a) {
      const auto at_point = [&](int n) {
        return reading(line, std::string("contact_stress_") + "xyz"[a] + "xyz"[b] + "_" + std::to_string(n));
      };
      divergence[a] += (at_point(0) - 8 * at_point(1) + 8 * at_point(3) - at_point(4)) / (12 * kStep);
    }
  }
  return divergence;
}

/// div sigma = sum of F W over the grains, F their contact forces, farther than the kernel reaches from the
/// floor.
TEST(SmallFieldProbe, BalancesTheForcesOfContacts) {
  const Heap heap;
  const HostStore grains = heap.s->snapshot("grains");
  EXPECT_FALSE(grains.find("contact_stress")) << "not asked for";
  const std::vector<Vec3d> force = vectors(grains, "contact_force");
  for (const Vec3d& at : {Vec3d{0.001, 0.0015, 0.0155}, {0.048, 0.003, 0.02}}) {
    Vec3d expected;
    double magnitude = 0;
    for (std::size_t i = 0; i < heap.size(); ++i)
      expected += heap.W(i, at) * force[i], magnitude += heap.W(i, at) * norm(force[i]);
    ASSERT_GT(norm(expected), 0.01 * magnitude);
    // round-off of forces in mixed precision
    EXPECT_LT(norm(divergence_of_stress(*heap.s, at) - expected), 1e-6 * magnitude);
  }
}

/// Three rods across each other and a grain, across the periods: a clump counts where its centre of mass is.
TEST(SmallFieldProbe, BalancesClumpsAsWholes) {
  std::vector<std::string> warnings;
  const Config c = read_case_text(R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.06, 0.06, 0.06]
periodic = [true, true, true]
[[clump]]
name = "rod"
spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]
density = 2000
[grain]
d = 0.004
E = 1e6
[[grain.fill]]
positions = [[0.0005, 0.0595, 0.03], [0.0011, 0.0595, 0.0271]]
velocities = [[0.1, 0, 0], [0, 0.2, -0.1]]
spins = [[0, 10, 20], [0, 0, -30]]
clump = "rod"
orientation = [0, 0, 0]
[[grain.fill]]
positions = [[0.0019, 0.0599, 0.0329]]
velocities = [[0, 0, 0.3]]
clump = "rod"
orientation = [0, 0, 90]
[[grain.fill]]
positions = [[0.0019, 0.0594, 0.0363]]
velocities = [[0.1, 0.1, 0.1]]
[time]
end = 1
[out]
every = 1
)",
                                  "rods.toml", {}, warnings);
  auto s = started(c);
  const HostStore grains = s->snapshot("grains");
  const auto force = vectors(grains, "contact_force");
  const auto* clump = grains.find("clump")->as<std::uint32_t>();
  const auto ids = grains.find("id")->as<std::uint32_t>();
  struct Whole {
    Vec3d x, v, force;
    double rho;
  };
  std::vector<Whole> all;
  for (const GrainFill& fill : c.grain.fills)
    for (std::size_t k = 0; k < fill.positions.size(); ++k)
      all.push_back({fill.positions[k], fill.velocities[k], {}, fill.clump.empty() ? c.grain.rho : 2000});
  int touched = 0;
  for (std::size_t i = 0; i < grains.count; ++i) {
    all[clump[i] > 0 ? clump[i] - 1 : 3].force += force[ids[i]];
    touched += norm(force[ids[i]]) > 0;
  }
  ASSERT_EQ(touched, 8);
  const double each = M_PI / 6 * cube(0.004), close = tolerance(1e-12, 1e-6, 1e-6);
  for (const Vec3d& at : {Vec3d{0.002, 0.001, 0.031}, {0.058, 0.057, 0.034}}) {
    const auto found = s->measure(field(at));
    double volume = 0, mass = 0, magnitude = 0;
    Vec3d momentum, expected;
    for (const Whole& w : all) {
      const double W = Heap::kernel(frame_of(c).separation(at, w.x));
      volume += each * W, mass += w.rho * each * W, momentum += w.rho * each * W * w.v;
      expected += W * w.force, magnitude += W * norm(w.force);
    }
    EXPECT_NEAR(reading(found, "solid_fraction") / volume, 1, close);
    EXPECT_NEAR(reading(found, "density") / mass, 1, close);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(reading(found, std::string("velocity_") + "xyz"[k]), momentum[k] / mass, close);
    ASSERT_GT(norm(expected), 0.01 * magnitude);
    EXPECT_LT(norm(divergence_of_stress(*s, at) - expected), 2e-6 * magnitude);
  }
}

/// Rows that are means have the sums over their instants, in which velocities are means by mass; as after a
/// restart in between.
TEST(SmallFieldProbe, AveragesOverInstants) {
  Heap heap(2);
  ProbeConfig now = field({0.001, 0.002, 0.006}), mean = now;
  mean.name = "mean", mean.sample_every = 1e-9;  // of each step
  heap.config.out.probes = {now, mean};
  heap.s = started(heap.config, heap.setup);
  auto again = make_coupled(heap.config, heap.setup);
  for (int step = 0; step < 3; ++step) heap.s->step();
  heap.s->begin_interval(mean);
  const int steps = 6;
  double density = 0, momentum = 0, flow = 0, stress = 0;
  for (int step = 0; step < steps; ++step) {
    if (step == 3) again->load(heap.s->save());
    heap.s->step();
    if (step >= 3) again->step();
    const auto found = heap.s->measure(now);
    const double rho = reading(found, "density"), v = reading(found, "velocity_x");
    density += rho / steps, momentum += rho * v / steps;
    flow += (rho * v * v - reading(found, "kinetic_stress_xx")) / steps;
    stress += reading(found, "contact_stress_zz") / steps;
  }
  ASSERT_GT(density, 1);
  const auto found = heap.s->measure(mean);
  EXPECT_NEAR(reading(found, "density") / density, 1, 1e-12);
  EXPECT_NEAR(reading(found, "velocity_x") * density / momentum, 1, 1e-12);
  EXPECT_NEAR(reading(found, "contact_stress_zz") / stress, 1, 1e-12);
  EXPECT_NEAR(reading(found, "kinetic_stress_xx"), momentum * momentum / density - flow, 1e-12 * flow);
  EXPECT_NE(reading(found, "density"), reading(heap.s->measure(now), "density"));
  const auto restarted = again->measure(mean);
  for (std::size_t k = 0; k < found.size(); ++k)
    EXPECT_EQ(found[k].value, restarted[k].value) << found[k].name;
}

/// Integrals over all space are those of the grains: volume, force times distance, a contact each.
TEST(SmallFieldProbe, KeepsVolumeAndMoments) {
  Heap heap(0);
  heap.setup.grains.x = {{0.022, 0.03, 0.025}, {0.0265, 0.03, 0.025}};
  heap.setup.grains.v = {{}, {}};
  heap.setup.grains.radius = {2.5e-3, 2.5e-3};
  heap.setup.grains.fill = {0, 0};
  heap.config.out.fields = {"contact_stress"};
  heap.s = started(heap.config, heap.setup);
  const double force = vectors(heap.s->snapshot("grains"), "contact_force")[1].x;
  ASSERT_GT(force, 0);
  const Vec3d side{4.5e-3 + 2 * kWidth, 2 * kWidth, 2 * kWidth}, middle{0.02425, 0.03, 0.025};
  constexpr int kCount = 21;
  const auto found = heap.s->measure(
      field(middle - 0.5 * side, {{side.x, 0, 0}, {0, side.y, 0}, {0, 0, side.z}}, {kCount, kCount, kCount}));
  double sum[27] = {};
  for (std::size_t n = 0; n < found.size(); ++n) sum[n % 27] += found[n].value;
  const double each = side.x * side.y * side.z / std::pow(kCount - 1, 3), volume = 2 * heap.volume(0);
  const double close = 2e-4;  // of the sum over points, a tenth of the kernel's width apart
  ASSERT_EQ(found[0].name, "solid_fraction_0");
  EXPECT_NEAR(sum[0] * each / volume, 1, close);
  ASSERT_EQ(found[6].name, "contact_stress_xx_0");
  EXPECT_NEAR(sum[6] * each / (force * 4.5e-3), -1, close);
  ASSERT_EQ(found[21].name, "fabric_xx_0");
  EXPECT_NEAR(sum[21] * each / volume, 1, close);
  EXPECT_EQ(sum[10], 0);                                // contact_stress_yy
  const HostStore grains = heap.s->snapshot("grains");  // that of each grain, in frames
  const HostArray& stress = *grains.find("contact_stress");
  ASSERT_EQ(stress.components, 9);
  for (int k = 0; k < 18; ++k)
    EXPECT_NEAR(stress.as<Real>()[k] * heap.volume(0) / (force * 2.25e-3), k % 9 == 0 ? -1 : 0,
                tolerance(1e-9, 1e-5, 1e-5));
}

}  // namespace
}  // namespace BL_SOLVER
