// Where the energy of the fluid goes, by terms.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/run.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

constexpr double pi = 3.14159265358979323846;

const char* const kPowers[] = {"pressure_correction",  "acoustic_damper",   "viscosity",
                               "artificial_viscosity", "density_diffusion", "voids",
                               "wall_pressure",        "moving_walls",      "shifting",
                               "penetration_limit"};

double sum_of_powers(const std::vector<Quantity>& d) {
  double sum = 0;
  for (const char* term : kPowers) sum += reading(d, std::string("power_") + term);
  return sum;
}
double energy(const std::vector<Quantity>& d) {
  return reading(d, "fluid_kinetic_energy") + reading(d, "fluid_elastic_energy") +
         reading(d, "fluid_potential_energy");
}

/// What the terms say that the fluid has gained over some steps, and what it has, J.
struct Gain {
  double said = 0, had = 0;
};
Gain gain(Simulation& s, int steps) {
  Gain g;
  auto before = s.diagnostics();
  const double start = energy(before);
  for (int k = 0; k < steps; ++k) {
    const double t = s.time();
    s.step();
    auto now = s.diagnostics();
    g.said += 0.5 * (s.time() - t) * (sum_of_powers(before) + sum_of_powers(now));
    before = std::move(now);
  }
  g.had = energy(before) - start;
  return g;
}

class EnergyBooks : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Integrators, EnergyBooks, testing::Values("kdk", "ab3"));

TEST_P(EnergyBooks, CloseWithoutWalls) {
  Config c = periodic_box(10);
  c.time.integrator = GetParam();
  c.fluid.mu = 0.5;
  c.visc.alpha = 0.05;
  c.density.cavitation_limit = 0.5;  // out of the waves' way
  c.fluid.fills = {
      {c.domain.min, c.domain.max, {"0.4*sin(62.83*x)+0.3*cos(62.83*y)", "0.2*sin(62.83*z)", "0"}}};
  auto s = started(c);
  for (int k = 0; k < 20; ++k) s->step();
  const auto d = s->diagnostics();
  for (const char* term : {"viscosity", "artificial_viscosity", "density_diffusion", "acoustic_damper"})
    EXPECT_LT(reading(d, std::string("power_") + term), -1e-4) << term;
  const Gain g = gain(*s, 100);
  EXPECT_LT(g.had, 0);
  EXPECT_NEAR(g.said, g.had, 0.03 * std::abs(g.had));
}

/// A column that falls in a tank which is shaken.
Config shaken() {
  Config c = periodic_box(8);
  c.domain.periodic = {false, true, false};
  c.domain.min = {-0.06, 0, -0.06}, c.domain.max = {0.3, 0.08, 1};
  c.gravity = {0, 0, -9.81};
  c.fluid.fills = {{{0, 0, 0}, {0.1, 0.08, 0.16}}};
  WallBody tank = test::tank({0, 0, 0}, {0.2, 0.08, 1}, "x-x+z-");
  tank.motion.kind = "oscillation";
  tank.motion.amplitude = {0.01, 0, 0};
  tank.motion.frequency = 3;
  c.wall.bodies = {tank};
  c.time.end = 1;
  return c;
}

TEST(SlowEnergyBooks, CloseBesideWallsThatMove) {
  Config c = shaken();
  c.visc.alpha = 0.02;
  auto s = started(c);
  const Gain g = gain(*s, 2000);
  EXPECT_LT(g.had, -0.03) << "J; the column has fallen";
  EXPECT_NEAR(g.said, g.had, 0.03 * std::abs(g.had));
}

TEST(SmallEnergyBooks, TellTheWorkOfWallsThatMove) {
  Config c = shaken();
  c.visc.model = "none";
  c.wall.bodies[0].no_penetration = false;
  auto s = started(c);
  double most = 0;
  for (int k = 0; k < 50; ++k) {
    s->step();
    const double power = reading(s->diagnostics(), "power_moving_walls"),
                 by_fluid = reading(s->body_state(0), "power_by_fluid");
    EXPECT_NEAR(power, -by_fluid, 1e-4 * std::abs(by_fluid) + 1e-5);
    most = std::max(most, std::abs(power));
  }
  EXPECT_GT(most, 0.1) << "W";
}

TEST(SmallEnergyBooks, TellThePowerOfViscosity) {
  Config c = periodic_box(16);
  c.fluid.mu = 1;
  c.fluid.fills = {{c.domain.min, c.domain.max, {"0.1*sin(39.27*z)", "0", "0"}}};
  auto s = started(c);
  s->step();
  // mu k^2 U^2 V / 2, mu grad v : grad v
  EXPECT_NEAR(reading(s->diagnostics(), "power_viscosity") / (-0.5 * square(39.27 * 0.1) * cube(0.16)), 1,
              0.05);
}

}  // namespace
}  // namespace BL_SOLVER
