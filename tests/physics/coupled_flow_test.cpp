// Fluid and grains together, through whole simulations.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/drag/registry.hpp"
#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

constexpr double pi = 3.14159265358979323846;

/// A periodic box of moving fluid with n^3 grains on a lattice that fills it to solid fraction phi.
struct Slurry {
  Config config = periodic_box(8, 0.01);
  Setup setup;

  explicit Slurry(int n, double phi) {
    const double gap = 0.08 / n;
    config.grain.present = true;
    config.grain.d = config.grain.d_max = config.grain.d_min = std::cbrt(phi * 6 / pi) * gap;
    config.couple.hc = std::max(config.fluid.h(), 2 * config.grain.d);
    config.fluid.fills = {
        {config.domain.min, config.domain.max, {"0.3*sin(78.5398*y)", "0.1", "0.2*cos(78.5398*x)"}}};
    std::vector<std::string> warnings;
    setup = build_setup(config, warnings);
    for (int k = 0; k < n * n * n; ++k) {
      setup.grains.x.push_back({(k % n + 0.5) * gap, (k / n % n + 0.5) * gap, (k / n / n + 0.5) * gap});
      setup.grains.v.push_back({0.1 * (k % 3), -0.1, 0.05 * (k % 5)});
      setup.grains.radius.push_back(config.grain.d / 2);
    }
  }
};

Vec3d momentum(const std::vector<Quantity>& d, const std::string& phase) {
  return {reading(d, phase + "_momentum_x"), reading(d, phase + "_momentum_y"),
          reading(d, phase + "_momentum_z")};
}

TEST(SmallCoupled, MomentumOfFluidAndGrainsIsKept) {
  for (const std::string integrator : {"exponential", "explicit"}) {
    Slurry slurry(6, 0.2);
    slurry.config.couple.integrator = integrator;
    auto s = started(slurry.config, slurry.setup);
    const auto before = s->diagnostics();
    const Vec3d fluid = momentum(before, "fluid");
    for (int k = 0; k < 20; ++k) s->step();
    const auto after = s->diagnostics();
    const Vec3d change =
        momentum(after, "fluid") + momentum(after, "grain") - fluid - momentum(before, "grain");
    EXPECT_GT(norm(momentum(after, "fluid") - fluid), 1e-4 * norm(fluid)) << "the phases exchange nothing";
    const double scale = reading(after, "fluid_mass") * 0.3;
    EXPECT_LT(norm(change) / scale, 20 * kInvariant) << integrator;
    EXPECT_EQ(reading(after, "fluid_mass"), reading(before, "fluid_mass"));
    EXPECT_EQ(reading(after, "grain_mass"), reading(before, "grain_mass"));
  }
}

TEST(SmallCoupled, EnergyOfGrainsFollowsTheWorkOnThem) {
  for (const std::string integrator : {"exponential", "explicit"}) {
    Slurry slurry(6, 0.2);
    slurry.config.out.energy = true;
    slurry.config.gravity = {0, 0, -9.81};
    slurry.config.couple.integrator = integrator;
    auto s = started(slurry.config, slurry.setup);
    for (int k = 0; k < 40; ++k) s->step();
    const auto d = s->diagnostics();
    const double work = std::abs(reading(d, "grain_work_fluid"));
    EXPECT_GT(work, 0.1 * reading(d, "grain_kinetic_energy"));
    EXPECT_GT(std::abs(reading(d, "grain_work_gravity")), 1e-3 * work);
    EXPECT_LT(std::abs(reading(d, "grain_energy_residual")), 1e-3 * work) << integrator;
  }
}

TEST(SmallCoupled, RestartContinuesBitForBit) {
  struct Variant {
    std::string integrator, drag;
    double xsph;
  };
  for (const auto& [integrator, drag, xsph] :
       {Variant{"kdk", "exponential", 0}, Variant{"euler", "exponential", 0}, Variant{"kdk", "explicit", 0.3},
        Variant{"euler", "explicit", 0.3}}) {
    Slurry slurry(6, 0.2);
    slurry.config.time.integrator = integrator;
    slurry.config.couple.integrator = drag;
    slurry.config.xsph = xsph;
    auto unbroken = started(slurry.config, slurry.setup);
    for (int k = 0; k < 13; ++k) unbroken->step();
    const SavedState saved = unbroken->save();
    auto restarted = make_coupled(slurry.config, slurry.setup);
    restarted->load(saved);
    for (int k = 0; k < 17; ++k) {
      unbroken->step();
      restarted->step();
    }
    EXPECT_EQ(unbroken->time(), restarted->time());
    EXPECT_EQ(bits(*unbroken), bits(*restarted)) << integrator << ", drag " << drag << ", xsph " << xsph;
  }
}

void expect_momentum_and_restart_of_unlike_sizes(bool own_lengths) {
  Slurry slurry(6, 0.4);
  slurry.config.grain.d_min = slurry.config.grain.d / 4;
  if (own_lengths) slurry.config.couple.hc = slurry.config.fluid.h();
  for (std::size_t i = 0; i < slurry.setup.grains.radius.size(); ++i)
    if (i % 5 != 0) slurry.setup.grains.radius[i] /= 4;
  auto unbroken = started(slurry.config, slurry.setup);
  const auto before = unbroken->diagnostics();
  for (int k = 0; k < 13; ++k) unbroken->step();
  const SavedState saved = unbroken->save();
  auto restarted = make_coupled(slurry.config, slurry.setup);
  restarted->load(saved);
  for (int k = 0; k < 17; ++k) {
    unbroken->step();
    restarted->step();
  }
  EXPECT_EQ(bits(*unbroken), bits(*restarted));
  const auto after = unbroken->diagnostics();
  const Vec3d exchanged = momentum(after, "fluid") - momentum(before, "fluid");
  const double scale = reading(after, "fluid_mass") * 0.3;
  EXPECT_GT(norm(exchanged), 1e-4 * scale);
  EXPECT_LT(norm(exchanged + momentum(after, "grain") - momentum(before, "grain")) / scale, 20 * kInvariant);
}

TEST(SmallCoupled, GrainsOfUnlikeSizesKeepMomentumAndContinueBitForBit) {
  for (const bool own_lengths : {false, true}) expect_momentum_and_restart_of_unlike_sizes(own_lengths);
}

TEST(SmallCoupled, SameCaseTwiceIsBitEqual) {  // T-46
  Slurry slurry(6, 0.2);
  auto a = started(slurry.config, slurry.setup), b = started(slurry.config, slurry.setup);
  for (int k = 0; k < 20; ++k) a->step(), b->step();
  EXPECT_EQ(a->time(), b->time());
  EXPECT_EQ(bits(*a), bits(*b));
}

/// Each phase renews its lists in its own time; what crosses the phases must not miss a pair.
TEST(CoupledFlow, SkinsOfThePhasesDoNotMatter) {
  const auto run = [](double fluid_skin, double grain_skin, int& rebuilds) {
    Slurry slurry(6, 0.2);
    slurry.config.skin_fluid = fluid_skin;
    slurry.config.skin_grain = grain_skin;
    slurry.config.time.dt = 5e-5;
    auto s = started(slurry.config, slurry.setup);
    for (int k = 0; k < 40; ++k) rebuilds += s->step().rebuilt;
    return std::pair(vectors(s->snapshot("fluid"), "velocity"), vectors(s->snapshot("grains"), "velocity"));
  };
  int both = 0, fluid_only = 0, grains_only = 0;
  const auto expected = run(0.02, 0.03, both);
  const auto a = run(0.02, 1, fluid_only), b = run(1, 0.03, grains_only);
  EXPECT_GT(fluid_only, 2);
  EXPECT_GT(grains_only, 2);
  EXPECT_GT(both, std::max(fluid_only, grains_only));
  const double bound = tolerance(1e-11, 2e-5, 2e-5);
  for (const auto& other : {a, b}) {
    for (std::size_t i = 0; i < expected.first.size(); ++i)
      ASSERT_LT(norm(other.first[i] - expected.first[i]), bound) << "fluid " << i;
    for (std::size_t i = 0; i < expected.second.size(); ++i)
      ASSERT_LT(norm(other.second[i] - expected.second[i]), bound) << "grain " << i;
  }
}

/// Pressure and buoyancy are adjoint to continuity: without viscosity and drag, what fluid and grains lose of
/// kinetic energy is stored in the fluid, also where the porosity is held at its floor.
/// What smooths or mends the density may take of it, not give.
void expect_energy_kept(bool smoothed) {
  for (const double floor : {0.25, 0.57}) {
    Slurry slurry(6, 0.45);
    Config& c = slurry.config;
    c.visc.model = "none";
    c.fluid.mu = 1e-12;
    c.couple.drag = "stokes";
    if (!smoothed)
      c.density.delta = c.density.void_relaxation = c.couple.spreading = c.pressure.damper = c.shift = 0;
    c.couple.eps_min = floor;
    c.grain.e = 1;
    c.grain.mu = c.grain.mu_r = 0;
    auto s = started(c, slurry.setup);
    const auto energy = [&](bool stored) {
      const auto d = s->diagnostics();
      double sum = reading(d, "fluid_kinetic_energy") + reading(d, "grain_kinetic_energy") +
                   reading(d, "grain_rotational_energy");
      if (stored) sum += reading(d, "fluid_elastic_energy") + reading(d, "grain_elastic_energy");
      return sum;
    };
    const double before = energy(true), moving = energy(false);
    EXPECT_EQ(reading(s->diagnostics(), "porosity_floor_hits") > 0, floor > 0.5);
    double least = moving, most = before;
    for (int k = 0; k < 400; ++k) {
      s->step();
      if (k % 20 == 0) least = std::min(least, energy(false)), most = std::max(most, energy(true));
    }
    EXPECT_LT(most, before * (1 + 1e-3)) << floor;
    if (smoothed) {
      EXPECT_LT(energy(true), 0.999 * before) << floor;
    } else {
      EXPECT_GT(energy(true), before * (1 - 1e-3)) << floor;
    }
    EXPECT_LT(least, 0.98 * moving) << "nothing is compressed";
  }
}

TEST(SlowCoupledFlow, KeepsItsEnergy) { expect_energy_kept(false); }  // T-8, at the step of the default
TEST(SlowCoupledFlow, WithItsDefaultsNeverGainsEnergy) { expect_energy_kept(true); }

/// A shear wave of water, or of a suspension whose grains go along: how fast it decays over nu k2.
double decay_of_a_shear_wave(double Re, double phi) {
  const int n = 12;
  const double L = 0.08, k = 2 * pi / L, speed = 0.1;
  Slurry slurry(n, phi > 0 ? phi : 0.1);
  Config c = periodic_box(n, L / n);
  c.fluid.c = 10 * speed;
  c.fluid.vmax = speed;
  c.fluid.mu = 1000 * speed * L / Re;
  c.fluid.fills = {{c.domain.min, c.domain.max, {"0.1*sin(78.53981634*z)", "0", "0"}}};
  std::vector<std::string> warnings;
  bedload::Setup setup = build_setup(c, warnings);
  if (phi > 0) {
    c.grain = slurry.config.grain;
    c.grain.rho = 1000;
    c.couple.hc = std::max(c.fluid.h(), 2 * c.grain.d);
    setup.grains = slurry.setup.grains;
    for (std::size_t j = 0; j < setup.grains.x.size(); ++j)
      setup.grains.v[j] = {speed * std::sin(k * setup.grains.x[j].z), 0, 0};
  }
  auto s = started(c, setup);
  const auto amplitude = [&] {
    const HostStore fluid = s->snapshot("fluid");
    const auto x = vectors(fluid, "position"), v = vectors(fluid, "velocity");
    double sum = 0;
    for (std::size_t a = 0; a < x.size(); ++a) sum += 2.0 / x.size() * v[a].x * std::sin(k * x[a].z);
    return sum;
  };
  const double rate = c.fluid.mu / 1000 * k * k;
  run_until(*s, std::min(0.2 / rate, 0.1 * L / speed));  // the grains take up the motion of the fluid
  const double before = amplitude(), from = s->time();
  run_until(*s, from + std::min(0.3 / rate, L / speed));
  return std::log(before / amplitude()) / (s->time() - from) / rate;
}

TEST(SlowCoupledFlow, AShearWaveInASuspensionDecaysByTheViscosityOfItsFluid) {
  for (const double Re : {10.0, 100.0, 500.0}) {
    const double water = decay_of_a_shear_wave(Re, 0), suspension = decay_of_a_shear_wave(Re, 0.3);
    EXPECT_NEAR(suspension / water, 1, 0.05) << Re;
  }
}

TEST(CoupledFlow, TellsItsNumericalViscosity) {
  Slurry slurry(6, 0.3);
  Config& c = slurry.config;
  c.fluid.mu = 1e-3;
  c.visc.alpha = 0.02;
  c.couple.drag = "stokes";
  for (const char* slip : {"mean", "local"}) {
    c.couple.slip = slip;
    const auto told = make_coupled(c, slurry.setup)->numerical_viscosity();
    EXPECT_NEAR(reading(told, "artificial_bulk"), 0.02 * c.fluid.h() * c.fluid.c / 20 / 1e-6, 1e-6);
    EXPECT_EQ(reading(told, "artificial_bed"), reading(told, "artificial_bulk"));
    EXPECT_EQ(told.size(), 3u) << "density diffusion thickens nothing";
    // beta s^2 / 6 with beta = 18 phi mu / d2 and s^2 = 0.8 h_c2 of Wendland's kernel
    const double d = c.grain.d, expected = 18 * 0.6 / (d * d) * 0.8 * c.couple.hc * c.couple.hc / 6;
    EXPECT_NEAR(reading(told, "local_slip_bed"), slip == std::string("local") ? expected : 0,
                1e-3 * expected);
  }
}

TEST(CoupledFlow, LaidFluidTakesTheSpaceBetweenGrains) {
  Slurry slurry(6, 0.3);
  auto s = started(slurry.config, slurry.setup);
  const double expected = 1000 * std::pow(0.08, 3) * 0.7;
  EXPECT_NEAR(reading(s->diagnostics(), "fluid_mass"), expected, 1e-2 * expected);
  EXPECT_NEAR(reading(s->diagnostics(), "porosity_min"), 0.7, 0.02);
}

TEST(SlowCoupledFlow, SeepagePressureDropFollowsTheDragLaw) {  // T-39
  Slurry slurry(6, 0.4);
  Config& c = slurry.config;
  c.grain.fixed = true;
  c.fluid.mu = 1e-3;
  c.drive.f = {2000, 0, 0};  // N/m3, the pressure gradient
  for (auto& v : slurry.setup.fluid.v) v = {};
  for (auto& v : slurry.setup.grains.v) v = {};
  auto s = started(c, slurry.setup);
  run_until(*s, 1.0);
  const auto v = vectors(s->snapshot("fluid"), "velocity");
  Vec3d mean;
  for (const auto& u : v) mean += u * (1.0 / double(v.size()));
  double per_volume = 0;  // drag at that speed, N/m3
  with_drag_law(c.couple.drag, [&](auto law) {
    const double n = slurry.setup.grains.x.size() / std::pow(0.08, 3);
    per_volume = n * law.K(Real(0.6), Real(c.grain.d), Real(1000), Real(1e-3), Real(mean.x)) * mean.x;
  });
  EXPECT_NEAR(per_volume, 2000, 3e-2 * 2000);
}

/// Turbulent drag goes with the square of the slip: a jet through a quarter of a bed is stopped as a flow of
/// its own speed is, dv/dt = - 1.75 (1 - eps) / eps v2 / d by Ergun, not as one of a quarter of that.
TEST(CoupledFlow, AJetInABedIsStoppedByItsOwnSpeed) {
  Slurry slurry(6, 0.4);
  Config& c = slurry.config;
  c.grain.fixed = true;
  c.fluid.mu = 1e-6;
  c.couple.drag = "ergun";
  c.couple.slip = "local";
  auto& setup = slurry.setup;
  for (std::size_t a = 0; a < setup.fluid.v.size(); ++a) {
    const Vec3d& x = setup.fluid.x[a];
    const bool jet = std::abs(x.x - 0.04) < 0.02 && std::abs(x.y - 0.04) < 0.02;
    setup.fluid.v[a] = {0, 0, jet ? 1.0 : 0.0};
  }
  for (auto& v : setup.grains.v) v = {};
  auto s = started(c, setup);
  const double before = momentum(s->diagnostics(), "fluid").z;
  run_until(*s, 0.01);
  const double after = momentum(s->diagnostics(), "fluid").z;
  const double expected = 1 / (1 + 1.75 * (0.4 / 0.6) / c.grain.d * s->time());
  EXPECT_NEAR(after / before, expected, 0.03 * expected);
}

/// Water over and in a bed of resting grains on a floor of that type, after `settled` s: for 0.12 s it is no
/// faster than that (m/s), and lifts the grains by so much of their buoyancy.
void expect_still_bed(const char* floor, double lifted = 1.0076, double fastest_allowed = 4e-4,
                      double settled = 0) {
  Config c = periodic_box(8, 3e-3);
  c.gravity = {0, 0, -9.81};
  c.domain.periodic = {true, true, false};
  c.domain.min.z = -0.012;
  c.domain.max.z = 0.06;
  c.fluid.mu = 8.9e-4;
  c.fluid.vmax = std::sqrt(2 * 9.81 * 0.048);
  c.fluid.c = 10 * c.fluid.vmax;
  c.density.delta = 0.1;
  c.density.void_relaxation = DensityConfig{}.void_relaxation;
  c.wall.rep_D = 5 * 9.81 * 0.048;
  c.wall.rep_r0 = 1.5e-3;
  c.grain.present = c.grain.fixed = true;
  c.grain.d = c.grain.d_max = c.grain.d_min = 2.7e-3;
  c.couple.hc = 2 * c.grain.d;
  FluidFill fill{{0, 0, 0}, {0.024, 0.024, 0.048}, {"0", "0", "0"}};
  c.fluid.fills = {fill};
  c.wall.bodies = {test::tank({0, 0, 0}, {0.024, 0.024, 0.06}, "z-")};
  c.wall.bodies[0].type = floor;
  c.wall.layer_r0 = c.fluid.dx;
  if (c.wall.bodies[0].single_layer()) {
    c.visc.alpha = 0.02;  // its soft push lets the column bob
    c.wall.bodies[0].dx = c.fluid.dx / 2;
    c.fluid.fills[0].min.z += c.fluid.dx / 2;
    c.fluid.fills[0].max.z += c.fluid.dx / 2;
  }
  std::vector<std::string> warnings;
  auto setup = build_setup(c, warnings);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shake(-1e-4, 1e-4);
  const double gap = 0.024 / 9;  // 0.54 solid
  for (int k = 0; k < 9 * 9 * 7; ++k) {
    setup.grains.x.push_back({(k % 9 + 0.5) * gap + shake(random), (k / 9 % 9 + 0.5) * gap + shake(random),
                              (k / 81 + 0.52) * gap + shake(random)});
    setup.grains.v.push_back({});
    setup.grains.radius.push_back(1.35e-3);
  }
  auto s = started(c, setup);
  double fastest = 0, lift = 0;
  run_until(*s, settled);
  for (int k = 1; k <= 10; ++k) {
    run_until(*s, settled + 0.012 * k);
    const auto d = s->diagnostics();
    fastest = std::max(fastest, reading(d, "fluid_speed_max"));
    if (k > 5) lift += reading(d, "force_fluid_on_grains_z") / 5;
  }
  EXPECT_LT(fastest, fastest_allowed);
  const double buoyancy = 9.81 * 1000 * 567 * pi / 6 * 2.7e-3 * 2.7e-3 * 2.7e-3;
  EXPECT_NEAR(lift / buoyancy, lifted, 3e-3);
}

TEST(SlowCoupledFlow, WaterInABedAtRestStaysAtRest) { expect_still_bed("adami"); }
TEST(SlowCoupledFlow, WaterInABedAtRestStaysAtRestOnAnMdbcFloor) { expect_still_bed("mdbc"); }
// what these walls give the fluid beside them is not that of a wall among grains: those of the lowest layer,
// a seventh of all, have half of their lift and less
TEST(SlowCoupledFlow, WaterInABedAtRestStaysAtRestOnAFrozenFloor) {
  expect_still_bed("frozen", 0.868, 1.5e-3);
}
// its soft push lets the column bob, at 0.14 m/s at first
TEST(SlowCoupledFlow, WaterInABedAtRestComesToRestOnASingleLayer) {
  expect_still_bed("single_layer", 0.921, 0.02, 0.6);
}

/// Water over and in a bed of grains of 3 mm and, in its pores, of such of 0.15 mm: each class is lifted by
/// its buoyancy.
TEST(SlowCoupledFlow, WaterInABedOfTwoSizesStaysAtRest) {
  Config c = periodic_box(16, 1.5e-3);
  c.gravity = {0, 0, -9.81};
  c.domain.periodic = {true, true, false};
  c.domain.min.z = -0.009;
  c.domain.max.z = 0.04;
  c.fluid.mu = 8.9e-4;
  c.fluid.vmax = std::sqrt(2 * 9.81 * 0.024);
  c.fluid.c = 10 * c.fluid.vmax;
  c.density.delta = 0.1;
  c.density.void_relaxation = DensityConfig{}.void_relaxation;
  c.grain.present = c.grain.fixed = true;
  c.grain.d = c.grain.d_min = 0.15e-3;
  c.grain.d_max = 3e-3;
  c.couple.hc = c.fluid.h();
  c.fluid.fills = {{{0, 0, 0}, {0.024, 0.024, 0.024}, {"0", "0", "0"}}};
  c.wall.bodies = {test::tank({0, 0, 0}, {0.024, 0.024, 0.04}, "z-")};
  std::vector<std::string> warnings;
  auto setup = build_setup(c, warnings);
  const auto add = [&](const Vec3d& x, double d) {
    setup.grains.x.push_back(x), setup.grains.v.push_back({}), setup.grains.radius.push_back(d / 2);
  };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  for (int k = 0; k < 8 * 8 * 4; ++k)  // touch: 0.52 solid
    add(Vec3d(k % 8 + 0.5, k / 8 % 8 + 0.5, k / 64 + 0.5) * c.grain.d_max, c.grain.d_max);
  while (setup.grains.x.size() < 256 + 3000) {
    const Vec3d x{0.024 * u(random), 0.024 * u(random), 0.012 * u(random)};
    Vec3d off;  // from the centre of the large grain of that cell
    for (int k = 0; k < 3; ++k) off[k] = x[k] - (std::floor(x[k] / 3e-3) + 0.5) * 3e-3;
    if (norm(off) > 0.5 * (c.grain.d_max + c.grain.d_min)) add(x, c.grain.d_min);
  }
  auto s = started(c, setup);
  double fastest = 0, lift[2] = {}, buoyancy[2] = {};
  for (int k = 1; k <= 5; ++k) {
    run_until(*s, 0.005 * k);
    fastest = std::max(fastest, reading(s->diagnostics(), "fluid_speed_max"));
    if (k < 3) continue;
    const auto force = vectors(s->snapshot("grains"), "fluid_force");
    for (std::size_t j = 0; j < force.size(); ++j) {
      const double R = setup.grains.radius[j];
      lift[R < 1e-3] += force[j].z;
      buoyancy[R < 1e-3] += 9.81 * 1000 * 4 * pi / 3 * R * R * R;
    }
  }
  EXPECT_LT(fastest, 3e-3);
  for (const int small : {0, 1}) EXPECT_NEAR(lift[small] / buoyancy[small], 1, 0.01) << small;
}

/// One grain released in still water over a floor, drag on the grain alone.
TEST(SlowCoupledFlow, OneWayTerminalVelocity) {  // T-37
  Config c = periodic_box(8, 5e-4);
  c.gravity = {0, 0, -9.81};
  c.domain.periodic = {true, true, false};
  c.domain.max.z = 0.008;
  c.fluid.mu = 8.9e-4;
  c.fluid.c = 10 * std::sqrt(2 * 9.81 * 0.006);
  c.visc.alpha = 0.02;
  c.density.delta = 0.1;
  c.couple.mode = "one_way";
  c.couple.hc = c.fluid.h();
  c.grain.present = true;
  c.grain.d = c.grain.d_max = c.grain.d_min = 1e-4;
  FluidFill fill{c.domain.min, {0.004, 0.004, 0.006}, {"0", "0", "0"}};
  c.fluid.fills = {fill};
  c.wall.bodies = {test::tank(c.domain.min, c.domain.max, "z-")};
  for (const auto& [law, expected] : {std::pair{"stokes", 9.185e-3}, std::pair{"schiller_naumann", 8.057e-3},
                                      std::pair{"di_felice", 7.609e-3}}) {
    c.couple.drag = law;
    std::vector<std::string> warnings;
    auto setup = build_setup(c, warnings);
    setup.grains.x = {{0.002, 0.002, 0.0045}};
    setup.grains.v = {{0, 0, 0}};
    setup.grains.radius = {0.5e-4};
    auto s = started(c, setup);
    run_until(*s, 0.04);
    EXPECT_NEAR(-vectors(s->snapshot("grains"), "velocity")[0].z, expected, 1e-2 * expected) << law;
  }
}

}  // namespace
}  // namespace BL_SOLVER
