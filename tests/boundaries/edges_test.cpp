// Sides of the domain that put back what crosses them.

#include <algorithm>
#include <cmath>

#include "kernels/boundaries/edges.hpp"
#include "src/time/coupled_simulation.hpp"
#include "tests/boundaries/support.hpp"

namespace BL_SOLVER {
namespace {

const Vec3d kHigh{0.2, 0.3, 0.25};  // the lower corner is at 0

std::string box(const std::string& sides, const std::string& time = "") {
  return "gravity = [0, 0, 0]\n[domain]\nmin = [0, 0, 0]\nmax = [0.2, 0.3, 0.25]\n" + sides +
         "[time]\nend = 1\n" + time + "[out]\nevery = 1\n";
}
const std::string kAllSides = R"(["x-", "x+", "y-", "y+", "z-", "z+"])";
const std::string kLoneParticle = R"([fluid]
dx = 0.01
vmax = 3
[[fluid.fill]]
min = [0.1, 0.1, 0.1]
max = [0.11, 0.11, 0.11]
velocity = [0.5, -0.7, 1.3]
)";
const std::string kLoneGrain = R"([grain]
d = 0.02
E = 1e6
[[grain.fill]]
positions = [[0.1, 0.1, 0.1]]
velocity = [0.5, -0.7, 1.3]
spin = [3, 4, 5]
)";
/// Where a point that went straight on to x is between mirrors at 0 and L, and the sign of its velocity.
std::pair<double, double> folded(double x, double L) {
  const double turns = std::floor(x / L), rest = x - turns * L;
  return std::fmod(turns, 2) == 0 ? std::pair{rest, 1.0} : std::pair{L - rest, -1.0};
}

/// Of places as told, and of steps, over all of the way, m.
constexpr double kRounding = 1e-7;

struct Lone {
  std::unique_ptr<Simulation> simulation;
  std::string store;
  Lone(const std::string& text, const std::string& of) : simulation(started(text)), store(of) {}
  Vec3d at() const { return vectors(simulation->snapshot(store), "position").at(0); }
  Vec3d v() const { return vectors(simulation->snapshot(store), "velocity").at(0); }
};

/// A particle by each integrator, a grain.
std::vector<Lone> lone_ones(const std::string& sides) {
  std::vector<Lone> out;
  for (const char* integrator : {"\"kdk\"", "\"euler\"", "\"ab3\"\ncfl = 0.25"})
    out.emplace_back(box(sides, "integrator = " + std::string(integrator) + "\n") + kLoneParticle, "fluid");
  out.emplace_back(box(sides, "dt_dem = 1e-4\n") + kLoneGrain, "grains");
  return out;
}

TEST(Edges, MirrorWhatSlips) {
  for (const Lone& one : lone_ones("reflect.slip = " + kAllSides + "\n")) {
    const Vec3d x0 = one.at(), v0 = one.v();
    std::array<int, 3> turned{};
    Vec3d before = v0;
    while (one.simulation->time() < 0.9) {
      one.simulation->step();
      const Vec3d x = one.at(), v = one.v();
      for (int k = 0; k < 3; ++k) {
        const auto [place, sign] = folded(x0[k] + v0[k] * one.simulation->time(), kHigh[k]);
        ASSERT_NEAR(x[k], place, kRounding) << one.store;
        ASSERT_EQ(v[k], sign * v0[k]) << "all of its energy";
        turned[k] += v[k] != before[k];
      }
      before = v;
    }
    EXPECT_GE(*std::min_element(turned.begin(), turned.end()), 2) << one.store;
  }
}

TEST(Edges, TurnAllOfTheVelocityWhereNothingSlips) {
  for (const Lone& one : lone_ones("reflect.no_slip = [\"z-\", \"z+\"]\n")) {
    const Vec3d x0 = one.at(), v0 = one.v();
    double sign = 1, along = 0;  // m over m/s
    int turned = 0;
    while (one.simulation->time() < 0.9) {
      const double dt = one.simulation->step().dt;
      along += sign * dt;
      const Vec3d x = one.at(), v = one.v();
      const auto [z, now] = folded(x0.z + v0.z * one.simulation->time(), kHigh.z);
      turned += now != sign;
      sign = now;
      ASSERT_NEAR(x.z, z, kRounding) << one.store;
      // grains turn in the middle of a step, in a substep
      ASSERT_NEAR(x.x, x0.x + along * v0.x,
                  one.store == "grains" ? turned * 2 * dt * v0.x + kRounding : kRounding);
      for (int k = 0; k < 3; ++k) ASSERT_EQ(v[k], sign * v0[k]);
    }
    EXPECT_GE(turned, 4) << one.store;
  }
}

TEST(Edges, LeaveSpinsAlone) {
  for (const std::string kind : {"slip", "no_slip"}) {
    auto s = started(box("reflect." + kind + " = " + kAllSides + "\n", "dt_dem = 1e-4\n") + kLoneGrain);
    run_until(*s, 0.9);
    const Vec3d spin = vectors(s->snapshot("grains"), "angular_velocity").at(0);
    EXPECT_EQ(norm(spin - Vec3d{3, 4, 5}), 0) << kind;
  }
}

TEST(Edges, InCornersTurnVelocitiesInwards) {
  const Frame frame({0, 0, 0}, {1, 1, 1}, false, false, false);
  const auto turned = [&](const ReflectConfig& sides, const Vec3d& x, Vec3d v, const Vec3d& place) {
    Vec3d at = x;
    Edges(sides, frame).put_back(Vec3d{0.5, 0.5, 0.5}, at, v);
    EXPECT_NEAR(norm(at - place), 0, 1e-15);
    return v;
  };
  const auto equal = [](const Vec3d& a, const Vec3d& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
  ReflectConfig all_slip, no_slip, mixed;
  all_slip.slip.fill(true);
  no_slip.no_slip.fill(true);
  mixed.no_slip[1] = mixed.slip[3] = true;  // x+, y+
  const Vec3d beyond{1.25, 1.125, -0.25}, back{0.75, 0.875, 0.25}, v{1, 2, -3};
  EXPECT_TRUE(equal(turned(all_slip, beyond, v, back), -v));
  EXPECT_TRUE(equal(turned(no_slip, beyond, v, back), -v)) << "once, though it crosses three";
  EXPECT_TRUE(equal(turned(mixed, {1.25, 1.125, 0.5}, v, {0.75, 0.875, 0.5}), -v));
  EXPECT_TRUE(equal(turned(mixed, {0.5, 1.125, 0.5}, v, {0.5, 0.875, 0.5}), {1, -2, -3}));
  // drift has taken it across against its velocity
  EXPECT_TRUE(equal(turned(no_slip, {1.25, 0.5, 0.5}, {-1, 2, 3}, {0.75, 0.5, 0.5}), {-1, 2, 3}));
  EXPECT_TRUE(equal(turned(no_slip, {1.25, 1.125, 0.5}, {-1, 2, 3}, back + Vec3d{0, 0, 0.25}), {-1, -2, -3}));
}

TEST(Edges, DoNotFetchWhatIsOutside) {
  const Frame frame({0, 0, 0}, {1, 1, 1}, false, false, false);
  ReflectConfig sides;
  sides.slip.fill(true);
  const Edges edges(sides, frame);
  Vec3d x{1.25, 0.5, 0.5}, v{1, 0, 0};
  edges.put_back(Vec3d{1.125, 0.5, 0.5}, x, v);
  EXPECT_EQ(x.x, 1.25);
  EXPECT_EQ(v.x, 1);
  EXPECT_EQ(edges.inside({0.125, 0.5, 0.5}, {0.25, 0, 0}).x, 0.125) << "a mirrored way";
  // but what packing has rounded out
  x = {1.25, 0.5, 0.5};
  edges.put_back(Vec3d{1 + 0x1p-34, 0.5, 0.5}, x, v);
  EXPECT_EQ(x.x, 0.75);
  EXPECT_EQ(v.x, -1);
}

/// Fluid that flows about, in all of the box, and some grains.
std::string suspension(const std::string& sides) {
  return box(sides) + R"case([fluid]
dx = 0.025
vmax = 2
[[fluid.fill]]
min = [0, 0, 0]
max = [0.2, 0.3, 0.25]
velocity = ["2*sin(31.4*y+9*z)", "2*sin(31.4*z+9*x)", "2*sin(31.4*x+9*y)"]
[grain]
d = 0.006
E = 2e5
[[grain.fill]]
min = [0.01, 0.01, 0.01]
max = [0.19, 0.29, 0.24]
count = 60
velocity = [2, 1, -2]
)case";
}

/// Of what is left.
int count_outside(Simulation& s) {
  int out = 0;
  for (const HostStore& store : s.save().stores)
    if (const HostArray* x = store.find("x"); x && x->type == Scalar::f64)
      for (std::size_t i = 0; i < 3 * store.count; ++i) {
        const double at = x->as<double>()[i], high = kHigh[int(i % 3)];
        out += at < 0 || at > high;
      }
  return out;
}

TEST(Edges, LoseNothingOfASuspensionAndGoOnBitForBit) {
  std::string open = "reflect.slip = [\"x-\"]\n";
  std::string shut = "reflect.slip = [\"x-\", \"x+\", \"z-\"]\nreflect.no_slip = [\"y-\", \"y+\", \"z+\"]\n";
  double lost = 0;
  for (const std::string& sides : {shut, open}) {
    const Config config = config_of(suspension(sides));
    auto s = started(config);
    for (int k = 0; k < 80; ++k) s->step();
    lost = count_outside(*s) + reading(*s, "lost_fluid_count");
    if (sides == shut) {
      EXPECT_EQ(lost, 0);
      expect_restart_is_bit_equal(*s, config, 5);
    }
  }
  EXPECT_GT(lost, 50) << "nothing reached the sides";
}

/// Fluid keeps to the domain, and to the half skins for which its lists were made, as pair loops see it in
/// the middle of steps too.
TEST(Edges, HoldFluidAsPairLoopsSeeIt) {
  const Config config = config_of(suspension("reflect.slip = " + kAllSides + "\n"));
  std::vector<std::string> warnings;
  CoupledSimulation simulation(config, build_setup(config, warnings));
  simulation.start();
  const FluidStore& fluid = simulation.state().fluid;
  const Frame& frame = simulation.state().frame;
  double most = 0;  // of the half skin
  int out = 0;
  for (int n = 0; n < 80; ++n)
    simulation.stepper().step([&](const Stage* next) {
      if (next && next->name == "renew_lists") return;
      const auto x = fluid.x.values(), listed = fluid.x_list.values();
      const bool mid = next && (next->name == "move_walls" || next->name == "density");
      const auto xp = mid ? fluid.xp_mid.values() : fluid.xp.values();
      const auto half_skin = fluid.half_skin.values();
      for (std::size_t a = 0; a < x.size(); ++a) {
        const Vec3d at = coordinates(frame, x[a]), from = coordinates(frame, listed[a]);
        const Vec3d seen = at + Vec3d(frame.separation(xp[a], pair_position(frame, at)));
        for (int k = 0; k < 3; ++k) out += seen[k] < -1e-6 || seen[k] > kHigh[k] + 1e-6;
        most = std::max({most, norm(at - from) / half_skin[a], norm(seen - from) / half_skin[a]});
      }
    });
  EXPECT_EQ(out, 0);
  EXPECT_LE(most, 1.0001);
  EXPECT_GT(most, 0.5);
}

TEST(Edges, KeepMomentumAlongThem) {
  const std::string text =
      "gravity = [0, 0, 0]\n[domain]\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\nperiodic = [true, true, "
      "false]\n"
      "reflect.slip = [\"z-\", \"z+\"]\n[time]\nend = 1\n[out]\nevery = 1\n"
      "[fluid]\ndx = 0.01\nvmax = 1\n[[fluid.fill]]\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\n"
      "velocity = [0.3, 0.2, \"0.5+0.2*sin(62.8*x)\"]\n";
  auto s = started(text);
  const auto momentum = [&] {
    Vec3d sum;
    for (const Vec3d& v : vectors(s->snapshot("fluid"), "velocity")) sum += v;
    return sum / double(s->snapshot("fluid").count);
  };
  const Vec3d before = momentum();
  double least = before.z;
  for (int k = 0; k < 100; ++k) {
    s->step();
    least = std::min(least, momentum().z);
  }
  EXPECT_NEAR(momentum().x, before.x, 2e-6);
  EXPECT_NEAR(momentum().y, before.y, 2e-6);
  EXPECT_LT(least, 0.3) << "some was turned";
}

/// Frictionless elastic grains between mirrors.
TEST(Edges, KeepTheEnergyOfAGasOfGrains) {
  auto s = started(box("reflect.slip = " + kAllSides + "\n") + R"([grain]
d = 0.02
e = 1
mu = 0
E = 1e6
[[grain.fill]]
min = [0.01, 0.01, 0.01]
max = [0.19, 0.29, 0.24]
count = 100
velocity = [1, 2, -3]
)");
  const auto energy = [&] {
    double sum = 0;
    for (const Vec3d& v : vectors(s->snapshot("grains"), "velocity")) sum += norm2(v) / 100;
    return sum;
  };
  run_until(*s, 0.5);
  double most = 0;
  for (int k = 0; k < 200; ++k) {
    s->step();
    most = std::max(most, energy());
  }
  EXPECT_NEAR(most, 14, 0.05) << "but for what contacts hold";
}

}  // namespace
}  // namespace BL_SOLVER
