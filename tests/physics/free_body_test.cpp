// Bodies that move freely: alone, against walls and each other, among grains.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/free_body.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// A lone box without gravity that touches nothing.
Config spinning(const Vec3d& side, const Vec3d& spin, double dt) {
  Config c = void_case();
  c.gravity = {};
  c.time.dt = dt;
  c.time.force_dt = true;
  c.time.dt_dem = dt;
  WallBody box = test::shaped("box", make_box(side * -0.5, side * 0.5));
  set_free(box, 500).free.spin = spin;
  box.free.contacts = false;
  c.wall.bodies = {box};
  return c;
}

TEST(FreeBodySpin, KeepsAngularMomentumAndEnergyThroughFlips) {
  // about the axis of middle inertia, where a small wobble grows until the box turns over
  const Vec3d spin{0.02, 5, 0.03};
  auto s = started(spinning({0.3, 0.2, 0.1}, spin, 1e-3));
  const auto before = s->diagnostics();
  const Vec3d L = vector_of(before, "body_angular_momentum");
  const double energy = reading(before, "body_rotational_energy");
  double lowest = 1, off = 0;
  for (int k = 0; k < 10000; ++k) {
    s->step();
    if (k % 20 != 0) continue;
    const auto d = s->diagnostics();
    EXPECT_LT(norm(vector_of(d, "body_angular_momentum") - L), 1e-14 * norm(L));
    off = std::max(off, std::abs(reading(d, "body_rotational_energy") / energy - 1));
    lowest = std::min(lowest, rotation_of(s->body_state(0)).rotate({0, 1, 0}).y);
  }
  EXPECT_LT(lowest, -0.9) << "the test means the box to flip";
  EXPECT_LT(off, 1e-5);
  // second order: half the step, a quarter of the error
  auto fine = started(spinning({0.3, 0.2, 0.1}, spin, 5e-4));
  double off_fine = 0;
  for (int k = 0; k < 20000; ++k) {
    fine->step();
    if (k % 40 == 0)
      off_fine =
          std::max(off_fine, std::abs(reading(fine->diagnostics(), "body_rotational_energy") / energy - 1));
  }
  EXPECT_NEAR(off / off_fine, 4, 0.4);
}

TEST(FreeBodySpin, ASymmetricTopPrecesses) {
  // the axis of symmetry goes round the angular momentum at the rate L / I_across
  const Vec3d side{0.1, 0.1, 0.3}, spin{2, 0, 6};
  Config c = spinning(side, spin, 5e-4);
  auto s = started(c);
  const auto& inertia = c.wall.bodies[0].free.solid.inertia;
  const Vec3d L{inertia[0] * spin.x, 0, inertia[2] * spin.z};
  const double rate = norm(L) / inertia[0];
  for (int k = 0; k < 4000; ++k) s->step();
  const Vec3d expected = Quat<double>::from_rotation(L * (rate * s->time() / norm(L))).rotate({0, 0, 1});
  EXPECT_LT(norm(rotation_of(s->body_state(0)).rotate({0, 0, 1}) - expected), 1e-4)
      << "after " << rate * s->time() / (2 * M_PI) << " rounds";
}

TEST(FreeBodySpin, RotationVectorIsTheShortWay) {
  const Vec3d axis = Vec3d{1, -2, 2} / 3;
  for (const double angle : {1e-9, 0.5, 2.0, 3.1, 3.2, 6.0}) {
    const Quat<double> q = Quat<double>::from_rotation(angle * axis), same{-q.w, -q.x, -q.y, -q.z};
    const Vec3d way = (angle < M_PI ? angle : angle - 2 * M_PI) * axis;
    EXPECT_LT(norm(rotation_vector(q) - way), 1e-14 * (1 + angle)) << angle;
    EXPECT_LT(norm(rotation_vector(same) - way), 1e-14 * (1 + angle)) << angle << " as its negative";
  }
}

TEST(FreeBodyConstraints, PendulumSwingsAtItsPeriod) {
  Config c = void_case();
  WallBody rod = test::shaped("rod", make_box({0, -0.01, -0.01}, {0.4, 0.01, 0.01}));
  set_free(rod, 1000);
  rod.free.move = "none", rod.free.turn = "axis";
  rod.free.axis = {0, 1, 0};
  rod.free.point = {0, 0, 0};
  rod.free.contacts = false;
  c.wall.bodies = {rod};
  c.gravity = {9.81 * std::cos(0.05), 0, -9.81 * std::sin(0.05)};  // 0.05 rad from hanging
  c.time.dt = c.time.dt_dem = 1e-3;
  c.time.force_dt = true;
  auto s = started(c);
  const double m = rod.free.solid.mass, inertia = m * (0.4 * 0.4 / 3 + 0.02 * 0.02 / 12);
  const double period = 2 * M_PI * std::sqrt(inertia / (m * 9.81 * 0.2)) * (1 + 0.05 * 0.05 / 16);
  // turning points: angular velocity falls through zero once a period
  std::vector<double> at;
  double before = 0;
  while (at.size() < 5) {
    const double now = (s->step(), reading(s->body_state(0), "angular_velocity_y"));
    if (before > 0 && now <= 0) at.push_back(s->time() - 1e-3 * now / (now - before));
    before = now;
    EXPECT_EQ(norm(vector_of(s->body_state(0), "centre")), 0);
    ASSERT_LT(s->time(), 10);
  }
  EXPECT_NEAR((at[4] - at[0]) / 4 / period, 1, 1e-5);
}

/// Of a rod that swings about one end: its centre of mass moves, and the rest of its energy is in its
/// turning.
TEST(FreeBodyConstraints, APendulumKeepsItsEnergyInItsParts) {
  Config c = void_case();
  WallBody rod = test::shaped("rod", make_box({0, -0.01, -0.01}, {0.4, 0.01, 0.01}));
  set_free(rod, 1000);
  rod.free.move = "none", rod.free.turn = "axis";
  rod.free.axis = {0, 1, 0};
  rod.free.point = {0, 0, 0};
  rod.free.contacts = false;
  c.wall.bodies = {rod};
  c.gravity = {0, 0, -9.81};
  c.time.dt = c.time.dt_dem = 1e-4;
  c.time.force_dt = true;
  auto s = started(c);
  const double m = rod.free.solid.mass, about_centre = m * (0.4 * 0.4 + 0.02 * 0.02) / 12;
  double fastest = 0;
  for (int k = 0; k < 4000; ++k) {
    s->step();
    if (k % 400 != 399) continue;
    const double spin = reading(s->body_state(0), "angular_velocity_y"), swing = m * square(0.2 * spin);
    const auto d = s->diagnostics();
    EXPECT_NEAR(reading(d, "body_kinetic_energy"), 0.5 * swing, 1e-9);
    EXPECT_NEAR(reading(d, "body_rotational_energy"), 0.5 * about_centre * spin * spin, 1e-9);
    EXPECT_NEAR(reading(d, "body_kinetic_energy") + reading(d, "body_rotational_energy") +
                    reading(d, "body_potential_energy"),
                0, 1e-5);
    const double fall = std::sin(2 * std::acos(reading(s->body_state(0), "rotation_w")));  // of the rod
    EXPECT_NEAR(reading(d, "body_potential_energy"), -m * 9.81 * 0.2 * fall, 1e-9);
    EXPECT_NEAR(std::abs(reading(d, "body_angular_momentum_y")), std::abs((about_centre + m * 0.04) * spin),
                1e-9);
    EXPECT_NEAR(norm(vector_of(d, "body_momentum")), m * 0.2 * std::abs(spin), 1e-9);
    fastest = std::max(fastest, std::abs(spin));
  }
  EXPECT_GT(fastest, 6) << "rad/s";
}

TEST(FreeBodyConstraints, LetThroughOnlyWhatTheyAllow) {
  struct Case {
    const char *move, *turn;
    Vec3d v, omega;  // after one second of gravity (1, 2, 3) m/s2, beginning with spin (1, 0, 2) rad/s
  };
  const Vec3d pull{1, 2, 3};
  for (const Case& k : {Case{"all", "none", pull, {}},
                        {"plane", "axis", {1, 2, 0}, {0, 0, 2}},
                        {"axis", "axis", {0, 0, 3}, {0, 0, 2}},
                        {"axis", "none", {0, 0, 3}, {}},
                        {"none", "axis", {}, {0, 0, 2}}}) {
    Config c = spinning({0.1, 0.1, 0.1}, {1, 0, 2}, 1e-3);
    c.gravity = pull;
    c.wall.bodies[0].free.move = k.move, c.wall.bodies[0].free.turn = k.turn;
    auto s = started(c);
    for (int n = 0; n < 1000; ++n) s->step();
    const auto b = s->body_state(0);
    EXPECT_LT(norm(vector_of(b, "velocity") - k.v), 1e-9) << k.move << " " << k.turn;
    EXPECT_LT(norm(vector_of(b, "angular_velocity") - k.omega), 1e-9) << k.move << " " << k.turn;
  }
}

TEST(FreeBodyConstraints, HoldItUntilItsRelease) {
  Config c = spinning({0.1, 0.1, 0.1}, {0, 0, 3}, 1e-3);
  c.gravity = {0, 0, -9.81};
  c.wall.bodies[0].free.release_time = 0.05;
  auto s = started(c);
  for (int k = 0; k < 49; ++k) s->step();
  EXPECT_EQ(reading(s->body_state(0), "centre_z"), 0);
  EXPECT_EQ(reading(s->body_state(0), "angular_velocity_z"), 0);
  EXPECT_EQ(reading(s->diagnostics(), "body_rotational_energy"), 0);
  s->step();
  for (int k = 0; k < 50; ++k) s->step();
  EXPECT_NEAR(reading(s->body_state(0), "velocity_z"), -9.81 * 0.05, 2 * 9.81e-3);
  EXPECT_NEAR(reading(s->body_state(0), "angular_velocity_z"), 3, 1e-12);
}

TEST(FreeBodyInAFrame, FliesAsSeenFromTheLab) {
  Config c = spinning({0.1, 0.1, 0.1}, {1, 2, 3}, 1e-3);
  c.gravity = {0, 0, -9.81};
  c.wall.bodies[0].free.velocity = {0.3, 0, 0.5};
  c.frame.motion.kind = "formula";
  c.frame.motion.displacement = {"0.02*(sin(20*t)-20*t)", "0.5*t^2", "0"};  // at rest at first
  auto s = started(c);
  for (int k = 0; k < 200; ++k) s->step();
  const double t = s->time();
  const Vec3d frame{0.02 * (std::sin(20 * t) - 20 * t), 0.5 * t * t, 0};
  const Vec3d lab{0.3 * t, 0, 0.5 * t - 0.5 * 9.81 * t * t};
  // kicks by the trapezium rule: (20 tau)^2 / 12 of 0.4 m/s, over the flight
  EXPECT_LT(norm(vector_of(s->body_state(0), "centre") - (lab - frame)), 4e-4 / 12 * 0.4 * t);
}

// -- contacts with walls ------------------------------------------------------

TEST(FreeBodyContacts, BounceWithTheirRestitution) {
  for (const double e : {1.0, 0.7, 0.3}) {
    Config c = void_case();
    c.gravity = {};
    c.time.contact = 0.01;
    WallBody ball = test::shaped("ball", make_sphere({0, 0, 0.0501}, 0.05));
    set_free(ball, 2000).free.e = e;
    ball.free.velocity = {0, 0, -0.5};
    WallBody cube = test::shaped("cube", make_box({0.2, -0.05, 0.0001}, {0.3, 0.05, 0.1001}));
    set_free(cube, 2000).free.e = e;
    cube.free.E = 1e10;  // softer feet would give way by more than their size
    cube.free.velocity = {0, 0, -0.5};
    // four feet: the least that lands flat, each with a quarter of the mass before it
    for (const double x : {0.201, 0.299})
      for (const double y : {-0.049, 0.049}) cube.free.balls.push_back({{x, y, 0.0011}, 0.001});
    c.grain.E = 1e10;
    c.wall.bodies = {ground(), ball, cube};
    auto s = started(c);
    run_until(*s, 5e-3);
    EXPECT_NEAR(reading(s->body_state(1), "velocity_z"), 0.5 * e, 2e-3 * 0.5);
    EXPECT_NEAR(reading(s->body_state(2), "velocity_z"), 0.5 * e, 2e-2 * 0.5) << "the cube";
    EXPECT_LT(norm(vector_of(s->body_state(2), "angular_velocity")), 1e-5);
  }
}

TEST(FreeBodyContacts, BounceOnASeamAsBesideIt) {
  for (const double beside : {0.0, 0.002}) {
    Config c = void_case();
    c.gravity = {};
    c.time.contact = 0.01;
    WallBody ball = test::shaped("ball", make_sphere({beside, 0, 0.0501}, 0.05));
    set_free(ball, 2000).free.e = 0.5;
    ball.free.velocity = {0, 0, -0.5};
    c.wall.bodies = {ball};
    for (const double x : {-0.1, 0.0})
      for (const double y : {-0.1, 0.0})
        c.wall.bodies.push_back(test::body("box", {x, y, -0.05}, {x + 0.1, y + 0.1, 0}));
    auto s = started(c);
    run_until(*s, 5e-3);
    EXPECT_LT(norm(vector_of(s->body_state(0), "velocity") - Vec3d{0, 0, 0.25}), 2e-3) << beside;
  }
}

TEST(FreeBodyContacts, TwoSpheresMakeOneContact) {
  for (const double e : {1.0, 0.5})
    for (const double radius : {0.05, 0.02}) {
      Config c = void_case();
      c.gravity = {};
      c.time.contact = 0.01;
      WallBody a = test::shaped("a", make_sphere({0, 0, 0}, 0.05));
      WallBody b = test::shaped("b", make_sphere({0.0501 + radius, 0, 0}, radius));
      set_free(a, 2000).free.velocity = {0.5, 0, 0};
      set_free(b, 2000);
      a.free.e = b.free.e = e;
      c.wall.bodies = {a, b};
      auto s = started(c);
      run_until(*s, 5e-3);
      const double va = reading(s->body_state(0), "velocity_x"), vb = reading(s->body_state(1), "velocity_x");
      EXPECT_NEAR((vb - va) / 0.5, e, 5e-3) << "radius " << radius;
      EXPECT_NEAR(a.free.solid.mass * (0.5 - va), b.free.solid.mass * vb, 1e-12 * a.free.solid.mass);
    }
}

TEST(FreeBodyContacts, SlidingBlockStopsByFriction) {
  Config c = void_case();
  WallBody block = test::shaped("block", make_box({-0.05, -0.05, 0}, {0.05, 0.05, 0.04}));
  set_free(block, 1000);
  block.free.mu = 0.3, block.free.e = 0.3;
  block.free.velocity = {0.5, 0, 0};
  c.wall.bodies = {ground(), block};
  auto s = started(c);
  run_until(*s, 0.1);
  const double g = 9.81, mu = 0.3;
  EXPECT_NEAR(reading(s->body_state(1), "velocity_x"), 0.5 - mu * g * s->time(), 0.01);
  run_until(*s, 0.4);
  const auto end = s->body_state(1);
  EXPECT_NEAR(reading(end, "centre_x"), 0.25 / (2 * mu * g), 0.02 * 0.25 / (2 * mu * g));
  EXPECT_LT(norm(vector_of(end, "velocity")), 1e-4);
  EXPECT_NEAR(reading(end, "force_by_bodies_z"), 0.4 * g, 1e-3 * 0.4 * g);
  EXPECT_NEAR(reading(s->body_state(0), "force_by_bodies_z"), -0.4 * g, 1e-3 * 0.4 * g) << "on the ground";
}

TEST(FreeBodyContacts, RollingBallStopsByRollingFriction) {
  for (const char* law : {"epsd", "cdt"}) {
    Config c = void_case();
    c.contact.rolling = law;
    WallBody ball = test::shaped("ball", make_sphere({0, 0, 0.05}, 0.05));
    set_free(ball, 1000);
    ball.free.mu = 0.5, ball.free.mu_r = 0.05, ball.free.e = 0.3;
    ball.free.velocity = {0.1, 0, 0}, ball.free.spin = {0, 0.1 / 0.05, 0};
    c.wall.bodies = {ground(), ball};
    auto s = started(c);
    run_until(*s, 0.15);
    const double a = 5.0 / 7.0 * 0.05 * 9.81;
    EXPECT_NEAR((0.1 - reading(s->body_state(1), "velocity_x")) / (a * s->time()), 1, 0.02) << law;
    run_until(*s, 0.5);
    EXPECT_LT(std::abs(reading(s->body_state(1), "velocity_x")), 2e-3) << law << ", epsd rocks for a while";
    EXPECT_NEAR(reading(s->body_state(1), "centre_x") / (0.01 / (2 * a)), 1, 0.03) << law;
  }
}

TEST(FreeBodyContacts, PassThroughABodyThatTouchesNobody) {
  Config c = void_case();
  c.gravity = {};
  WallBody ghost = test::shaped("ghost", make_box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}));
  set_free(ghost, 1000).free.contacts = false;
  WallBody ball = test::shaped("ball", make_sphere({0.2, 0, 0}, 0.04));
  set_free(ball, 1000).free.velocity = {-1, 0, 0};
  c.wall.bodies = {ghost, ball};
  auto s = started(c);
  run_until(*s, 0.2);
  EXPECT_LT(reading(s->body_state(1), "centre_x"), 0.01);
  EXPECT_EQ(vector_of(s->body_state(1), "velocity"), Vec3d(-1, 0, 0));
  EXPECT_EQ(norm(vector_of(s->body_state(0), "velocity")), 0);
}

TEST(FreeBodyContacts, TwoBodiesKeepMomentumAndAngularMomentum) {
  Config c = void_case();
  c.gravity = {};
  WallBody a = test::shaped("a", make_box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}));
  WallBody b = test::shaped("b", make_cylinder({0.08, 0.02, -0.05}, {0.08, 0.02, 0.06}, 0.025));
  set_free(a, 1500).free.velocity = {0.8, 0.1, 0};
  a.free.spin = {1, 3, -2}, a.free.mu_r = 0.1;
  set_free(b, 4000).free.velocity = {-0.6, 0, 0.1};
  b.free.E = 3e7, b.free.spin = {0, -2, 5};
  c.wall.bodies = {a, b};
  auto s = started(c);
  const auto before = s->diagnostics();
  double touched = 0;
  while (s->time() < 0.06) {
    s->step();
    touched = std::max(touched, norm(vector_of(s->body_state(0), "force_by_bodies")));
  }
  const auto after = s->diagnostics();
  ASSERT_GT(touched, 1) << "the test means them to meet";
  const double p = a.free.solid.mass * 0.8, l = p * 0.1;
  EXPECT_LT(norm(vector_of(after, "body_momentum") - vector_of(before, "body_momentum")), 1e-12 * p);
  EXPECT_LT(norm(vector_of(after, "body_angular_momentum") - vector_of(before, "body_angular_momentum")),
            1e-11 * l);
  const auto energy = [](const auto& d) {
    return reading(d, "body_kinetic_energy") + reading(d, "body_rotational_energy");
  };
  EXPECT_LT(energy(after), energy(before));
  EXPECT_GT(energy(after), 0.3 * energy(before));
}

// -- among grains -------------------------------------------------------------

/// A box amid grains that fly about, without gravity; `elastic`: without friction or loss.
struct Cloud {
  Config config;
  bedload::Setup setup;
  explicit Cloud(bool elastic) {
    Config& c = config = void_case();
    c.domain.min = {-0.1, -0.1, -0.1}, c.domain.max = {0.1, 0.1, 0.1};
    c.gravity = {};
    c.grain.present = true;
    c.grain.d = c.grain.d_min = c.grain.d_max = 6e-3;
    c.grain.E = 1e6;
    if (elastic) c.grain.e = 1, c.grain.mu = 0, c.contact.rolling = "none";
    WallBody box = test::shaped("box", make_box({-0.015, -0.01, -0.0125}, {0.015, 0.01, 0.0125}));
    set_free(box, 1200).free.spin = {3, -5, 8};
    c.wall.bodies = {box};
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> u(-1, 1);
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j)
        for (int k = -3; k <= 3; ++k) {
          const Vec3d x{0.009 * i + 1e-3 * u(rng), 0.009 * j + 1e-3 * u(rng), 0.009 * k + 1e-3 * u(rng)};
          if (box.solid.shape->distance(x) < 3.1e-3) continue;
          setup.grains.x.push_back(x);
          setup.grains.v.push_back(x * -12.0 + Vec3d{0.1 * u(rng), 0.1 * u(rng), 0.1 * u(rng)});
          setup.grains.radius.push_back(3e-3);
        }
  }
};

Vec3d sum_of(const std::vector<Quantity>& d, const std::string& what) {
  return vector_of(d, "grain_" + what) + vector_of(d, "body_" + what);
}
double energy_of(const std::vector<Quantity>& d) {
  return reading(d, "grain_kinetic_energy") + reading(d, "grain_rotational_energy") +
         reading(d, "grain_elastic_energy") + reading(d, "body_kinetic_energy") +
         reading(d, "body_rotational_energy");
}

TEST(FreeBodyAmongGrains, ClosedSystemKeepsMomentaAndGainsNoEnergy) {
  for (const bool elastic : {false, true}) {
    const Cloud cloud(elastic);
    auto s = started(cloud.config, cloud.setup);
    const auto before = s->diagnostics();
    const double m = reading(before, "grain_mass"), v = std::sqrt(2 * energy_of(before) / m);
    double energy = energy_of(before), touched = 0, gain = 0;
    while (s->time() < 0.03) {
      s->step();
      const auto d = s->diagnostics();
      gain = std::max(gain, energy_of(d) - energy);
      energy = energy_of(d);
      touched = std::max(touched, norm(vector_of(s->body_state(0), "force_by_grains")));
    }
    const auto after = s->diagnostics();
    ASSERT_GT(touched, 0.05) << "the test means grains to hit the box";
    EXPECT_LT(norm(sum_of(after, "momentum") - sum_of(before, "momentum")), 2 * kInvariant * m * v);
    EXPECT_LT(norm(sum_of(after, "angular_momentum") - sum_of(before, "angular_momentum")),
              2 * kInvariant * m * v * 0.05);
    if (elastic) {
      EXPECT_NEAR(energy / energy_of(before), 1, 2e-3)
          << "while contacts last the box holds no spring energy twice";
    } else {
      EXPECT_LT(gain, 1e-3 * energy_of(before));
      EXPECT_LT(energy, 0.9 * energy_of(before));
    }
  }
}

/// A grain meets a ball of its own size and matter, both free: the mass that swings between them is half of
/// it.
TEST(FreeBodyAmongGrains, ReboundsWithTheirRestitution) {
  for (const double e : {1.0, 0.5}) {
    Config c = void_case();
    c.gravity = {};
    c.grain.present = true;
    c.grain.d = c.grain.d_min = c.grain.d_max = 0.02;
    c.grain.e = e;
    WallBody ball = test::shaped("ball", make_sphere({0, 0, 0}, 0.01));
    set_free(ball, c.grain.rho).free.e = e;
    c.wall.bodies = {ball};
    bedload::Setup setup;
    setup.grains.x = {{0.0201, 0, 0}};
    setup.grains.v = {{-0.5, 0, 0}};
    setup.grains.radius = {0.01};
    auto s = started(c, setup);
    run_until(*s, 2e-3);
    const double v = vectors(s->snapshot("grains"), "velocity")[0].x,
                 of_ball = reading(s->body_state(0), "velocity_x");
    EXPECT_NEAR((v - of_ball) / 0.5, e, 5e-3);
    EXPECT_NEAR(v + of_ball, -0.5, 1e-6) << "of equal masses";
  }
}

TEST(FreeBodyAmongGrains, RestsOnGrainsThatAreHeld) {
  Config c = void_case();
  c.grain.present = c.grain.fixed = true;
  c.grain.d = c.grain.d_min = c.grain.d_max = 0.02;
  c.grain.e = 0.3;
  WallBody slab = test::shaped("slab", make_box({-0.05, -0.05, 0.0101}, {0.05, 0.05, 0.0301}));
  set_free(slab, 1000);
  c.wall.bodies = {slab};
  bedload::Setup setup;
  for (const double x : {-0.04, 0.04})
    for (const double y : {-0.04, 0.04}) {
      setup.grains.x.push_back({x, y, 0});
      setup.grains.v.push_back({});
      setup.grains.radius.push_back(0.01);
    }
  auto s = started(c, setup);
  const auto held = vectors(s->snapshot("grains"), "position");
  run_until(*s, 0.3);
  const auto b = s->body_state(0);
  const double weight = 0.2 * 9.81;
  EXPECT_NEAR(reading(b, "force_by_grains_z") / weight, 1, 1e-3);
  EXPECT_NEAR(reading(b, "centre_z"), 0.02, 1e-4);
  EXPECT_EQ(vectors(s->snapshot("grains"), "position"), held);
}

TEST(FreeBodyRestart, GoesOnBitForBit) {
  Cloud cloud(false);
  cloud.config.wall.bodies.push_back(test::tank({-0.035, -0.035, -0.02}, {0.035, 0.035, 0.035}));
  cloud.config.gravity = {0, 0, -9.81};
  bedload::Setup inside;
  for (std::size_t i = 0; i < cloud.setup.grains.x.size(); ++i)
    if (const Vec3d& x = cloud.setup.grains.x[i];
        std::max(std::abs(x.x), std::abs(x.y)) < 0.032 && x.z > -0.017 && x.z < 0.032) {
      inside.grains.x.push_back(x);
      inside.grains.v.push_back(cloud.setup.grains.v[i]);
      inside.grains.radius.push_back(3e-3);
    }
  auto whole = started(cloud.config, inside);
  run_until(*whole, 0.06);
  ASSERT_GT(norm(vector_of(whole->body_state(0), "force_by_bodies")) +
                norm(vector_of(whole->body_state(0), "force_by_grains")),
            0);
  auto second = make_coupled(cloud.config, inside);
  second->load(whole->save());
  for (int k = 0; k < 50; ++k) whole->step(), second->step();
  EXPECT_EQ(whole->time(), second->time());
  EXPECT_EQ(bits(*whole), bits(*second));
}

}  // namespace
}  // namespace BL_SOLVER
