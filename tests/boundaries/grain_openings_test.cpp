// Grains that are dropped in, taken out and let through.

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "bedload/geometry/grain_source.hpp"
#include "tests/boundaries/support.hpp"

namespace BL_SOLVER {
namespace {

/// A closed funnel with grains dropped in at the top.
const std::string kHopper = R"([domain]
min = [-0.05, -0.05, -0.02]
max = [0.05, 0.05, 0.12]
[[shape]]
name = "inside"
kind = "cone"
a = [0, 0, 0]
b = [0, 0, 0.08]
radius_a = 0.008
radius_b = 0.04
[[shape]]
name = "funnel"
kind = "hollow"
of = ["inside"]
[[wall.body]]
name = "hopper"
shape = "funnel"
[grain]
d = 0.004
E = 1e6
[[grain_inlet]]
name = "feed"
shape = "disc"
centre = [0, 0, 0.07]
direction = [0, 0, 1]
radius = 0.02
rate = 400
velocity = [0, 0, -0.3]
[time]
end = 1
[out]
every = 1
)";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == text.npos) throw std::logic_error("no '" + from + "' in the case");
  return text.replace(at, from.size(), to);
}

TEST(GrainInlet, FillsAHopper) {
  auto s = started(kHopper);
  run_until(*s, 0.25);
  const auto d = s->diagnostics();
  const double due = std::floor(400 * s->time());
  EXPECT_NEAR(reading(d, "grain_inlet_feed_count") + reading(d, "grain_inlet_feed_waiting"), due, 1);
  EXPECT_LE(reading(d, "grain_inlet_feed_waiting"), 3);
  EXPECT_EQ(reading(d, "grain_count"), reading(d, "grain_inlet_feed_count"));
  EXPECT_NEAR(reading(d, "grain_mass") / reading(d, "grain_inlet_feed_mass"), 1, 1e-6);
  EXPECT_LT(reading(d, "overlap_max"), 0.1);
  const HostStore grains = s->snapshot("grains");
  for (const Vec3d& x : vectors(grains, "position"))
    EXPECT_LT(std::hypot(x.x, x.y), 0.008 + 0.4 * x.z) << x.z;  // within the cone
  const auto ids = ids_of(grains);
  EXPECT_EQ(std::set<Id>(ids.begin(), ids.end()).size(), ids.size());
}

/// Levels of size follow the grains that are there.
TEST(GrainInlet, OfUnlikeGrainsGoesOnBitForBit) {
  const Config config = config_of(
      with(kHopper, "rate = 400", "rate = 800\nsizes = [{ d = 0.004 }, { d = 0.001, number_fraction = 9 }]"));
  auto s = started(config);
  run_until(*s, 0.1);
  ASSERT_GT(reading(*s, "grain_count"), 50);
  expect_restart_is_bit_equal(*s, config, 200);
}

/// Grains that come in and leave do so with their energy, and with what their contacts have dissipated.
void expect_closed_books(Simulation& s) {
  const auto d = s.diagnostics();
  double dissipated = 0, booked = 0, count = 0;
  for (const char* how : {"normal", "sliding", "rolling"})
    dissipated += reading(d, std::string("grain_dissipated_") + how);
  const double in = reading(d, "grain_energy_in"), out = reading(d, "grain_energy_out");
  EXPECT_GT(in, 0.1 * dissipated);
  EXPECT_GT(out, 0.1 * dissipated);
  EXPECT_LT(std::abs(reading(d, "grain_energy_residual")), 5e-3 * dissipated);
  for (const auto& row : s.spectra())
    for (const Quantity& q : row) {
      if (q.name.ends_with("_energy")) booked += q.value;
      if (q.name.ends_with("_count")) count += q.value;
    }
  EXPECT_GT(count, 50);
  for (const HostStore& store : s.save().stores) {  // contacts that go on
    if (const HostArray* pairs = store.find("loss"))
      for (std::size_t k = 0; k < 2 * store.count; ++k) booked += pairs->as<double>()[k];
    if (const HostArray* at_walls = store.find("wall_losses"))
      for (std::size_t i = 0; i < store.count; ++i)
        for (std::uint32_t k = 0; k < 2 * store.find("wall_contacts")->as<std::uint32_t>()[i]; ++k)
          booked += at_walls->as<double>()[at_walls->components * i + k];
  }
  EXPECT_NEAR(booked / dissipated, 1, 1e-6);
}

const std::string kWithBooks = "every = 1\nenergy = true\nspectra = true\n";

TEST(GrainInlet, GoesOnBitForBitAfterARestart) {
  const Config config = config_of(with(kHopper, "every = 1\n", kWithBooks) + R"(
[[outlet]]
name = "foot"
phase = "grains"
min = [-0.05, -0.05, -0.02]
max = [0.05, 0.05, 0.01]
)");
  auto s = started(config);
  run_until(*s, 0.2);
  ASSERT_GT(reading(*s, "outlet_foot_grain_count"), 5);
  ASSERT_GT(reading(*s, "grain_count"), 5);
  expect_restart_is_bit_equal(*s, config, 300);
  const auto d = s->diagnostics();
  EXPECT_EQ(reading(d, "grain_count") + reading(d, "outlet_foot_grain_count"),
            reading(d, "grain_inlet_feed_count"));
  EXPECT_NEAR(reading(d, "grain_mass") + reading(d, "outlet_foot_grain_mass"),
              reading(d, "grain_inlet_feed_mass"), 1e-6 * reading(d, "grain_inlet_feed_mass"));
  expect_closed_books(*s);
}

/// Contacts of the grains that stay carry over when another is taken out: a bed that forgot its friction
/// would move otherwise.
TEST(GrainOutlet, LeavesTheOtherGrainsInPeace) {
  const std::string bed = R"([domain]
min = [0, 0, 0]
max = [0.06, 0.03, 0.1]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.06, 0.03, 0.1]
[[wall.body]]
name = "divider"
shape = "box"
min = [0.03, 0, 0]
max = [0.034, 0.03, 0.1]
[grain]
d = 0.004
E = 1e6
[[grain.fill]]
min = [0, 0, 0]
max = [0.03, 0.03, 0.03]
count = 120
[[grain.fill]]
positions = [[0.05, 0.015, 0.06]]
[time]
end = 1
dt = 4e-5
dt_dem = 4e-6
force_dt = true
[out]
every = 1
)";
  const auto run = [&](const std::string& text) {
    auto s = started(text);
    run_until(*s, 0.12);
    return std::pair{s->snapshot("grains"), reading(*s, "grain_count")};
  };
  const auto [whole, all] = run(bed);
  const auto [rest, left] = run(bed + R"(
[[outlet]]
name = "side"
min = [0.04, 0, 0]
max = [0.06, 0.03, 0.03]
)");
  EXPECT_EQ(all, 121);
  EXPECT_EQ(left, 120);
  const auto x = vectors(whole, "position"), y = vectors(rest, "position");
  for (std::size_t i = 0; i < y.size(); ++i) EXPECT_LT(norm(x[i] - y[i]), 1e-7) << i;
}

/// Rods and single grains fall into a hopper together and are taken out below.
TEST(GrainInlet, DropsWholeClumps) {
  const Config config =
      config_of(with(with(kHopper, "rate = 400", "rate = 300\nclump = \"rod\""), "every = 1\n", kWithBooks) +
                R"(
[[clump]]
name = "rod"
spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]
density = 2000
[[grain_inlet]]
name = "beads"
min = [-0.02, -0.02, 0.08]
max = [0.02, 0.02, 0.1]
rate = 300
sizes = [{ d = 0.003 }]
[[grain.fill]]
positions = [[0, 0, 0.04]]
clump = "rod"
[[outlet]]
name = "foot"
phase = "grains"
min = [-0.05, -0.05, -0.02]
max = [0.05, 0.05, 0.01]
)");
  auto s = started(config);
  run_until(*s, 0.2);
  const auto d = s->diagnostics();
  ASSERT_GT(reading(d, "outlet_foot_grain_count"), 10);
  ASSERT_GT(reading(d, "clump_count"), 10);
  const double rods = reading(d, "clump_count");
  EXPECT_EQ(1 + reading(d, "grain_inlet_feed_count") + reading(d, "grain_inlet_beads_count"),
            rods + (reading(d, "grain_count") - 3 * rods) + reading(d, "outlet_foot_grain_count"));
  const double of_rod = 2000 * M_PI / 6 * std::pow(0.004, 3);
  EXPECT_NEAR(reading(d, "grain_inlet_feed_mass") / reading(d, "grain_inlet_feed_count") / of_rod, 1, 1e-9);
  EXPECT_NEAR(of_rod + reading(d, "grain_inlet_feed_mass") + reading(d, "grain_inlet_beads_mass"),
              reading(d, "grain_mass") + reading(d, "outlet_foot_grain_mass"),
              1e-6 * reading(d, "grain_mass"));
  EXPECT_LT(reading(d, "overlap_max"), 0.1);

  const HostStore grains = s->snapshot("grains"), clumps = s->snapshot("clumps");
  const auto ids = ids_of(clumps);
  EXPECT_EQ(std::set<Id>(ids.begin(), ids.end()).size(), ids.size());
  const auto* of = grains.find("clump")->as<std::uint32_t>();
  const auto* x = grains.find("position")->as<Real>();
  std::map<Id, std::size_t> by_id;
  for (std::size_t i = 0; i < grains.count; ++i) by_id[ids_of(grains)[i]] = i;
  std::map<Id, std::vector<Vec3d>> spheres;  // of each clump, in the order of their ids
  for (const auto& [id, i] : by_id)
    if (of[i] > 0) spheres[of[i]].push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
  EXPECT_EQ(spheres.size(), ids.size());
  const double step = config.grain.clumps[0].shape.spheres[0][3] * 0.004;
  for (const auto& [id, all] : spheres) {
    EXPECT_EQ(std::count(ids.begin(), ids.end(), id), 1);
    ASSERT_EQ(all.size(), 3u) << id;
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(norm(all[k + 1] - all[k]) / step, 1, 1e-4) << id;
  }
  expect_closed_books(*s);
  expect_restart_is_bit_equal(*s, config, 200);
}

TEST(GrainOutlet, TakesAClumpWhenItsCentreIsIn) {
  auto s = started(R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.1, 0.02, 0.02]
periodic = [true, false, false]
[[clump]]
name = "rod"
spheres = [[-2, 0, 0, 1], [0, 0, 0, 1], [2, 0, 0, 1]]
[grain]
d = 0.004
E = 1e6
[[grain.fill]]
positions = [[0.02, 0.01, 0.01], [0.09, 0.01, 0.01]]
velocity = [0.5, 0, 0]
clump = "rod"
orientation = [0, 0, 0]
[[grain.fill]]
positions = [[0.03, 0.004, 0.004]]
[[outlet]]
name = "end"
min = [0.04, 0, 0]
max = [0.06, 0.02, 0.02]
[time]
end = 1
[out]
every = 1
)");
  const double mass = reading(*s, "grain_mass");
  double beyond = 0;  // how far the first sphere comes
  while (s->time() < 0.06) {
    s->step();
    const double left = reading(*s, "clump_count");
    EXPECT_EQ(reading(*s, "grain_count"), 3 * left + 1) << "all spheres of a clump at a time";
    if (left < 2) continue;
    for (const Vec3d& x : vectors(s->snapshot("grains"), "position"))
      if (x.x < 0.06) beyond = std::max(beyond, x.x - 0.04);
  }
  EXPECT_NEAR(beyond, 2 * 0.004 / 2 / std::cbrt(3.0), 1e-3);
  auto d = s->diagnostics();
  EXPECT_EQ(reading(d, "outlet_end_grain_count"), 1);
  run_until(*s, 0.16);  // the other comes round
  d = s->diagnostics();
  EXPECT_EQ(reading(d, "outlet_end_grain_count"), 2);
  EXPECT_EQ(reading(d, "clump_count"), 0);
  EXPECT_EQ(reading(d, "grain_count"), 1);
  EXPECT_NEAR(reading(d, "outlet_end_grain_mass") / mass, 2.0 / 3, 1e-6);
}

TEST(GrainInlet, WaitsForSpaceAndSaysSo) {
  auto s = started(with(with(kHopper, "rate = 400", "rate = 20000"), "velocity = [0, 0, -0.3]", ""));
  run_until(*s, 0.01);
  const auto d = s->diagnostics();
  EXPECT_GT(reading(d, "grain_inlet_feed_waiting"), 100);
  EXPECT_NEAR(reading(d, "grain_inlet_feed_waiting") + reading(d, "grain_inlet_feed_count"),
              std::floor(20000 * s->time()), 1);
  EXPECT_LT(reading(d, "overlap_max"), 0.05);
}

/// Grains that are dropped in about a plate, half of the inlet's height within it.
std::string about_a_plate(const std::string& plate) {
  return R"([domain]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
[grain]
d = 0.004
E = 1e6
[[wall.body]]
name = "plate"
shape = "box"
min = [0.02, 0.02, 0.03]
max = [0.08, 0.08, 0.05]
)" + plate +
         R"([[grain_inlet]]
name = "feed"
min = [0.03, 0.03, 0.04]
max = [0.07, 0.07, 0.06]
rate = 1e6
START
[time]
end = 1
dt = 1e-5
dt_dem = 1e-6
force_dt = true
[out]
every = 1
)";
}

TEST(GrainInlet, DropsNoGrainThatTouchesAWall) {
  auto s = started(with(about_a_plate(""), "START", ""));
  for (int k = 0; k < 10; ++k) s->step();
  ASSERT_GT(reading(*s, "grain_inlet_feed_count"), 30);
  for (const Vec3d& x : vectors(s->snapshot("grains"), "position")) EXPECT_GT(x.z, 0.052 - 1e-6);
}

TEST(GrainInlet, DropsGrainsWhereAWallHasBeenRemoved) {
  const std::string plate = R"([wall.body.motion]
kind = "velocity"
velocity = [0, 0, 1e-3]
remove_when_clear = true
)";
  auto s = started(with(about_a_plate(plate), "START", "start = 5e-4"));
  for (int k = 0; k < 60; ++k) s->step();
  ASSERT_GT(reading(*s, "grain_inlet_feed_count"), 30);
  int within = 0;
  for (const Vec3d& x : vectors(s->snapshot("grains"), "position")) within += x.z < 0.05;
  EXPECT_GT(within, 10);
}

TEST(GrainInlet, MassRateWithSeveralSizes) {
  const Config config = config_of(with(kHopper, "rate = 400", R"(mass_rate = 0.02
sizes = [{ d = 0.003, number_fraction = 3 }, { kind = "uniform", d_min = 0.004, d_max = 0.006, number_fraction = 1 }])"));
  EXPECT_EQ(config.grain.d_min, 0.003);
  EXPECT_EQ(config.grain.d_max, 0.006);
  GrainSource source(config, 0), again(config, 0);
  int small = 0;
  for (int n = 0; n < 2000; ++n) {
    EXPECT_EQ(source.radius(), again.radius());
    small += source.radius() < 0.0019;
    for (const Vec3d& x : source.places()) EXPECT_LE(std::hypot(x.x, x.y) + source.radius(), 0.02 + 1e-12);
    source.dropped();
    again.dropped();
  }
  EXPECT_NEAR(small, 1500, 80);
  // the next grain is due as soon as the rate pays for it
  const double mass = source.state.mass, next = 2500 * 4.18879020478639 * std::pow(source.radius(), 3);
  EXPECT_FALSE(source.due((mass + 0.999 * next) / 0.02));
  EXPECT_TRUE(source.due((mass + 1.001 * next) / 0.02));
}

TEST(Filter, FluidOnlyLetsGrainsPass) {
  const std::string text = R"([domain]
min = [0, 0, 0]
max = [0.08, 0.08, 0.16]
periodic = [true, true, false]
[fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0.08]
max = [0.08, 0.08, 0.14]
[[wall.body]]
name = "floor"
shape = "tank"
min = [0, 0, 0]
max = [0.08, 0.08, 0.16]
faces = ["z-"]
[[wall.body]]
name = "sieve"
shape = "box"
type = "KIND"
min = [0, 0, 0.05]
max = [0.08, 0.08, 0.08]
[grain]
d = 0.006
E = 1e6
[[grain.fill]]
positions = [[0.04, 0.04, 0.1]]
[time]
end = 1
[out]
every = 1
)";
  const auto lowest = [&](const std::string& kind) {
    auto s = started(with(text, "KIND", kind));
    double z = 1;
    while (s->time() < 0.3) {
      s->step();
      z = std::min(z, vectors(s->snapshot("grains"), "position")[0].z);
    }
    const HostStore fluid = s->snapshot("fluid");
    const auto* x = fluid.find("position")->as<Real>();
    for (std::size_t a = 0; a < fluid.count; ++a) EXPECT_GT(x[3 * a + 2], 0.08 - 0.003);
    EXPECT_EQ(fluid.count, 8u * 8 * 6);
    return z;
  };
  EXPECT_LT(lowest("fluid_only"), 0.02);  // down to the floor
  EXPECT_GT(lowest("adami"), 0.08);
}

}  // namespace
}  // namespace BL_SOLVER
