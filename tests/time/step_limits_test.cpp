// Limits of steps and substeps are reported by name.

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "bedload/case/read.hpp"
#include "src/time/clock.hpp"
#include "tests/support/cases.hpp"
#include "tests/support/free_body.hpp"

namespace BL_SOLVER {
namespace {

using Overrides = std::vector<std::string>;

/// Of the second step: by then the drag on grains is known.
StepInfo step_of(const std::string& text, const Overrides& overrides) {
  std::vector<std::string> warnings;
  const auto s = started(read_case_text(text, "case.toml", overrides, warnings));
  s->step();
  return s->step();
}

/// Two grains in a tank of water.
StepInfo wet(const Overrides& overrides) {
  return step_of(test::kTank + R"([fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0]
max = [0.1, 0.1, 0.09]
[grain]
d = 0.01
[[grain.fill]]
positions = [[0.05, 0.05, 0.0048], [0.058, 0.05, 0.011]]
velocity = [0.1, 0, -0.1]
)",
                 overrides);
}

/// Two grains far apart, of which one moves (m/s).
StepInfo dry(const std::function<void(Config&)>& set, double speed = 0.01) {
  Config c = void_case();
  c.gravity = {0, 0, -9.81};
  c.grain.present = true;
  c.grain.d = c.grain.d_min = c.grain.d_max = 2.7e-3;
  set(c);
  bedload::Setup setup;
  setup.grains.x = {{0, 0, 0}, {0.1, 0, 0}};
  setup.grains.v = {{0, 0, speed}, {}};
  setup.grains.radius = {1.35e-3, 1.35e-3};
  return started(c, setup)->step();
}

/// Fluid on nodes between two plates.
StepInfo nodes(const Overrides& overrides) {
  return step_of(R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
periodic = [true, true, false]
[fluid]
model = "lattice"
dx = 0.01
mu = 0.05
vmax = 0.1
[[wall.body]]
name = "floor"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
[[wall.body]]
name = "lid"
shape = "plane"
point = [0, 0, 0.1]
normal = [0, 0, -1]
[time]
end = 1
[out]
every = 1
)",
                 overrides);
}

/// A free ball.
StepInfo ball(const Overrides& overrides) {
  return step_of(R"([domain]
min = [-1, -1, -1]
max = [1, 1, 1]
[[shape]]
name = "ball"
kind = "sphere"
centre = [0, 0, 0]
radius = 0.1
[[wall.body]]
name = "ball"
shape = "ball"
[wall.body.free]
density = 1000
[time]
end = 1
[out]
every = 1
)",
                 overrides);
}

/// A step after one of 1 s, where sound allows 10 s.
StepInfo grown() {
  Clock clock{TimeConfig()};
  clock.last_dt = 1;
  StepInfo info;
  EXPECT_DOUBLE_EQ(clock.next_dt({{Limit::cfl, 10}}, info.limit), 1.05);
  return info;
}

/// docs/laws.md: H is half the support of the kernel, h of Wendland's.
TEST(StepLimits, AreThoseOfTheDocuments) {
  Config c = periodic_box(8);
  c.fluid.fills = {{c.domain.min, c.domain.max, {"3", "0", "-4"}}};
  const auto first = [](const Config& of, Limit limit) {
    const StepInfo info = started(of)->step();
    EXPECT_EQ(name_of(info.limit), name_of(limit));
    return info.dt;
  };
  const double H = c.fluid.h();
  EXPECT_NEAR(first(c, Limit::cfl) / (0.25 * H / (20 + 5)), 1, 1e-5);
  Config oil = c;
  oil.fluid.mu = 500;
  EXPECT_NEAR(first(oil, Limit::viscous) / (0.125 * H * H * 1000 / 500), 1, 1e-5);
  Config driven = c;
  driven.drive.mode = "mass";
  driven.drive.f = {0, 3e6, 4e6};
  EXPECT_NEAR(first(driven, Limit::body) / (0.25 * std::sqrt(H / 5e6)), 1, 1e-5);
  Config pushed = c;
  pushed.time.end = 1;
  pushed.wall.bodies = {test::body("box", {0.03, 0.03, 0.03}, {0.05, 0.05, 0.05})};
  pushed.wall.bodies[0].motion.kind = "velocity";
  pushed.wall.bodies[0].motion.velocity = {0, 500, 0};
  pushed.fluid.fills[0].max.z = 0.02;
  EXPECT_NEAR(first(pushed, Limit::travel) / (0.1 * 0.01 / 500), 1, 1e-5);
  EXPECT_NEAR(dry([](Config&) {}, 1000).dt / (0.05 * 2.7e-3 / 1000), 1, 1e-5);
}

TEST(StepLimits, EachBindsStepsAndIsNamed) {
  const std::map<Limit, std::function<StepInfo()>> cases = {
      {Limit::cfl, [] { return wet({"time.cfl=0.001"}); }},
      {Limit::viscous, [] { return wet({"time.visc=1e-6"}); }},
      {Limit::friction,
       [] {
         return wet({"fluid.model=sdpd", "time.friction=1e-6"});
       }},
      {Limit::body, [] { return wet({"time.body=1e-6"}); }},
      {Limit::drag, [] { return wet({"time.drag=1e-6"}); }},
      {Limit::travel, [] { return dry([](Config&) {}, 1000); }},
      {Limit::contact, [] { return dry([](Config&) {}); }},
      {Limit::rayleigh, [] { return dry([](Config& c) { c.time.rayleigh = 1e-3; }); }},
      {Limit::rolling,
       [] { return dry([](Config& c) { c.contact.rolling = "epsd", c.grain.mu_r = 1000; }); }},
      {Limit::body_contact, [] { return ball({}); }},
      {Limit::body_rolling,
       [] {
         return ball({"time.contact=0.5", "wall.body.0.free.mu_r=1"});
       }},
      {Limit::body_turn,
       [] {
         return ball({"time.contact=0.5", "wall.body.0.free.E=1e4"});
       }},
      {Limit::flow_speed, [] { return nodes({}); }},
      {Limit::relaxation, [] { return nodes({"fluid.mu=10"}); }},
      {Limit::body_force,
       [] {
         return nodes({"fluid.mu=10", "drive.f=[1e6,0,0]"});
       }},
      {Limit::static_head,
       [] {
         return nodes({"fluid.mu=1", "fluid.dx=0.005", "gravity=[0,0,-9.81]"});
       }},
      {Limit::fixed_relaxation, [] { return nodes({"lattice.tau=0.51"}); }},
      {Limit::growth, grown},
      {Limit::fixed, [] { return wet({"time.dt=1e-6"}); }}};
  const std::map<Limit, std::function<StepInfo()>> of_substeps = {
      {Limit::contact, [] { return wet({}); }},
      {Limit::rayleigh, [] { return wet({"time.rayleigh=1e-4"}); }},
      {Limit::rolling,
       [] {
         return wet({"time.contact=0.5", "time.rayleigh=0.5", "grain.mu_r=1"});
       }},
      {Limit::lubrication,
       [] {
         return wet({"fluid.mu=1", "lubrication.forces=all", "lubrication.least_gap=1e-4"});
       }},
      {Limit::grain_drag,
       [] {
         return wet({"drag.integrator=explicit", "time.drag=1e-6"});
       }},
      {Limit::body_contact, [] { return ball({}); }},
      {Limit::fixed, [] { return wet({"time.dt_dem=1e-6"}); }}};
  for (const auto& row : kLimits) {
    SCOPED_TRACE(row.name);
    ASSERT_TRUE(cases.contains(row.limit) || of_substeps.contains(row.limit)) << "no case makes it bind";
    if (cases.contains(row.limit)) {
      EXPECT_EQ(name_of(cases.at(row.limit)().limit), row.name);
    }
    if (of_substeps.contains(row.limit)) {
      EXPECT_EQ(name_of(of_substeps.at(row.limit)().substep_limit), row.name);
    }
  }
}

void expect_refused(const std::function<StepInfo()>& steps, const std::string& key, const std::string& by) {
  try {
    steps();
    ADD_FAILURE() << "nothing was refused";
  } catch (const KeyError& error) {
    EXPECT_EQ(error.key, key);
    EXPECT_NE(
        std::string(error.what()).find(", by the limit " + by + ", at t = 0 s; at most 1000000 are allowed"),
        std::string::npos)
        << error.what();
  }
}

/// Such a run would never end, and memory for the poses of walls at each substep runs out before.
TEST(StepLimits, MoreThanAMillionSubstepsAreRefused) {
  expect_refused([] { return wet({"time.dt_dem=1e-12"}); }, "time.dt_dem", "\"fixed\"");
  const Overrides light{"time.dt=1", "time.force_dt=true", "wall.body.0.free.E=1e12",
                        "wall.body.0.free.density=1e-6"};
  expect_refused([&] { return ball(light); }, "time.contact", "\"body contact\" of wall.body \"ball\"");
}

}  // namespace
}  // namespace BL_SOLVER
