// Force probes: means over an interval against what fluid, grains and bodies gain in it, and instants.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/free_body.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kG = 9.81;

ProbeConfig force_on(const std::string& body, const std::string& sample = "mean", const Vec3d& about = {}) {
  ProbeConfig p;
  p.name = body + "_" + sample, p.type = "force";
  p.body = body, p.sample = sample, p.about = about;
  return p;
}

/// Water that falls on the floor of an open tank, which moves on along x.
Config falling_water() {
  Config c = periodic_box(10, 0.01);
  c.gravity = {0, 0, -kG};
  c.domain.periodic = {true, true, false};
  c.fluid.fills = {{{0, 0, 0.005}, {0.1, 0.1, 0.055}}};
  c.wall.bodies = {test::tank(c.domain.min, c.domain.max, "z-")};
  c.wall.bodies[0].motion.kind = "velocity";
  c.wall.bodies[0].motion.velocity = {0.3, 0, 0};
  c.pressure.linear_exact = false;
  c.out.probes = {force_on("tank"), force_on("tank", "instant")};
  return c;
}

/// Grains that fall on a floor, among them one box that moves freely.
struct Hail {
  Hail() : config(void_case()) {
    config.gravity = {0, 0, -kG};
    config.grain.present = true;
    config.grain.d = config.grain.d_min = config.grain.d_max = 0.02;
    config.grain.E = 1e6;
    WallBody box = test::shaped("box", make_box({-0.05, -0.03, 0.005}, {0.05, 0.03, 0.045}));
    set_free(box, 600);
    config.wall.bodies = {ground(), box};
    for (int k = 0; k < 12; ++k) {
      setup.grains.x.push_back({-0.06 + 0.031 * (k % 4), -0.03 + 0.027 * (k / 4), 0.07 + 0.012 * k});
      setup.grains.v.push_back({0.3 - 0.04 * k, 0.1, -1});
      setup.grains.radius.push_back(0.01);
    }
    config.out.probes = {force_on("plane"), force_on("box")};
  }
  Config config;
  bedload::Setup setup;
};

/// Sums of means times their interval, as a reader of the table would take them.
class Sum {
 public:
  Sum(Simulation& s, const ProbeConfig& probe) : s_(s), probe_(probe), since_(s.time()) {
    s_.begin_interval(probe_);
  }
  void take() {
    const double interval = s_.time() - since_;
    rows_ = s_.measure(probe_);
    s_.begin_interval(probe_);
    since_ = s_.time();
    const auto add = [&](Vec3d& to, const char* name) { to += interval * vector_of(rows_, name); };
    add(force, "force_total"), add(torque, "torque_total");
    work += interval * reading(rows_, "power_total");
  }
  Vec3d force, torque;  ///< N s, N m s
  double work = 0;      ///< J

 private:
  Simulation& s_;
  ProbeConfig probe_;
  double since_;
  std::vector<Quantity> rows_;
};

TEST(SmallForceMeans, AreTheMomentumThatTheFluidLoses) {
  for (const TimeIntegrator scheme : {TimeIntegrator::kdk, TimeIntegrator::euler}) {
    Config c = falling_water();
    c.time.integrator = scheme;
    auto s = started(c);
    const auto before = s->diagnostics();
    const double start = s->time();
    Sum floor(*s, c.out.probes[0]);
    for (int k = 1; k <= 120; ++k) {
      s->step();
      if (k % 7 == 0 || k == 120) floor.take();
    }
    const auto after = s->diagnostics();
    const double falls = reading(before, "fluid_mass") * kG * (s->time() - start);
    const Vec3d gained = vector_of(after, "fluid_momentum") - vector_of(before, "fluid_momentum");
    ASSERT_GT(std::abs(floor.force.z), 0.2 * falls) << "it has not hit the floor";
    EXPECT_LT(norm(gained + floor.force - Vec3d{0, 0, -falls}), tolerance(1e-12, 2e-5, 2e-5) * falls);
    // the floor moves evenly: the work is that of the impulse
    EXPECT_NEAR(floor.work, 0.3 * floor.force.x, 1e-12 * falls);
    EXPECT_NE(floor.work, 0);
  }
}

/// Floor and box take what moved grains and box. Velocities of grains are rounded at each substep, those of
/// bodies are not.
TEST(SmallForceMeans, AreTheMomentumOfGrainsAndOfABody) {
  const Hail hail;
  auto s = started(hail.config, hail.setup);
  const auto before = s->diagnostics();
  const Vec3d box_before = vector_of(before, "body_momentum");
  Sum floor(*s, hail.config.out.probes[0]), box(*s, hail.config.out.probes[1]);
  bool grains = false, bodies = false;
  for (int k = 1; s->time() < 0.2; ++k) {
    s->step();
    if (k % 5 != 0) continue;
    const auto now = s->measure(hail.config.out.probes[1]);
    grains = grains || norm(vector_of(now, "force_by_grains")) > 0;
    bodies = bodies || norm(vector_of(now, "force_by_bodies")) > 0;
    floor.take(), box.take();
  }
  floor.take(), box.take();
  ASSERT_TRUE(grains && bodies) << "the box met no grain, or did not reach the floor";
  const auto after = s->diagnostics();
  const double mass = reading(after, "body_mass"), grain_mass = reading(after, "grain_mass");
  const Vec3d weight{0, 0, -kG * s->time()};
  EXPECT_LT(norm(vector_of(after, "body_momentum") - box_before - box.force - mass * weight),
            1e-10 * mass * norm(weight));
  const Vec3d all = vector_of(after, "body_momentum") + vector_of(after, "grain_momentum") - box_before -
                    vector_of(before, "grain_momentum");
  EXPECT_LT(norm(all + floor.force - (mass + grain_mass) * weight),
            tolerance(1e-10, 5e-6, 5e-6) * (mass + grain_mass) * norm(weight));
  // work on the box is what its energy gains beside that of its weight
  const auto energy = [](const std::vector<Quantity>& d) {
    return reading(d, "body_kinetic_energy") + reading(d, "body_rotational_energy") +
           reading(d, "body_potential_energy");
  };
  EXPECT_NEAR(box.work, energy(after) - energy(before), 0.02 * std::abs(energy(after) - energy(before)));
}

/// Of a box that floats, on which grains fall: fluid, grains, tank and weight move it.
TEST(SmallForceMeans, AreTheMomentumOfABodyInWater) {
  Config c = falling_water();
  c.wall.bodies[0] = test::tank(c.domain.min, c.domain.max, "z-");
  WallBody box = test::shaped("box", make_box({0.025, 0.025, 0.06}, {0.075, 0.075, 0.08}));
  set_free(box, 400);
  c.wall.bodies.push_back(box);
  c.couple.mode = CouplingMode::off;
  c.grain.present = true;
  c.grain.d = c.grain.d_min = c.grain.d_max = 0.01;
  c.grain.E = 1e6;
  c.out.probes = {force_on("box")};
  std::vector<std::string> warnings;
  bedload::Setup setup = build_setup(c, warnings);
  for (int k = 0; k < 4; ++k) {
    setup.grains.x.push_back({0.037 + 0.012 * (k % 2), 0.035 + 0.013 * (k / 2), 0.0865 + 0.002 * k});
    setup.grains.v.push_back({0.2, 0.1 * k, -0.5});
    setup.grains.radius.push_back(0.005);
  }
  auto s = started(c, setup);
  const Vec3d before = vector_of(s->diagnostics(), "body_momentum");
  const double start = s->time();
  Sum of_box(*s, c.out.probes[0]);
  bool water = false, grains = false;
  for (int k = 1; k <= 150; ++k) {
    s->step();
    if (k % 10 != 0) continue;
    const auto now = s->measure(c.out.probes[0]);
    water = water || norm(vector_of(now, "force_by_fluid")) > 0;
    grains = grains || norm(vector_of(now, "force_by_grains")) > 0;
    of_box.take();
  }
  ASSERT_TRUE(water && grains) << "the box met no water, or no grain";
  const auto after = s->diagnostics();
  const Vec3d weight{0, 0, -kG * reading(after, "body_mass") * (s->time() - start)};
  EXPECT_LT(norm(vector_of(after, "body_momentum") - before - of_box.force - weight), 1e-10 * norm(weight));
}

/// Of a paddle in water, about its axle and about another point.
TEST(SmallForceMeans, HaveTorqueAboutAPointAndItsPower) {
  Config c = falling_water();
  c.fluid.fills = {{{0, 0, 0.005}, {0.1, 0.1, 0.075}}};
  c.wall.bodies.push_back(test::body("box", {0.03, 0.03, 0.03}, {0.05, 0.06, 0.04}));
  MotionConfig& motion = c.wall.bodies[1].motion;
  motion.kind = "rotation";
  motion.axis = {0, 1, 0}, motion.centre = {0.06, 0.045, 0.04}, motion.rate = 12;
  const Vec3d aside{0.02, 0, -0.01};
  c.out.probes = {force_on("box", "mean", motion.centre), force_on("box", "mean", motion.centre + aside)};
  c.out.probes[1].name = "aside";
  auto s = started(c);
  for (int k = 0; k < 40; ++k) s->step();
  const auto p = s->measure(c.out.probes[0]), q = s->measure(c.out.probes[1]);
  const double power = reading(p, "power_total");
  ASSERT_NE(power, 0);
  EXPECT_NEAR(power, 12 * reading(p, "torque_total_y"), 1e-9 * std::abs(power));
  EXPECT_NEAR(reading(q, "power_total"), power, 1e-9 * std::abs(power));
  const Vec3d force = vector_of(p, "force_total"), torque = vector_of(p, "torque_total");
  EXPECT_LT(norm(vector_of(q, "torque_total") - torque + cross(aside, force)), 1e-9 * norm(torque));
}

TEST(SmallForceMeans, GoOnInTheMiddleOfAnInterval) {
  const Hail hail;
  auto whole = started(hail.config, hail.setup);
  run_until(*whole, 0.03);
  for (const ProbeConfig& p : hail.config.out.probes) whole->begin_interval(p);
  run_until(*whole, 0.06);
  auto second = make_coupled(hail.config, bedload::Setup{});
  second->load(whole->save());
  for (int k = 0; k < 30; ++k) whole->step(), second->step();
  EXPECT_EQ(bits(*whole), bits(*second));
  for (const ProbeConfig& p : hail.config.out.probes) {
    const auto a = whole->measure(p), b = second->measure(p);
    ASSERT_NE(reading(a, "force_total_z"), 0);
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].value, b[k].value) << a[k].name;
  }
}

/// Where a probe is new in a restart, its interval begins there.
TEST(SmallForceMeans, BeginWithTheirProbe) {
  const Config c = falling_water();
  Config without = c;
  without.out.probes.clear();
  auto whole = started(without);
  for (int k = 0; k < 60; ++k) whole->step();
  auto second = make_coupled(c, bedload::Setup{});
  second->load(whole->save());
  const auto mean = second->measure(c.out.probes[0]), now = second->measure(c.out.probes[1]);
  ASSERT_NE(reading(now, "force_total_z"), 0);
  for (std::size_t k = 0; k < now.size(); ++k) EXPECT_EQ(mean[k].value, now[k].value) << now[k].name;
  const Vec3d before = vector_of(second->diagnostics(), "fluid_momentum");
  const double start = second->time(), falls = reading(second->diagnostics(), "fluid_mass") * kG;
  for (int k = 0; k < 30; ++k) second->step();
  const double interval = second->time() - start;
  const Vec3d impulse = interval * vector_of(second->measure(c.out.probes[0]), "force_total");
  EXPECT_LT(norm(vector_of(second->diagnostics(), "fluid_momentum") - before + impulse -
                 Vec3d{0, 0, -falls * interval}),
            tolerance(1e-12, 2e-5, 2e-5) * falls * interval);
}

TEST(SmallForceProbe, InstantsAreWhatActsThen) {
  const Config c = falling_water();
  auto s = started(c);
  for (int k = 0; k < 60; ++k) s->step();
  const auto now = s->measure(c.out.probes[1]), body = s->body_state(0);
  ASSERT_NE(reading(now, "force_by_fluid_z"), 0);
  for (const char* name : {"force_by_fluid_x", "force_by_fluid_z"})
    EXPECT_EQ(reading(now, name), reading(body, name)) << name;
  EXPECT_NEAR(reading(now, "power_by_fluid"), reading(body, "power_by_fluid"),
              1e-12 * std::abs(reading(now, "force_by_fluid_z")));
  EXPECT_EQ(reading(now, "force_total_z"), reading(now, "force_by_fluid_z"));
  // a mean over many steps is another number, and one over the last alone lies beside it
  const double mean = reading(s->measure(c.out.probes[0]), "force_total_z");
  EXPECT_GT(std::abs(mean - reading(now, "force_total_z")), 1e-3 * std::abs(mean));
  s->begin_interval(c.out.probes[0]);
  s->step();
  const double next = reading(s->measure(c.out.probes[1]), "force_total_z");
  EXPECT_NEAR(reading(s->measure(c.out.probes[0]), "force_total_z"),
              0.5 * (reading(now, "force_total_z") + next), 1e-6 * std::abs(next))
      << "half of a step by the force at either end";
}

// -- forces exact for a linear pressure ------------------------------------------------

constexpr double kRho = 1000;  // kg/m3

/// Oil, as viscous as pressure.linear_exact asks for, over the floor of a periodic tank.
Config deep_oil(int side = 16) {
  Config c = periodic_box(side);
  c.domain.min.z = -0.04, c.domain.max.z = 0.01 * side + 0.02;
  c.domain.periodic[2] = false;
  c.time.end = 1;
  c.gravity = {0, 0, -kG};
  c.fluid.mu = 10;
  c.fluid.fills = {{{0, 0, 0}, {0.01 * side, 0.01 * side, 0.01 * side}}};
  c.wall.bodies = {test::tank({0, 0, 0}, {0.01 * side, 0.01 * side, 0.01 * side + 0.01}, "z-")};
  return c;
}

/// Its particles moved by up to 0.15 spacings off their lattice.
bedload::Setup disordered(const Config& c) {
  std::vector<std::string> warnings;
  bedload::Setup setup = build_setup(c, warnings);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> by(-0.15 * c.fluid.dx, 0.15 * c.fluid.dx);
  for (Vec3d& x : setup.fluid.x) x += Vec3d{by(rng), by(rng), by(rng)};
  return setup;
}

/// Load of the fluid on the last body after a step: force, torque about `about`.
std::pair<Vec3d, Vec3d> load_on_last(Config c, bool linear_exact, const Vec3d& about = {}) {
  c.pressure.linear_exact = linear_exact;
  auto s = started(c, disordered(c));
  s->step();
  const auto now = s->measure(force_on(c.wall.bodies.back().name, "instant", about));
  return {vector_of(now, "force_by_fluid"), vector_of(now, "torque_by_fluid")};
}

/// The walls' pressure is disordered, too, which leaves a part.
TEST(ForceProbeInOil, HasTheBuoyancyOfAHeldBall) {
  Config c = deep_oil();
  const Vec3d middle{0.08, 0.08, 0.07}, aside{0.02, -0.01, 0.005};
  WallBody ball = test::shaped("ball", make_sphere(middle, 0.04));
  ball.motion.centre = middle;
  c.wall.bodies.push_back(ball);
  const Vec3d buoyancy{0, 0, kRho * kG * 4 / 3 * std::numbers::pi * cube(0.04)};
  const auto error = [&](bool linear_exact) {
    const auto [force, torque] = load_on_last(c, linear_exact, middle - aside);
    return std::pair{norm(force - buoyancy) / norm(buoyancy),
                     norm(torque - cross(aside, buoyancy)) / norm(cross(aside, buoyancy))};
  };
  const auto [force, torque] = error(true);
  EXPECT_LT(force, 0.03);
  EXPECT_LT(torque, 0.05);
  const auto [force_by_pairs, torque_by_pairs] = error(false);
  EXPECT_GT(force_by_pairs, 2 * force);
  EXPECT_GT(torque_by_pairs, 2 * torque);
}

/// The mean is over what instants are, and tables of bodies have the same.
TEST(ForceProbeInOil, MeansAndTablesHaveTheSame) {
  Config c = deep_oil();
  c.wall.bodies.push_back(test::shaped("ball", make_sphere({0.08, 0.08, 0.07}, 0.04)));
  c.out.probes = {force_on("ball"), force_on("ball", "instant")};
  auto s = started(c, disordered(c));
  Vec3d impulse;
  double start = 0;
  for (int k = 0; k < 10; ++k) {
    const Vec3d before = vector_of(s->measure(c.out.probes[1]), "force_by_fluid");
    s->step();
    const auto now = s->measure(c.out.probes[1]);
    impulse += 0.5 * (s->time() - start) * (before + vector_of(now, "force_by_fluid"));
    start = s->time();
    EXPECT_LT(norm(vector_of(now, "force_by_fluid") - vector_of(s->body_state(1), "force_by_fluid")),
              1e-12 * norm(vector_of(now, "force_by_fluid")));
  }
  const Vec3d mean = vector_of(s->measure(c.out.probes[0]), "force_by_fluid");
  EXPECT_LT(norm(start * mean - impulse), 1e-6 * norm(impulse));
}

/// Fluid loses the impulse that bodies report, but for what the diagnostics have of the correction.
TEST(ForceProbeInOil, ImpulsesAreTheMomentumThatTheFluidLoses) {
  Config c = deep_oil();
  WallBody ball = test::shaped("ball", make_sphere({0.08, 0.08, 0.07}, 0.03));
  ball.motion.kind = "velocity";
  ball.motion.velocity = {0.3, 0, 0.1};
  c.wall.bodies.push_back(ball);
  for (WallBody& body : c.wall.bodies) body.no_penetration = false;  // its push is booked elsewhere
  c.out.probes = {force_on("tank"), force_on("ball")};
  auto s = started(c, disordered(c));
  const auto before = s->diagnostics();
  Vec3d corrected;
  for (int k = 0; k < 20; ++k) corrected += corrected_in_a_step(*s);
  const auto after = s->diagnostics();
  const Vec3d gained = vector_of(after, "fluid_momentum") - vector_of(before, "fluid_momentum"),
              falls = Vec3d{0, 0, -kG * reading(after, "fluid_mass") * s->time()};
  Vec3d impulse;
  for (const ProbeConfig& p : c.out.probes) impulse += s->time() * vector_of(s->measure(p), "force_by_fluid");
  EXPECT_LT(norm(gained + impulse - falls - corrected), 1e-4 * norm(falls) + 0.02 * norm(corrected));
  Vec3d on_bodies;
  double power = 0;
  for (int b = 0; b < 2; ++b) {
    const auto body = s->body_state(b);
    on_bodies += vector_of(body, "force_by_fluid");
    power += dot(vector_of(s->measure(force_on(c.wall.bodies[b].name, "instant")), "pressure_force"),
                 vector_of(body, "velocity"));
  }
  EXPECT_LT(norm(on_bodies + vector_of(after, "force_walls_on_fluid")), 1e-9 * norm(on_bodies));
  EXPECT_NEAR(reading(after, "power_moving_walls"), -power, 1e-6 * std::abs(power));
}

/// Mean drag on a ball moved through oil under `background` Pa, N; drag is a stress of some 5 Pa.
double drag(double background) {
  Config c = periodic_box(12);
  c.time.end = 1;
  c.fluid.mu = 1;
  c.fluid.vmax = 0.8;
  c.eos.background = background;
  c.fluid.fills = {{c.domain.min, c.domain.max}};
  WallBody ball = test::shaped("ball", make_sphere({0.06, 0.06, 0.06}, 0.03));
  ball.motion.kind = "velocity";
  ball.motion.velocity = {0.1, 0, 0};
  c.wall.bodies = {ball};
  c.out.probes = {force_on("ball")};
  auto s = started(c);
  run_until(*s, 0.05);
  s->begin_interval(c.out.probes[0]);
  run_until(*s, 0.15);
  return reading(s->measure(c.out.probes[0]), "force_by_fluid_x");
}

TEST(SlowForceProbeInOil, HasTheDragOfAMovingBallUnderAnyPressure) {
  const double without = drag(0);
  EXPECT_LT(without, -0.02);
  for (const double background : {30.0, 3000.0})
    EXPECT_NEAR(drag(background), without, 0.05 * std::abs(without));
}

/// A floor, wet only above, carries the oil and has no buoyancy; a vessel full of it likewise.
TEST(ForceProbeInOil, LeavesBodiesOutThatAreNotSurrounded) {
  Config c = deep_oil(10);
  c.domain.min.z = -0.05;
  const double weight = kRho * kG * cube(0.1);
  c.wall.bodies = {test::body("box", {0, 0, -0.04}, {0.1, 0.1, 0})};
  EXPECT_NEAR(load_on_last(c, true).first.z, -weight, 0.15 * weight);

  Config full = deep_oil(16);
  full.domain.periodic = {false, false, false};
  full.domain.min = {-0.02, -0.02, -0.02};
  full.fluid.fills = {{{0.04, 0.04, 0.03}, {0.12, 0.12, 0.13}}};
  full.wall.bodies = {
      test::shaped("vessel", make_hollow(make_box({0.04, 0.04, 0.03}, {0.12, 0.12, 0.13}), 0.03))};
  const double within = kRho * kG * 0.08 * 0.08 * 0.1;
  EXPECT_NEAR(load_on_last(full, true).first.z, -within, 0.15 * within);
}

}  // namespace
}  // namespace BL_SOLVER
