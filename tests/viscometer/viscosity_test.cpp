// What layers of made-up particles come to.

#include "src/viscometer/viscosity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace bedload::test {
namespace {

constexpr double kEta = 7, kForce = 3, kH = 0.2, kBlocks = 12;

HostArray array_of(const char* name, int components, const std::vector<double>& values) {
  HostArray a{name, "-", Scalar::f64, components, {}};
  a.bytes.resize(values.size() * sizeof(double));
  std::memcpy(a.bytes.data(), values.data(), a.bytes.size());
  return a;
}

/// A particle in the middle of each of 200 layers, which moves along y as told, and carries the stress that
/// does.
struct Channel {
  PlaneFlow flow;
  std::function<double(double z)> velocity, stress, drive;
  double noise = 0;
  double kicks = 0;  ///< stress by the noise of pairs, Pa
  std::mt19937 random{4};

  HostStore sample(double drift) {
    std::normal_distribution<double> normal;
    std::vector<double> x, v, m, volume, force, moment;
    const double height = (flow.high - flow.low) / 200, V = flow.area * height;
    for (int n = 0; n < 200; ++n) {
      const double z = flow.low + (n + 0.5) * height;
      x.insert(x.end(), {0, 0, z});
      v.insert(v.end(), {0, velocity(z) + drift + noise * normal(random), 0});
      m.push_back(2 * V), volume.push_back(0.98 * V);  // densities come out 2 % too high
      force.insert(force.end(), {0, drive(z) * V, 0});
      moment.insert(moment.end(), {5 * V, 0, 0, 0, 6 * V, -stress(z) * V, 0, 0, 8 * V});
    }
    HostStore out{
        "fluid",
        200,
        {array_of("position", 3, x), array_of("velocity", 3, v), array_of("mass", 1, m),
         array_of("volume", 1, volume), array_of("drive", 3, force), array_of("stress_pressure", 9, moment)}};
    if (kicks != 0)
      out.arrays.push_back(array_of("stress_noise", 9, std::vector<double>(9 * 200, -kicks * V)));
    return out;
  }
  ViscosityResult measure(double wall_stress = 0) {
    Config c;
    c.fluid.rho0 = 2, c.fluid.mu = kEta, c.fluid.c = 10;
    c.wall.bodies.resize(2);
    Layers layers(flow, kH, 40, int(kBlocks));
    for (int block = 0; block < kBlocks; ++block)
      for (int k = 0; k < 5; ++k)
        layers.add(block, sample(flow.walled() ? 0 : 0.3 + 0.1 * k), {}, wall_stress);
    return evaluate(layers, c, kH);
  }
};

/// From z = -1 on, with a gap of 2.
Channel channel(PlaneFlowKind kind) {
  Channel c;
  const bool reverse = kind == PlaneFlowKind::reverse_poiseuille;
  c.flow = {kind, 1, 2, -1, reverse ? 3.0 : 1.0, -1, -1, 0.5, 0};
  if (!reverse) c.flow.lower = 0, c.flow.upper = 1;
  const auto turned = [reverse](double z) { return reverse && z > 1; };
  c.velocity = [=](double z) {
    const double s = turned(z) ? z - 1 : z + 1;
    return (turned(z) ? -1 : 1) * kForce / (2 * kEta) * s * (2 - s);
  };
  c.stress = [=](double z) { return (turned(z) ? -1 : 1) * kForce * (1 - (turned(z) ? z - 1 : z + 1)); };
  c.drive = [=](double z) { return turned(z) ? -kForce : kForce; };
  return c;
}

double named(const std::vector<Quantity>& all, const std::string& name) {
  for (const Quantity& q : all)
    if (q.name == name) return q.value;
  return std::nan("");
}

TEST(Viscosity, IsThatOfReversePoiseuilleFlow) {
  Channel c = channel(PlaneFlowKind::reverse_poiseuille);
  const ViscosityResult r = c.measure();
  EXPECT_NEAR(r.viscosity.mean, kEta, 1e-9) << "whatever the box drifts with";
  EXPECT_LT(r.viscosity.error, 1e-9);
  EXPECT_NEAR(r.r_squared, 1, 1e-9);
  EXPECT_NEAR(r.imposed, kForce, 1e-12);
  EXPECT_NEAR(r.peak, kForce / (2 * kEta), 1e-3);
  EXPECT_NEAR(r.mach, r.peak / 10, 1e-12);
  EXPECT_NEAR(r.reynolds, 2 * (kForce / (3 * kEta)) * 2 / kEta, 1e-3);
  EXPECT_TRUE(r.stationary());
  EXPECT_NEAR(r.stress_ratio.mean, 1, 1e-9);
  EXPECT_NEAR(r.normal_1.mean, 8 - 6,
              2e-3);  // along y, gradient z; the kinetic part has a trace of the shear
  EXPECT_NEAR(r.normal_2.mean, 5 - 8, 1e-9);
  EXPECT_NEAR(r.pressure, 19 / 3.0, 1e-3);
  EXPECT_EQ(r.stress.back().name, "total");
  const auto q = quantities_of(r, c.flow);
  EXPECT_NEAR(named(q, "viscosity"), kEta, 1e-9);
  EXPECT_NEAR(named(q, "force_density"), kForce, 1e-12);
}

TEST(Viscosity, HasAnErrorThatFitsItsNoise) {
  Channel c = channel(PlaneFlowKind::reverse_poiseuille);
  c.noise = 0.05;
  double squares = 0, told = 0;
  const int draws = 400;
  for (int n = 0; n < draws; ++n) {
    const ViscosityResult r = c.measure();
    squares += (r.viscosity.mean - kEta) * (r.viscosity.mean - kEta) / draws;
    told += r.viscosity.error * r.viscosity.error / draws;
  }
  EXPECT_GT(squares, 1e-6);
  EXPECT_NEAR(std::sqrt(told / squares), 1,
              0.11);  // so many draws tell a deviation to 3.5 %; three times that
}

/// Blocks that go faster and slower in turn by one percent: a mean of n with a deviation of 1 / sqrt(n - 1).
TEST(Viscosity, HasTheErrorOfAMeanOfItsBlocks) {
  Channel c = channel(PlaneFlowKind::reverse_poiseuille);
  Config config;
  config.fluid.rho0 = 2, config.fluid.mu = kEta, config.fluid.c = 10;
  Layers layers(c.flow, kH, 40, 12);
  const auto steady = c.velocity;
  for (int block = 0; block < 12; ++block) {
    c.velocity = [=](double z) { return (block % 2 ? 1.01 : 0.99) * steady(z); };
    layers.add(block, c.sample(0), {}, 0);
  }
  const ViscosityResult r = evaluate(layers, config, kH);
  EXPECT_NEAR(r.viscosity.mean, kEta, 1e-9);
  EXPECT_NEAR(r.viscosity.error / (0.01 * kEta / std::sqrt(11)), 1, 1e-9);
}

/// Beside walls and where the drive turns round the fluid is another; its stress tells nothing there.
TEST(Viscosity, StressIsComparedAwayFromThePlanes) {
  Channel c = channel(PlaneFlowKind::reverse_poiseuille);
  const auto right = c.stress;
  c.stress = [=](double z) {
    const double to_plane = std::abs(std::remainder(z + 1, 2));
    return to_plane < 0.9 * kH ? 5.0 : right(z);
  };
  EXPECT_NEAR(c.measure().stress_ratio.mean, 1, 1e-9);
}

TEST(Viscosity, LeavesTheNoiseOutOfTheWholeStress) {
  Channel c = channel(PlaneFlowKind::reverse_poiseuille);
  c.kicks = 50;
  const ViscosityResult r = c.measure();
  EXPECT_NEAR(r.stress_ratio.mean, 1, 1e-9);
  EXPECT_NEAR(r.normal_1.mean, 8 - 6, 2e-3);
  double told = 0;
  for (const StressPart& part : r.stress)
    if (part.name == "noise") told = part.mean[5];
  EXPECT_NEAR(told, 50, 1e-9);
}

TEST(Viscosity, OfWallsThatSlipIsThatOfTheFluid) {
  Channel c = channel(PlaneFlowKind::poiseuille);
  const double slip = 0.05;
  c.velocity = [=](double z) {
    return kForce / (2 * kEta) * ((1 + slip) * (1 + slip) - (z - 0.01) * (z - 0.01));
  };
  const ViscosityResult r = c.measure();
  EXPECT_NEAR(r.viscosity.mean, kEta, 1e-7);
  EXPECT_NEAR(r.slip_length, slip, 1e-9);
  EXPECT_NEAR(r.offset, 0.01, 1e-9);
}

TEST(Viscosity, OfCouetteFlowIsStressOverShear) {
  Channel c = channel(PlaneFlowKind::couette);
  c.flow.relative_speed = 0.6;
  c.velocity = [](double z) { return 0.3 + 0.6 / 2.2 * z; };
  c.stress = [](double) { return kEta * 0.6 / 2.2; };
  c.drive = [](double) { return 0; };
  const ViscosityResult r = c.measure(kEta * 0.6 / 2.2);
  EXPECT_NEAR(r.viscosity.mean, kEta, 1e-9);
  EXPECT_NEAR(r.slip_length, 0.1, 1e-9);
  EXPECT_NEAR(r.offset, 0, 1e-9);
  EXPECT_NEAR(r.stress_ratio.mean, 1, 1e-9);
}

TEST(Viscosity, OfCouetteFlowKnowsThatItsLowerWallMoves) {
  Channel c = channel(PlaneFlowKind::couette);
  c.flow.relative_speed = 0.6, c.flow.fastest = 0.4;
  c.velocity = [](double z) { return 0.65 + 0.3 + 0.6 / 2.2 * z; };
  c.stress = [](double) { return kEta * 0.6 / 2.2; };
  c.drive = [](double) { return 0; };
  Config config;
  config.fluid.rho0 = 2, config.fluid.mu = kEta, config.fluid.c = 10;
  config.wall.bodies.resize(2);
  config.wall.bodies[0].motion.kind = "velocity";
  config.wall.bodies[0].motion.velocity = {0, 0.5, 0};
  config.wall.bodies[0].surface_velocity = {0, 0.15, 0};
  Layers layers(c.flow, kH, 40, 12);
  for (int block = 0; block < 12; ++block) layers.add(block, c.sample(0), {}, kEta * 0.6 / 2.2);
  const ViscosityResult r = evaluate(layers, config, kH);
  EXPECT_NEAR(r.mach, 0.4 / 10, 1e-12) << "of the faster wall";
  EXPECT_NEAR(r.slip_length, 0.1, 1e-9);
  EXPECT_NEAR(r.offset, 0, 1e-9);
}

/// Particles of every second of the 40 layers: of the first, or of the second.
HostStore every_second(HostStore all, bool second) {
  for (HostArray& a : all.arrays) {
    HostBytes kept;
    const std::size_t size = std::size_t(a.components) * sizeof(double);
    for (std::size_t n = 0; n < all.count; ++n)
      if ((n / 5 % 2 == 1) == second)
        kept.insert(kept.end(), a.bytes.begin() + std::ptrdiff_t(n * size),
                    a.bytes.begin() + std::ptrdiff_t((n + 1) * size));
    a.bytes = kept;
  }
  all.count /= 2;
  return all;
}

TEST(Viscosity, CountsGrainsBetweenTheLayersOfALattice) {
  Channel c = channel(PlaneFlowKind::couette);
  c.flow.relative_speed = 0.6;
  c.velocity = [](double z) { return 0.3 * z; };
  c.stress = [](double) { return 0.3 * kEta; };
  c.drive = [](double) { return 0; };
  Config config;
  config.fluid.rho0 = 2, config.fluid.mu = kEta, config.fluid.c = 10;
  config.wall.bodies.resize(2);
  Layers layers(c.flow, kH, 40, 12);
  for (int block = 0; block < 12; ++block)
    layers.add(block, every_second(c.sample(0), false), every_second(c.sample(0), true), 0.3 * kEta);
  const ViscosityResult r = evaluate(layers, config, kH);
  EXPECT_NEAR(r.viscosity.mean, kEta, 1e-9);
  EXPECT_NEAR(r.stress_ratio.mean, 1, 0.01);
  EXPECT_EQ(r.profile.size(), 20u);
}

/// Beside the lower wall a layer that a particle enters once in twelve blocks, and in it grains that press.
TEST(Viscosity, TellsNoStressFromHardlyAParticle) {
  Channel c = channel(PlaneFlowKind::couette);
  c.flow.relative_speed = 0.6;
  c.velocity = [](double z) { return 0.3 * z; };
  c.stress = [](double) { return 0.3 * kEta; };
  c.drive = [](double) { return 0; };
  Config config;
  config.fluid.rho0 = 2, config.fluid.mu = kEta, config.fluid.c = 10;
  config.wall.bodies.resize(2);
  const auto only = [](HostStore all, std::size_t from, std::size_t to) {
    for (HostArray& a : all.arrays) {
      const std::size_t size = std::size_t(a.components) * sizeof(double);
      a.bytes = HostBytes(a.bytes.begin() + std::ptrdiff_t(from * size),
                                       a.bytes.begin() + std::ptrdiff_t(to * size));
    }
    all.count = to - from;
    return all;
  };
  Layers layers(c.flow, kH, 40, 12);
  for (int block = 0; block < 12; ++block)
    layers.add(block, only(c.sample(0), block == 7 ? 4 : 5, 200), only(c.sample(0), 0, 5), 0.3 * kEta);
  const ViscosityResult r = evaluate(layers, config, kH);
  ASSERT_EQ(r.profile.size(), 39u) << "the layer with a particle is none of its own";
  for (const ProfileRow& row : r.profile) {
    EXPECT_LT(std::abs(row.shear_stress), 2.2 * 0.3 * kEta) << row.z;
    EXPECT_GT(row.filled, 0.9) << row.z;
  }
  // what the grains there bear is not lost: it counts beside them
  EXPECT_GT(r.profile[0].shear_stress, 1.9 * 0.3 * kEta);
  EXPECT_NEAR(r.profile[1].shear_stress, 0.3 * kEta, 0.02 * kEta);
}

TEST(Viscosity, OverThatWithoutGrainsComesWithItsCaveat) {
  const std::string bare = relative_caveat(0.2, false), law = relative_caveat(0.2, true);
  EXPECT_NE(bare.find("the stress of contacts and lubrication alone; resolved spheres at 20 % have 1.50 "
                      "(Einstein) to 1.82 (Krieger-Dougherty, phi_m = 0.64)"),
            bare.npos)
      << bare;
  EXPECT_NE(law.find("on top of the law of couple.suspension_viscosity"), law.npos) << law;
}

TEST(Viscosity, OfImagesThatMoveIsStressOverTheirShear) {
  Channel c = channel(PlaneFlowKind::lees_edwards);
  c.flow.lower = c.flow.upper = -1;
  c.flow.relative_speed = 0.6;
  c.velocity = [](double z) { return 0.3 * z; };
  c.stress = [](double) { return kEta * 0.3; };
  c.drive = [](double) { return 0; };
  const ViscosityResult r = c.measure();
  EXPECT_NEAR(r.viscosity.mean, kEta, 1e-9);
  EXPECT_NEAR(r.r_squared, 1, 1e-9);
  EXPECT_NEAR(r.peak, 0.6, 1e-12);
  EXPECT_NEAR(r.mach, 0.3 * kH / 10, 1e-12) << "by the reach, which is h here";
  EXPECT_NEAR(named(quantities_of(r, c.flow), "shear_stress"), kEta * 0.3, 1e-9);
  c.kicks = 2;
  EXPECT_NEAR(c.measure().viscosity.mean, kEta, 1e-9) << "noise has no mean";
  c.velocity = [](double z) { return 0.29 * z; };
  EXPECT_NEAR(c.measure().viscosity.mean, kEta, 1e-9) << "the mean shear is imposed, whatever the profile";
  c.velocity = [](double z) { return z < 0 ? -0.1 : 0.1; };
  EXPECT_LT(c.measure().r_squared, 0.95);
}

TEST(Viscosity, IsNotToldOfAnotherProfile) {
  Channel c = channel(PlaneFlowKind::reverse_poiseuille);
  c.velocity = [](double z) { return z < 1 ? 0.1 : -0.1; };  // plugs
  const ViscosityResult r = c.measure();
  EXPECT_LT(r.r_squared, 0.95);
  EXPECT_TRUE(std::isnan(named(quantities_of(r, c.flow), "viscosity")));
}

TEST(Viscosity, IsNotSteadyWhereItDrifts) {
  Channel c = channel(PlaneFlowKind::reverse_poiseuille);
  Config config;
  config.fluid.rho0 = 2, config.fluid.mu = kEta, config.fluid.c = 10;
  Layers layers(c.flow, kH, 40, 12);
  const auto steady = c.velocity;
  for (int block = 0; block < 12; ++block) {
    c.velocity = [=](double z) { return (0.9 + 0.01 * block) * steady(z); };
    layers.add(block, c.sample(0), {}, 0);
  }
  const ViscosityResult r = evaluate(layers, config, kH);
  EXPECT_NEAR(r.drift, -0.063, 0.005);
  EXPECT_FALSE(r.stationary());
  // halves that differ by less than their blocks among themselves are steady
  Layers uneven(c.flow, kH, 40, 12);
  for (int block = 0; block < 12; ++block) {
    c.velocity = [=](double z) { return (block % 2 && block != 7 ? 0.95 : 1.05) * steady(z); };
    uneven.add(block, c.sample(0), {}, 0);
  }
  const ViscosityResult noisy = evaluate(uneven, config, kH);
  EXPECT_NEAR(noisy.drift, -0.0164, 1e-3);
  EXPECT_TRUE(noisy.stationary());
}

}  // namespace
}  // namespace bedload::test
