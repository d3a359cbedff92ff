// How many particles limits act on, as diagnostics.csv has it.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "src/time/coupled_simulation.hpp"
#include "tests/boundaries/support.hpp"
#include "tests/support/free_body.hpp"

namespace BL_SOLVER {
namespace {

/// Fluid between two plates, at rest.
Config between_plates() {
  Config c = periodic_box(12);
  c.domain.periodic = {true, true, false};
  c.domain.min.z = -0.06, c.domain.max.z = 0.18;
  c.fluid.fills = {{{0, 0, 0}, {0.12, 0.12, 0.12}}};
  c.wall.bodies = {test::tank({0, 0, 0}, {0.12, 0.12, 0.12}, "z-z+")};
  c.time.end = 1;
  return c;
}
Setup setup_of(const Config& c) {
  std::vector<std::string> warnings;
  return build_setup(c, warnings);
}
const char* const kCounts[] = {"fluid_stopped_at_walls", "fluid_repulsion_limited", "fluid_cavitating",
                               "fluid_thinnest",         "walls_thinnest",          "fluid_beside_voids",
                               "fluid_spreading",        "fluid_shift_limited",     "fluid_shift_stopped"};

TEST(LimitCounts, AreZeroInFluidThatNothingLimits) {
  Config c = between_plates();
  c.fluid.fills[0].velocity = {"0.05*cos(52.36*y)", "0", "0"};
  c.wall.bodies[0].repulsion = true;
  auto s = started(c);
  for (int k = 0; k < 4; ++k) {
    const auto d = s->diagnostics();
    for (const char* count : kCounts) EXPECT_EQ(reading(d, count), 0) << count << ", step " << k;
    s->step();
  }
}

/// Numbers of particles of a FluidBox at rest that FluidPowers has, and that a step of the density moves by
/// more than `least` 1/s.
struct Moved {
  int said_fading = 0, said_spreading = 0, down = 0, up = 0;
  Moved(FluidBox& box, double least_down, double least_up) {
    constexpr double dt = 2e-4;
    box.upload();
    const auto before = box.fluid.compression.values();
    const auto powers = box.solver->powers(box.fluid, box.walls, {}, box.moment(), dt);
    std::vector<FluidPowers> terms(powers.size);
    copy_to_host(terms.data(), powers.data, terms.size() * sizeof(FluidPowers));
    box.solver->density(box.fluid, box.walls, {}, box.moment(), dt);
    const auto after = box.fluid.compression.values();
    for (std::size_t a = 0; a < terms.size(); ++a) {
      said_fading += terms[a].fades, said_spreading += terms[a].spreads;
      const double change = (double(after[a]) - double(before[a])) / dt;
      if (-change > least_down) ++down;
      if (change > least_up) ++up;
    }
  }
};

TEST(LimitCounts, OfVoidsAreThoseWhosePressureFades) {
  for (const double s : {0.01, 0.0}) {
    Config c = periodic_box(12);
    c.density.delta = 0;
    FluidBox box(c, 0.1);
    std::erase_if(box.position, [](const Vec3d& x) { return x.z > 0.06 && x.z < 0.07; });
    const std::size_t n = box.position.size();
    box.velocity.resize(n), box.mass.resize(n), box.s.assign(n, s);
    const double pace = 3 * c.fluid.c / c.fluid.h();
    const Moved moved(box, 0.02 * pace * s, 1e9);
    EXPECT_EQ(moved.said_fading, s > 0 ? moved.down : 0) << "without pressure nothing fades";
    EXPECT_EQ(moved.said_spreading, 0);
    if (s > 0) {
      EXPECT_GT(moved.down, 100);
      EXPECT_LT(moved.down, 1000) << "of " << n;
    }
  }
}

TEST(LimitCounts, OfSpreadingAreThoseThatOverfillTheirVolume) {
  for (const double spreading : {0.01, 0.0}) {
    Config c = periodic_box(12);
    c.density.delta = c.density.void_relaxation = c.shift = 0;
    c.grain.present = true;
    c.couple.spreading = spreading;
    FluidBox box(c, 0.4);
    const Moved moved(box, 1e9, 1e-6);
    EXPECT_EQ(moved.said_spreading, spreading > 0 ? moved.up : 0);
    EXPECT_EQ(moved.said_fading, 0);
    if (spreading > 0) {
      EXPECT_GT(moved.up, 100);
      EXPECT_LT(moved.up, 1600) << "of 1728";
    }
  }
}

TEST(LimitCounts, OfShiftingAreThoseThatShouldDriftFaster) {
  for (const double shear : {1.0, 1e4}) {
    Config c = periodic_box(12);
    c.domain.periodic = {false, false, false};
    FluidBox box(c, 0.2);
    for (std::size_t a = 0; a < box.position.size(); ++a) box.velocity[a] = {shear * box.position[a].z, 0, 0};
    box.upload();
    box.solver->density(box.fluid, box.walls, {}, box.moment(), 1e-4);
    const auto powers = box.solver->powers(box.fluid, box.walls, {}, box.moment(), 1e-4);
    std::vector<FluidPowers> terms(powers.size);
    copy_to_host(terms.data(), powers.data, terms.size() * sizeof(FluidPowers));
    const auto drift = box.fluid.drift.values();
    int said = 0, drifting = 0;
    for (std::size_t a = 0; a < terms.size(); ++a)
      said += terms[a].shift_limited, drifting += norm(drift[a]) > 0;
    EXPECT_GT(drifting, 500);
    EXPECT_EQ(said, shear > 1 ? drifting : 0) << "A h2 |S| is a hundred times h2 / 2 dt, or a hundredth";
  }
}

/// Disordered fluid that is sheared between plates.
TEST(LimitCounts, OfDriftTowardsWallsAreThoseWhoseDriftEndsThere) {
  Config c = between_plates();
  c.time.integrator = TimeIntegrator::ab3;
  auto setup = setup_of(c);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-0.48, 0.48);
  for (std::size_t a = 0; a < setup.fluid.x.size(); ++a) {
    setup.fluid.x[a] += c.fluid.dx * Vec3d{u(rng), u(rng), u(rng)};
    setup.fluid.v[a] = {setup.fluid.x[a].z, 0, 0};
  }
  CoupledSimulation s(c, setup);
  s.start();
  EXPECT_EQ(reading(s.diagnostics(), "fluid_shift_stopped"), 0) << "before the first step";
  s.step();
  const auto drift = s.state().fluid.drift.values();
  const auto x = s.state().fluid.x.values();
  int level = 0;
  for (std::size_t a = 0; a < drift.size(); ++a) {
    const double z = coordinates(s.state().frame, x[a]).z, r = std::min(z, 0.12 - z);
    level += r < 0.005 && norm(drift[a]) > 0 && std::abs(drift[a].z) < 1e-4 * norm(drift[a]);
  }
  EXPECT_GT(level, 5);
  // by velocities that were corrected since, which may turn the drift of a few beside voids
  EXPECT_NEAR(reading(s.diagnostics(), "fluid_shift_stopped"), level, 3);
}

/// In a step of dt the first layer comes so near to the floor that its repulsion would throw it farther than
/// a tenth of a spacing a step.
TEST(LimitCounts, OfRepulsionAreThoseThatItWouldThrowFarther) {
  Config c = between_plates();
  c.fluid.c = 2;  // long steps
  c.wall.rep_D = 100;
  c.wall.bodies[0].repulsion = true, c.wall.bodies[0].no_penetration = false;
  c.fluid.fills[0].velocity = {"0", "0", "-1"};
  auto s = started(c);
  EXPECT_EQ(reading(*s, "fluid_repulsion_limited"), 0) << "before the first step";
  s->step();
  const double dt = s->time(), r = 0.005 - dt;
  const Repulsion law{Real(c.wall.rep_D), Real(c.wall.rep_r0), Real(1e30)};
  ASSERT_GT(r, 0);
  ASSERT_GT(law(Real(r)), 2 * 0.1 * c.fluid.dx / (dt * dt));
  const auto d = s->diagnostics();
  EXPECT_EQ(reading(d, "fluid_repulsion_limited"), 144) << "one layer of 12 x 12";
  EXPECT_EQ(reading(d, "fluid_stopped_at_walls"), 0) << "repulsion is not the penetration limit";
}

/// Fluid that is drawn from a plate: its wall particles have the lowest pressure that they may have.
TEST(LimitCounts, OfWallsAreThoseWithTheLowestPressure) {
  for (const WallType type : {WallType::adami, WallType::frozen}) {
    const bool frozen = type == WallType::frozen;
    Config c = between_plates();
    c.wall.bodies[0].type = type;
    if (frozen)
      c.fluid.fills[0].velocity = {"0", "0", "0.5"};
    else
      c.gravity = {0, 0, 6000};  // -rho g z in the floor
    CoupledSimulation s(c, setup_of(c));
    s.start();
    for (int k = 0; frozen && k < 10; ++k) s.step();
    const auto compression = s.state().walls.compression.values();
    const auto state = s.state().walls.state.values();
    const double thinnest = c.fluid.rho0 * std::pow(0.1, 1 / c.eos.gamma);
    int expected = 0, wet = 0;
    for (std::size_t b = 0; b < state.size(); ++b) {
      if (state[b].mass == 0) continue;
      ++wet;
      expected += frozen ? compression[b] > -1 && compression[b] <= Real(-c.density.cavitation_limit)
                         : state[b].rho < 1.0001 * thinnest;
    }
    EXPECT_GE(expected, 144) << "a layer of 12 x 12";
    EXPECT_LT(expected, wet);
    EXPECT_EQ(reading(s.diagnostics(), "walls_thinnest"), expected);
  }
}

/// Fluid half a spacing too near to a closed inlet is held back from it.
TEST(LimitCounts, OfInletsAreThoseThatComeTooNear) {
  const Config c = config_of(R"(gravity = [0, 0, 0]
[domain]
min = [-0.06, 0, 0]
max = [0.3, 0.08, 0.08]
periodic = [false, true, true]
[fluid]
dx = 0.01
vmax = 1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.1, 0.08, 0.08]
[[inlet]]
name = "feed"
shape = "rectangle"
centre = [0, 0.04, 0.04]
direction = [1, 0, 0]
half_a = [0, 0.04, 0]
half_b = [0, 0, 0.04]
rate = 0.0032
factor = "0"
[time]
end = 1
[out]
every = 1
)");
  for (const bool near : {false, true}) {
    auto setup = setup_of(c);
    for (Vec3d& x : setup.fluid.x) x.x -= near ? 0.008 : 0;
    auto s = started(c, setup);
    EXPECT_EQ(reading(*s, "fluid_repelled_by_inlets"), 0) << "before the first step";
    s->step();
    EXPECT_EQ(reading(*s, "fluid_repelled_by_inlets"), near ? 64 : 0) << "one layer of 8 x 8";
  }
}

/// A free ball in a bowl of twelve planes.
TEST(LimitCounts, OfContactsAreThoseBeyondEight) {
  for (const int planes : {8, 12}) {
    Config c = void_case();
    const double R = 0.05;
    WallBody ball = test::shaped("ball", make_sphere({0, 0, 0}, R));
    set_free(ball, 1000);
    c.wall.bodies = {ball};
    for (int k = 0; k < planes; ++k) {
      const double angle = 2 * M_PI * k / planes;
      WallBody plane = ground();
      plane.name += std::to_string(k);
      plane.normal = {0.5 * std::cos(angle), 0.5 * std::sin(angle), std::sqrt(0.75)};
      plane.point = -0.9999 * R * plane.normal;
      c.wall.bodies.push_back(plane);
    }
    auto s = started(c);
    EXPECT_EQ(reading(*s, "wall_contacts_dropped"), planes - 8);
  }
}

}  // namespace
}  // namespace BL_SOLVER
