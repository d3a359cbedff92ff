// Grains that move as one rigid body.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/drag/di_felice.hpp"
#include "tests/support/free_body.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kDiameter = 6e-3;  // m

/// A jack of seven grains, fill 1, amid loose ones that fly at it, fill 0; without gravity.
struct Swarm {
  Config config;
  bedload::Setup setup;
  Swarm() {
    Config& c = config = void_case();
    c.domain.min = {-0.1, -0.1, -0.1}, c.domain.max = {0.1, 0.1, 0.1};
    c.gravity = {};
    c.grain.present = true;
    c.grain.d = c.grain.d_min = c.grain.d_max = kDiameter;
    c.grain.E = 1e6;
    c.grain.fills.resize(2);
    c.grain.fills[1].rigid.present = true;
    std::vector<Vec3d> jack{{0, 0, 0}};
    for (int k = 0; k < 3; ++k)
      for (const double side : {-1.0, 1.0}) {
        Vec3d x;
        x[k] = side * 0.99 * kDiameter;  // they overlap, and do not mind
        jack.push_back(x);
      }
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> u(-1, 1);
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j)
        for (int k = -2; k <= 2; ++k) {
          const Vec3d x{0.009 * i + 1e-3 * u(rng), 0.009 * j + 1e-3 * u(rng), 0.009 * k + 1e-3 * u(rng)};
          bool clear = true;
          for (const Vec3d& y : jack) clear = clear && norm(x - y) > 1.05 * kDiameter;
          if (clear) add(x, x * -12.0 + Vec3d{0.1 * u(rng), 0.1 * u(rng), 0.1 * u(rng)}, 0);
        }
    for (const Vec3d& x : jack) add(x, {}, 1);
  }
  void add(const Vec3d& x, const Vec3d& v, std::uint32_t fill) {
    setup.grains.x.push_back(x);
    setup.grains.v.push_back(v);
    setup.grains.radius.push_back(kDiameter / 2);
    setup.grains.fill.push_back(fill);
  }
};

TEST(RigidGroup, KeepsItsShapeAndWithTheOthersItsMomenta) {
  const Swarm swarm;
  auto s = started(swarm.config, swarm.setup);
  const auto before = s->diagnostics();
  const double v = std::sqrt(2 * reading(before, "grain_kinetic_energy") / reading(before, "grain_mass"));
  run_until(*s, 0.03);
  const auto after = s->diagnostics();
  const double p = reading(before, "grain_mass") * v;
  EXPECT_LT(norm(vector_of(after, "grain_momentum") - vector_of(before, "grain_momentum")),
            10 * kInvariant * p);
  EXPECT_LT(norm(vector_of(after, "grain_angular_momentum") - vector_of(before, "grain_angular_momentum")),
            10 * kInvariant * p * 0.03);
  const auto b = s->body_state(0);
  EXPECT_GT(norm(vector_of(b, "velocity")), 1e-3) << "it has been hit";
  EXPECT_GT(norm(vector_of(b, "angular_velocity")), 0.1);
  const auto x = vectors(s->snapshot("grains"), "position");
  const std::size_t first = x.size() - 7;
  const Quat<double> turn = rotation_of(b);
  for (std::size_t i = first; i < x.size(); ++i)
    EXPECT_LT(norm(x[i] - vector_of(b, "centre") - turn.rotate(swarm.setup.grains.x[i])), 1e-6 * kDiameter);
}

TEST(RigidGroup, LosesEnergyOnlyByItsContacts) {
  Swarm swarm;
  swarm.config.grain.e = 1, swarm.config.grain.mu = 0, swarm.config.contact.rolling = "none";
  auto s = started(swarm.config, swarm.setup);
  const auto energy = [&] {
    const auto d = s->diagnostics();
    return reading(d, "grain_kinetic_energy") + reading(d, "grain_rotational_energy") +
           reading(d, "grain_elastic_energy");
  };
  const double before = energy();
  run_until(*s, 0.03);
  EXPECT_NEAR(energy() / before, 1, 5e-3);
}

TEST(RigidGroup, MovesOnlyAsItMay) {
  Swarm swarm;
  RigidConfig& rigid = swarm.config.grain.fills[1].rigid;
  rigid.move = "axis", rigid.turn = "none";
  swarm.config.gravity = {0, 0, -9.81};
  auto s = started(swarm.config, swarm.setup);
  run_until(*s, 0.02);
  const auto b = s->body_state(0);
  EXPECT_EQ(reading(b, "velocity_x"), 0);
  EXPECT_EQ(reading(b, "velocity_y"), 0);
  EXPECT_LT(reading(b, "velocity_z"), -0.05);
  EXPECT_EQ(norm(vector_of(b, "angular_velocity")), 0);
  EXPECT_GT(norm(vector_of(b, "force_by_contacts")), 0) << "it has been hit";
}

TEST(RigidGroup, FallsFreelyThroughAPeriod) {
  Swarm swarm;
  Config& c = swarm.config;
  c.domain.periodic = {true, true, true};
  c.gravity = {0, 0, -9.81};
  c.grain.fills[1].velocity = {0.5, 0, -3};
  bedload::Setup lone;
  for (std::size_t i = swarm.setup.grains.x.size() - 7; i < swarm.setup.grains.x.size(); ++i) {
    lone.grains.x.push_back(swarm.setup.grains.x[i]);
    lone.grains.v.push_back(c.grain.fills[1].velocity);
    lone.grains.radius.push_back(kDiameter / 2);
    lone.grains.fill.push_back(1);
  }
  auto s = started(c, lone);
  run_until(*s, 0.1);
  const double t = s->time();
  const auto b = s->body_state(0);
  EXPECT_LT(norm(vector_of(b, "centre") - Vec3d{0.5 * t, 0, -3 * t - 0.5 * 9.81 * t * t}), 1e-7);
  EXPECT_LT(norm(vector_of(b, "angular_velocity")), 1e4 * kInvariant);
  for (const Vec3d& x : vectors(s->snapshot("grains"), "position")) EXPECT_LE(std::abs(x.z), 0.1);
}

TEST(SmallRigidGroup, GoesOnFromACheckpointBitForBit) {
  const Swarm swarm;
  auto whole = started(swarm.config, swarm.setup);
  run_until(*whole, 0.012);
  auto parted = make_coupled(swarm.config, {});
  parted->load(whole->save());
  for (int k = 0; k < 40; ++k) whole->step(), parted->step();
  EXPECT_GT(norm(vector_of(whole->body_state(0), "force_by_contacts")) +
                norm(vector_of(whole->body_state(0), "angular_velocity")),
            0);
  EXPECT_EQ(bits(*whole), bits(*parted));
}

TEST(SmallRigidGroup, InFluidGoesOnFromACheckpointBitForBit) {
  Swarm swarm;
  Config& c = swarm.config;
  c.domain.periodic = {true, true, true};
  c.fluid.present = true;
  c.fluid.dx = 0.01;
  c.fluid.c = 30;
  c.fluid.vmax = 3;
  c.couple.hc = 2 * kDiameter;
  c.fluid.fills = {{c.domain.min, c.domain.max, {"0.3*sin(31.4159265*y)", "0.1", "0"}}};
  Config fluid_only = c;
  fluid_only.grain.present = false;
  std::vector<std::string> warnings;
  swarm.setup.fluid = build_setup(fluid_only, warnings).fluid;
  auto whole = started(c, swarm.setup);
  for (int k = 0; k < 40; ++k) whole->step();
  auto parted = make_coupled(c, {});
  parted->load(whole->save());
  for (int k = 0; k < 20; ++k) whole->step(), parted->step();
  EXPECT_GT(norm(vector_of(whole->body_state(0), "velocity")), 1e-4) << "nothing moves the group";
  EXPECT_EQ(bits(*whole), bits(*parted));
}

/// A block of fixed porosity across the whole column sinks as fast as its weight under water and the drag law
/// at its superficial slip have it: eps V (rho_s - rho) g = drag [robinson14].
TEST(SlowRigidGroup, BlockOfConstantPorositySinksAtItsTerminalVelocity) {
  const double d = 1e-4, eps = 0.8, width = 1e-3, mu = 8.9e-4, rho_s = 2500;
  Config c = periodic_box(8, width / 8);
  c.gravity = {0, 0, -9.81};
  c.domain.periodic = {true, true, false};
  c.domain.max.z = 0.01;
  c.fluid.mu = mu;
  c.fluid.c = 10 * std::sqrt(2 * 9.81 * 0.008);
  c.visc.alpha = 0.02;
  c.density.delta = 0.1;
  c.couple.hc = 2 * d;
  c.grain.present = true;
  c.grain.rho = rho_s;
  c.grain.d = c.grain.d_max = c.grain.d_min = d;
  FluidFill fill{c.domain.min, {width, width, 0.008}, {"0", "0", "0"}};
  c.fluid.fills = {fill};
  c.wall.bodies = {test::tank(c.domain.min, c.domain.max, "z-")};
  std::vector<std::string> warnings;
  auto setup = build_setup(c, warnings);
  c.grain.fills.resize(1);
  c.grain.fills[0].rigid = {true, "axis", "none", {0, 0, 1}};
  const double gap = std::cbrt(M_PI / 6 / (1 - eps)) * d;
  const int across = int(std::round(width / gap)), up = 36;
  const double step = width / across, rise = gap * gap * gap / (step * step);
  for (int k = 0; k < up; ++k)
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i) {
        setup.grains.x.push_back({(i + 0.5) * step, (j + 0.5) * step, 0.0025 + (k + 0.5) * rise});
        setup.grains.v.push_back({});
        setup.grains.radius.push_back(d / 2);
        setup.grains.fill.push_back(0);
      }
  auto s = started(c, setup);
  // the column rings as the block is let go; a mean over two of its periods, 4 H/c each
  const double period = 4 * 0.008 / c.fluid.c;
  const auto height = [&] { return reading(s->body_state(1), "centre_z"); };
  run_until(*s, 0.006);
  const double from = s->time(), top = height();
  run_until(*s, from + 2 * period);
  const double speed = (top - height()) / (s->time() - from);
  // the water that it displaces rises past it: the superficial slip is the speed of the block, 2.957 mm/s
  const double weight = eps * M_PI / 6 * d * d * d * (rho_s - 1000) * 9.81;
  double v = 1e-3;
  for (int n = 0; n < 100; ++n)
    v = eps * weight / DiFelice{}.K(Real(eps), Real(d), 1000, Real(mu), Real(v / eps));
  ASSERT_NEAR(v, 2.957e-3, 2e-6);
  EXPECT_NEAR(speed / v, 1, 0.03) << "its porous edges let it sink faster, by 5 % at half the height";
}

}  // namespace
}  // namespace BL_SOLVER
