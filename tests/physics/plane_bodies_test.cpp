// Bodies that move freely in plane flows.

#include <cmath>

#include "tests/boundaries/support.hpp"
#include "tests/support/free_body.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kLong = 0.37, kMiddle = 0.085;  // m

/// An empty plane without gravity; `body`: the rest of a block of 0.1 m x 0.04 m that stands on z = 0.
std::string block(const std::string& free, const std::string& gravity = "[0, 0, 0]") {
  return "gravity = " + gravity + R"(
[domain]
min = [-1, -0.1, -1]
max = [1, 0.27, 1]
two_d = true
[time]
end = 10
dt = 1e-3
dt_dem = 1e-3
force_dt = true
[out]
every = 1
[[wall.body]]
name = "block"
shape = "box"
min = [-0.05, 3, 0]
max = [0.05, 5, 0.04]
[wall.body.free]
density = 1000
)" + free;
}

void expect_in_plane(const std::vector<Quantity>& body) {
  EXPECT_EQ(reading(body, "centre_y"), kMiddle);
  for (const char* none :
       {"rotation_x", "rotation_z", "angular_velocity_x", "angular_velocity_z", "velocity_y"})
    EXPECT_EQ(reading(body, none), 0) << none;
}

TEST(PlaneBody, WeighsAsMuchAsAllOfIt) {
  const Config c = config_of(block(""));
  const MassProperties& m = c.wall.bodies[0].free.solid;
  EXPECT_NEAR(m.mass / (1000 * 0.1 * 0.04 * kLong), 1, 1e-12);
  EXPECT_NEAR(m.inertia[1] / (m.mass * (0.1 * 0.1 + 0.04 * 0.04) / 12), 1, 1e-12);
  EXPECT_EQ(m.centre.y, kMiddle);
}

TEST(PlaneBody, IsFreeInThePlaneAsFarAsItsCaseLetsIt) {
  struct Case {
    const char* keys;
    Vec3d v, omega;  // after one second of gravity (1, 0, 3) m/s2, beginning with spin (0, 2, 0) rad/s
  };
  const Vec3d pull{1, 0, 3}, up{0, 0, 3}, along{1, 0, 0}, turn{0, 2, 0};
  for (const Case& k : {Case{"", pull, turn},
                        {"move = \"all\"\nturn = \"none\"\n", pull, {}},
                        {"move = \"axis\"\naxis = [0, 0, 1]\n", up, turn},
                        {"move = \"axis\"\naxis = [0, 0, 1]\nturn = \"none\"\n", up, {}},
                        {"move = \"axis\"\naxis = [0, 0, 1]\nturn = \"axis\"\n", up, {}},
                        {"move = \"plane\"\naxis = [0, 0, 2]\n", along, turn},
                        {"move = \"plane\"\naxis = [0, 1, 0]\nturn = \"axis\"\n", pull, turn},
                        {"move = \"axis\"\naxis = [0, 1, 0]\nturn = \"axis\"\n", {}, turn},
                        {"move = \"none\"\nturn = \"axis\"\naxis = [0, -1, 0]\n", {}, turn},
                        {"move = \"none\"\n", {}, turn}}) {
    auto s = started(block(std::string(k.keys) + "spin = [0, 2, 0]\n", "[1, 0, 3]"));
    for (int n = 0; n < 1000; ++n) s->step();
    const auto b = s->body_state(0);
    EXPECT_LT(norm(vector_of(b, "velocity") - k.v), 1e-9) << k.keys;
    EXPECT_LT(norm(vector_of(b, "angular_velocity") - k.omega), 1e-9) << k.keys;
    expect_in_plane(b);
  }
}

// -- contacts -------------------------------------------------------------------

std::string without_step(std::string text) {
  const std::string steps = "dt = 1e-3\ndt_dem = 1e-3\nforce_dt = true\n";
  return text.erase(text.find(steps), steps.size());
}

TEST(PlaneBody, SlidesOnTheGroundUntilItRests) {
  const double g = 9.81, mu = 0.3, weight = 1000 * 0.1 * 0.04 * kLong * g;
  auto s =
      started(without_step(block("velocity = [0.5, 0, 0]\nmu = 0.3\ne = 0.3\n", "[0, 0, -9.81]")) +
              "[[wall.body]]\nname = \"ground\"\nshape = \"plane\"\nnormal = [0, 0, 1]\npoint = [0, 0, 0]\n");
  run_until(*s, 0.1);
  EXPECT_NEAR(reading(s->body_state(0), "velocity_x"), 0.5 - mu * g * s->time(), 0.01);
  run_until(*s, 0.4);
  const auto b = s->body_state(0);
  EXPECT_NEAR(reading(b, "centre_x"), 0.25 / (2 * mu * g), 0.02 * 0.25 / (2 * mu * g));
  EXPECT_LT(norm(vector_of(b, "velocity")), 1e-4);
  EXPECT_NEAR(reading(b, "force_by_bodies_z"), weight, 1e-3 * weight);
  expect_in_plane(b);
}

TEST(PlaneBody, KeepsMomentaAsItMeetsAnother) {
  auto s = started(without_step(block("velocity = [0.8, 0, 0.1]\nspin = [0, 3, 0]\n")) + R"([[shape]]
name = "drum"
kind = "cylinder"
a = [0.09, -1, 0.03]
b = [0.09, 1, 0.03]
radius = 0.025
[[wall.body]]
name = "drum"
shape = "drum"
[wall.body.free]
density = 2000
velocity = [-0.6, 0, 0]
spin = [0, -2, 0]
)");
  const auto before = s->diagnostics();
  double touched = 0;
  while (s->time() < 0.06) {
    s->step();
    touched = std::max(touched, norm(vector_of(s->body_state(0), "force_by_bodies")));
  }
  const auto after = s->diagnostics();
  ASSERT_GT(touched, 1) << "the test means them to meet";
  const double p = 1000 * 0.1 * 0.04 * kLong * 0.8;
  EXPECT_LT(norm(vector_of(after, "body_momentum") - vector_of(before, "body_momentum")), 1e-12 * p);
  EXPECT_LT(norm(vector_of(after, "body_angular_momentum") - vector_of(before, "body_angular_momentum")),
            1e-11 * p * 0.1);
  for (int k : {0, 1}) expect_in_plane(s->body_state(k));
}

/// A union of cylinders along y, of which the plane cuts the lower one.
TEST(PlaneBody, MeetsOfAShapeWhatThePlaneCuts) {
  auto s = started(without_step(block("e = 0.3\nmove = \"axis\"\naxis = [0, 0, 1]\n", "[0, 0, -9.81]")) +
                   R"([[shape]]
name = "cut"
kind = "cylinder"
a = [0, -0.5, -0.06]
b = [0, 1, -0.06]
radius = 0.05
[[shape]]
name = "beside"
kind = "cylinder"
a = [0, -1, -0.05]
b = [0, -0.5, -0.05]
radius = 0.045
[[shape]]
name = "pile"
kind = "union"
of = ["cut", "beside"]
[[wall.body]]
name = "pile"
shape = "pile"
)");
  run_until(*s, 0.3);
  EXPECT_NEAR(reading(s->body_state(0), "centre_z"), 0.02 - 0.01, 1e-3);
}

// -- in fluid -------------------------------------------------------------------

/// A box that drives through a drop, without gravity or walls.
std::string drop(const std::string& viscosity, const std::string& shift) {
  return R"(gravity = [0, 0, 0]
[domain]
min = [-0.1, -0.1, -0.1]
max = [0.1, 0.27, 0.1]
two_d = true
[fluid]
dx = 0.01
mu = 1
vmax = 1
[visc]
model = ")" +
         viscosity + "\"\n[shift]\nA = " + shift + R"(
[[fluid.fill]]
min = [-0.06, 0, -0.06]
max = [0.06, 0, 0.06]
[[wall.body]]
name = "box"
shape = "box"
min = [-0.03, 0, -0.03]
max = [0.03, 0, 0.03]
[wall.body.free]
density = 800
velocity = [0.3, 0, 0.2]
spin = [0, 4, 0]
[time]
end = 10
[out]
every = 1
)";
}

TEST(PlaneBodyInFluid, ClosedSystemKeepsMomenta) {
  for (const std::string viscosity : {"none", "morris", "monaghan"})
    for (const char* shift : {"0", "200", "200\n[pressure]\nlinear_exact = false"}) {
      const bool linear_exact = std::string(shift) == "200" && viscosity != "none";
      auto s = started(drop(viscosity, shift));
      const auto total = [&](const char* what) {
        const auto d = s->diagnostics();
        return vector_of(d, std::string("fluid_") + what) + vector_of(d, std::string("body_") + what);
      };
      const Vec3d p = total("momentum"), l = total("angular_momentum");
      const double scale = norm(p);
      double pushed = 0;
      Vec3d corrected;
      for (int k = 0; k < 200; ++k) {
        corrected += corrected_in_a_step(*s);
        pushed = std::max(pushed, norm(vector_of(s->body_state(0), "force_by_fluid")));
      }
      ASSERT_GT(pushed, 1);
      EXPECT_LT(norm(vector_of(s->diagnostics(), "body_momentum")), 0.95 * scale)
          << "the fluid has taken some";
      EXPECT_LT(norm(total("momentum") - p - corrected), 10 * kInvariant * scale + 0.02 * norm(corrected))
          << viscosity;
      EXPECT_EQ(norm(corrected) > 0, linear_exact);
      if (viscosity != "morris" && !linear_exact) {  // the former's forces are not central
        EXPECT_LT(norm(total("angular_momentum") - l),
                  (*shift == '0' ? 10 * kInvariant : 0.02) * scale * 0.05);
      }
      expect_in_plane(s->body_state(0));
    }
}

constexpr double kSide = 0.16, kDepth = 0.08, kDraught = 0.03;  // of the tank, its water, the raft at first

/// A raft of half the water's density in a tank; in the plane or in a slab of 0.08 m.
std::string raft(bool plane, const std::string& free) {
  return std::string(R"([domain]
min = [-0.12, 0, -0.04]
max = [0.12, 0.08, 0.2]
)") + (plane ? "two_d = true" : "periodic = [false, true, false]") +
         R"(
[fluid]
dx = 0.01
vmax = 1.5
[density]
delta = 0.1
[visc]
alpha = 0.05
[[fluid.fill]]
min = [-0.08, 0, 0]
max = [0.08, 0.08, 0.08]
[[wall.body]]
name = "tank"
shape = "tank"
min = [-0.08, 0, 0]
max = [0.08, 0.08, 0.2]
faces = ["x-", "x+", "z-"]
[[wall.body]]
name = "raft"
shape = "box"
min = [-0.04, 0, 0.05]
max = [0.04, 0.08, 0.09]
[wall.body.free]
density = 500
)" + free +
         R"([time]
end = 10
[out]
every = 1
)";
}

TEST(PlaneBodyInFluid, FloatsAtArchimedesDepth) {
  auto s = started(raft(true, ""));
  run_until(*s, 2);
  double z = 0, n = 0;
  while (s->time() < 2.5) {
    s->step();
    z += reading(s->body_state(1), "centre_z") - 0.02, n += 1;
  }
  const double draught = 0.02, water = kSide * kDepth - 0.08 * kDraught,
               level = (water + 0.08 * draught) / kSide;
  EXPECT_NEAR(z / n, level - draught, 0.1 * 0.01);
  const auto b = s->body_state(1);
  EXPECT_NEAR(reading(b, "force_by_fluid_z") / (9.81 * 500 * 0.08 * 0.04 * 0.08), 1, 0.1);
  EXPECT_LT(norm(vector_of(b, "velocity")), 0.02);
  EXPECT_GT(rotation_of(b).rotate({0, 0, 1}).z, std::cos(0.15)) << "upright";
}

/// Times (s) at which the raft turns and its heights (m) there.
std::vector<std::pair<double, double>> heave(Simulation& s, std::size_t turns) {
  std::vector<std::pair<double, double>> at;
  double before = 0;
  while (at.size() < turns && s.time() < 1) {
    s.step();
    const auto b = s.body_state(1);
    const double v = reading(b, "velocity_z");
    if (before * v < 0) at.push_back({s.time(), reading(b, "centre_z")});
    before = v;
  }
  return at;
}

TEST(PlaneBodyInFluid, HeavesAsInASlab) {
  const std::string heaves = "move = \"axis\"\naxis = [0, 0, 1]\nturn = \"none\"\n";
  const auto plane = heave(*started(raft(true, heaves)), 3), slab = heave(*started(raft(false, heaves)), 3);
  ASSERT_EQ(plane.size(), 3u);
  ASSERT_EQ(slab.size(), 3u);
  const double amplitude = slab[0].second - slab[1].second;  // 6 mm
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(plane[k].first / slab[k].first, 1, 0.02) << k;
    EXPECT_NEAR(plane[k].second, slab[k].second, 0.05 * amplitude) << k;
  }
}

TEST(PlaneBodyInFluid, NeverLeavesThePlane) {
  auto s = started(raft(true,
                        "velocity = [0.4, 0, -0.3]\nspin = [0, 6, 0]\ncentre_of_mass = [0.02, 9, "
                        "0.07]\ninertia = [1e-4, 9e-5, 1e-4, 3e-5, 0, 2e-5]\n"));
  double turned = 0;
  while (s->time() < 0.5) {
    s->step();
    const auto b = s->body_state(1);
    ASSERT_EQ(reading(b, "centre_y"), 0.04);
    for (const char* none : {"rotation_x", "rotation_z", "angular_velocity_x", "angular_velocity_z"})
      ASSERT_EQ(reading(b, none), 0) << none;
    turned = std::max(turned, std::abs(reading(b, "rotation_y")));
  }
  EXPECT_GT(turned, 0.1);
  for (const char* store : {"fluid", "walls"})
    for (const Vec3d& x : vectors(s->snapshot(store), "position")) EXPECT_NEAR(x.y, 0.04, 1e-6);
}

}  // namespace
}  // namespace BL_SOLVER
