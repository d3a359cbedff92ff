// Walls of every kind: still water, shear flow, a head of water, moving and saved.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kG = 9.81;

/// A kind of wall with the numbers that a case file would give it.
struct Kind {
  const char* name;
  const char* type;
  const char* force = "kajtar";
  double gap = 0;       ///< how far from the wall a fill begins, dx
  double slip = 0.05;   ///< most by which the place of no slip lies off the surface, dx
  double level = 0.02;  ///< how true pressures are
};
const Kind kKinds[] = {
    {"adami", "adami"},
    {"mdbc", "mdbc"},
    {"frozen", "frozen", "kajtar", 0, 0.65},  // as fast as the wall half a spacing behind its surface
    {"monaghan", "single_layer", "monaghan", 0.5, 0.25, 0.12},  // lumpy: disturbs the packing above
    {"kajtar", "single_layer", "kajtar", 0.5, 0.25, 0.03}};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

WallBody of_kind(const Kind& kind, WallBody body, const char* name, const Config& c) {
  body.name = name;
  body.type = kind.type;
  body.force = kind.force;
  if (body.single_layer()) body.dx = c.fluid.dx / 2;
  return body;
}

/// One face of the domain, or more.
WallBody face(const char* name, const char* faces, const Kind& kind, const Config& c) {
  return of_kind(kind, test::tank(c.domain.min, c.domain.max, faces), name, c);
}

Config water(int across, double height, double dx) {
  Config c = periodic_box(across, dx);
  c.gravity = {0, 0, -kG};
  c.fluid.c = 10 * std::sqrt(2 * kG * height);
  c.visc.alpha = 0.02;
  c.density.delta = 0.1;
  c.wall.rep_D = 5 * kG * height;
  c.wall.layer_r0 = dx;
  return c;
}

class WallKinds : public testing::TestWithParam<Kind> {
 protected:
  /// Still water over a floor, periodic sideways.
  Config column(double height, double dx) const {
    Config c = water(8, height, dx);
    c.domain.periodic = {true, true, false};
    c.domain.max.z = 1.5 * height;
    c.wall.bodies = {face("floor", "z-", GetParam(), c)};
    FluidFill fill{c.domain.min, c.domain.max};
    fill.min.z = GetParam().gap * dx;
    fill.max.z = fill.min.z + height;
    c.fluid.fills = {fill};
    return c;
  }
  /// Water at rest in a tank that is closed all round but at the top, with a plate across that keeps all of
  /// it on one side.
  Config pool(const Kind& kind, double head) const {
    const double dx = 0.01;
    Config c = water(8, head, dx);
    c.domain.periodic = {false, true, false};
    c.domain.min = {-0.05, 0, -0.05};
    c.domain.max = {0.25, 0.08, 0.25};
    const WallBody outer = test::tank({0, 0, 0}, {0.2, 0.08, 0.2}, "x-x+z-z+");
    const WallBody plate =
        of_kind(kind, test::body("box", {0.1, 0, 0}, {0.1 + 0.2 * dx, 0.08, 0.2}), "plate", c);
    c.wall.bodies = {outer, plate};
    c.fluid.fills = {{{0, 0, 0}, {0.1 - kind.gap * dx, 0.08, head}}};
    return c;
  }
};
using SlowWallKinds = WallKinds;
using SmallWallKinds = WallKinds;

const auto kNamed = [](const testing::TestParamInfo<Kind>& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Each, WallKinds, testing::ValuesIn(kKinds), kNamed);
INSTANTIATE_TEST_SUITE_P(Each, SlowWallKinds, testing::ValuesIn(kKinds), kNamed);
INSTANTIATE_TEST_SUITE_P(Each, SmallWallKinds, testing::ValuesIn(kKinds), kNamed);

TEST_P(SlowWallKinds, HoldStillWater) {  // T-9
  const double height = 0.2, dx = 0.02;
  auto s = started(column(height, dx));
  const double settled = std::string(GetParam().type) == "adami" ? 4 : 3;  // s
  run_until(*s, settled);
  double slope = 0, at_zero = 0, push = 0;
  constexpr int instants = 5;
  for (int k = 1; k <= instants; ++k) {
    run_until(*s, settled + 0.2 * k);
    const LineFit line = pressure_line(*s, 2 * dx, height - dx);
    slope += line.slope() / instants;
    at_zero += line.at_zero() / instants;
    push += reading(s->diagnostics(), "force_walls_on_fluid_z") / instants;
  }
  double lowest = 1, highest = 0;
  for (const Vec3d& x : vectors(s->snapshot("fluid"), "position"))
    lowest = std::min(lowest, x.z), highest = std::max(highest, x.z);
  const auto d = s->diagnostics();
  const double weight = kG * reading(d, "fluid_mass"), level = GetParam().level;
  EXPECT_NEAR(slope, -9810, level * 9810);
  EXPECT_NEAR(at_zero, 9810 * (highest + dx / 2), level * 9810 * height);
  EXPECT_NEAR(push, weight, 0.02 * weight);
  // on the lumps of a single layer particles still change places, now and then, by the third second
  EXPECT_LT(std::sqrt(2 * reading(d, "fluid_kinetic_energy") / reading(d, "fluid_mass")), 0.02);
  if (GetParam().level < 0.1) {
    EXPECT_LT(reading(d, "fluid_speed_max"), 0.02);
  }
  EXPECT_GT(lowest, 0.2 * dx);
  EXPECT_EQ(reading(d, "lost_fluid_count"), 0);
}

TEST_P(SlowWallKinds,
       CarryShear) {  // T-10, start-up over: linear between a wall at rest and one that moves
  const int n = 24;
  const double L = 1e-3, dx = L / n, u = 1.25e-5;
  Config c = periodic_box(8, dx);
  c.domain.periodic = {true, true, false};
  c.domain.max.z = L;
  c.fluid.c = 20 * u;
  c.wall.rep_D = c.fluid.c * c.fluid.c / 100;
  c.wall.layer_r0 = dx;
  FluidFill fill{c.domain.min, c.domain.max};
  fill.min.z += GetParam().gap * dx;
  fill.max.z -= GetParam().gap * dx;
  c.fluid.fills = {fill};
  c.wall.bodies = {face("floor", "z-", GetParam(), c), face("lid", "z+", GetParam(), c)};
  c.wall.bodies[1].motion.kind = "velocity";
  c.wall.bodies[1].motion.velocity = {u, 0, 0};
  auto s = started(c);
  run_until(*s, 1);
  const auto x = vectors(s->snapshot("fluid"), "position");
  const auto v = vectors(s->snapshot("fluid"), "velocity");
  LineFit profile;
  for (std::size_t a = 0; a < x.size(); ++a) {
    if (std::abs(x[a].z - L / 2) <= 0.3 * L) profile.add(x[a].z, v[a].x);
    if (GetParam().slip <= 0.05) {
      EXPECT_NEAR(v[a].x, u * x[a].z / L, 2e-2 * u);
    }
  }
  const double slope = profile.slope();
  ProbeConfig probe;
  probe.name = "lid", probe.type = "force", probe.body = "lid";
  const double stress = -reading(s->measure(probe), "force_by_fluid_x") / (64 * dx * dx);
  EXPECT_LT(std::abs(u / slope - L) / 2 / dx, GetParam().slip);
  EXPECT_NEAR(stress / (1e-3 * slope), 1, 2e-2);
}

TEST_P(SlowWallKinds, KeepAHeadOfWaterOnOneSideOfAPlate) {
  auto s = started(pool(GetParam(), 0.1));
  double farthest = 0;
  for (int k = 0; s->time() < 0.5; ++k) {
    s->step();
    if (k % 50) continue;
    for (const Vec3d& x : vectors(s->snapshot("fluid"), "position")) farthest = std::max(farthest, x.x);
  }
  EXPECT_LT(farthest, 0.1);
  EXPECT_EQ(reading(s->diagnostics(), "lost_fluid_count"), 0);
}

/// A plate with water on both sides that sets off along x.
Config moving(const Config& still) {
  Config c = still;
  FluidFill beyond = c.fluid.fills[0];
  beyond.min.x = 0.2 - beyond.max.x + 0.01;
  beyond.max.x = 0.2;
  c.fluid.fills.push_back(beyond);
  c.wall.bodies[1].motion.kind = "oscillation";
  c.wall.bodies[1].motion.amplitude = {0.01, 0, 0};
  c.wall.bodies[1].motion.frequency = 5;
  return c;
}

TEST_P(SmallWallKinds, TakeWhatTheFluidGivesThemAsTheyMove) {  // T-17
  auto s = started(moving(pool(GetParam(), 0.06)));
  double largest = 0;
  for (int k = 0; k < 40; ++k) {
    s->step();
    if (k % 10 != 9) continue;
    const auto d = s->diagnostics();
    const double scale = std::abs(reading(d, "force_walls_on_fluid_z"));
    largest = std::max(largest, scale);
    for (const char* axis : {"x", "y", "z"})
      EXPECT_LT(std::abs(reading(d, std::string("fluid_force_residual_") + axis)) / scale, 20 * kInvariant)
          << axis;
  }
  EXPECT_GT(largest, 1);
}

TEST_P(SmallWallKinds, GoOnFromACheckpointBitForBit) {
  const Config c = moving(pool(GetParam(), 0.06));
  auto first = started(c);
  for (int k = 0; k < 30; ++k) first->step();
  std::vector<std::string> warnings;
  auto second = make_coupled(c, build_setup(c, warnings));
  second->load(first->save());
  for (int k = 0; k < 30; ++k) first->step(), second->step();
  EXPECT_EQ(bits(*first), bits(*second));
}

TEST_P(WallKinds, PushWaterAlong) {  // the plate sweeps what is before it, and nothing gets past it
  Config c = pool(GetParam(), 0.06);
  c.wall.bodies[1].motion.kind = "velocity";
  c.wall.bodies[1].motion.velocity = {-0.3, 0, 0};
  c.fluid.c = std::max(c.fluid.c, 10.0);
  auto s = started(c);
  double past = -1;
  while (s->time() < 0.1) {
    s->step();
    const double plate = 0.1 - 0.3 * s->time();
    if (s->steps() % 40 == 0)
      for (const Vec3d& x : vectors(s->snapshot("fluid"), "position")) past = std::max(past, x.x - plate);
  }
  EXPECT_LT(past, 0) << "m beyond the plate";
}

/// Speed of a slab of water under a lid, 30 mm thick, over that of free fall, after 0.1 s.
double fall_from_a_lid(const char* type, bool suction) {
  const double dx = 0.005;
  Config c = water(6, 0.2, dx);
  c.domain.periodic = {true, true, false};
  c.domain.min.z = -0.1, c.domain.max.z = 0.06;
  WallBody lid = test::body("box", {0, 0, 0.03}, {c.domain.max.x, c.domain.max.y, 0.06});
  lid.type = type;
  c.wall.bodies = {lid};
  c.wall.suction = suction;
  c.fluid.fills = {{{0, 0, 0}, {c.domain.max.x, c.domain.max.y, 0.03}}};
  auto s = started(c);
  run_until(*s, 0.1);
  double speed = 0;
  const auto v = vectors(s->snapshot("fluid"), "velocity");
  for (const Vec3d& each : v) speed -= each.z / double(v.size());
  return speed / (kG * s->time());
}

/// Fluid parts from walls as freely as from air; walls with suction hold it back.
TEST(WallSuction, IsWhatHoldsWaterUnderALid) {
  for (const char* type : {"adami", "mdbc"}) {
    EXPECT_NEAR(fall_from_a_lid(type, false), 1, 0.02) << type;
    EXPECT_LT(fall_from_a_lid(type, true), 0.93) << type;
  }
}

/// Two particles on either side of a thin plate, and two beyond its rim.
TEST(SmallThinWalls, CountPairsThatSeeEachOtherThroughThem) {
  Config c = water(20, 0.1, 0.01);
  c.domain.periodic = {false, false, false};
  const WallBody plate =
      of_kind(kKinds[3], test::body("box", {0.05, 0.05, 0.099}, {0.15, 0.15, 0.101}), "plate", c);
  c.wall.bodies = {plate};
  bedload::Setup setup;
  const auto add = [&](const Vec3d& x) {
    setup.fluid.x.push_back(x);
    setup.fluid.v.push_back({});
    setup.fluid.mass.push_back(1e-3);
  };
  for (double z : {0.09, 0.11}) add({0.1, 0.1, z}), add({0.165, 0.1, z});
  add({0.1, 0.1, 0.12});  // sees the lower one too, and the upper one freely
  EXPECT_EQ(reading(started(c, setup)->diagnostics(), "fluid_pairs_through_walls"), 1);
  setup.fluid.x[4].z = 0.1199;  // within reach of the lower one, 0.03 m
  setup.fluid.x[0].z = 0.0901;
  EXPECT_EQ(reading(started(c, setup)->diagnostics(), "fluid_pairs_through_walls"), 2);

  WallBody& riser = c.wall.bodies[0];  // comes to where the plate was
  riser.min.z -= 0.05, riser.max.z -= 0.05;
  riser.motion.kind = "velocity";
  riser.motion.velocity = {0, 0, 10};
  const auto s = started(c, setup);
  EXPECT_EQ(reading(s->diagnostics(), "fluid_pairs_through_walls"), 0);
  run_until(*s, 0.005);
  EXPECT_EQ(reading(s->diagnostics(), "fluid_pairs_through_walls"), 2);
}

}  // namespace
}  // namespace BL_SOLVER
