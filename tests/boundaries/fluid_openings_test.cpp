// Fluid that comes in through orifices and leaves through outlets.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>

#include "kernels/boundaries/insert.hpp"
#include "kernels/fluid/wall_repulsion.hpp"
#include "tests/boundaries/support.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// A duct without walls, periodic across, 8 x 8 particles wide; inlet at x = 0, outlet from x = 0.2 on.
const std::string kDuct = R"(gravity = [0, 0, 0]
[domain]
min = [-0.06, 0, 0]
max = [0.3, 0.08, 0.08]
periodic = [false, true, true]
[fluid]
dx = 0.01
vmax = 1
[[inlet]]
name = "feed"
shape = "rectangle"
centre = [0, 0.04, 0.04]
direction = [1, 0, 0]
half_a = [0, 0.04, 0]
half_b = [0, 0, 0.04]
rate = 0.0032
[[outlet]]
name = "end"
shape = "plane"
point = [0.2, 0, 0]
normal = [1, 0, 0]
[time]
end = 1
[out]
every = 1
)";
const std::string kFull = R"(
[[fluid.fill]]
min = [0, 0, 0]
max = [0.2, 0.08, 0.08]
)";
constexpr double kRate = 0.0032, kSpeed = 0.5, kLayer = 64 * 1e-3;  // m3/s, m/s, kg

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == text.npos) throw std::logic_error("no '" + from + "' in the case");
  return text.replace(at, from.size(), to);
}

/// Layers are let in when they have come through whole: what is under way makes up the difference.
void expect_mass_balance(Simulation& s, double initial) {
  const auto d = s.diagnostics();
  const double volume = reading(d, "inlet_feed_volume"), in = reading(d, "inlet_feed_mass");
  const double layers = std::floor(1000 * volume / kLayer + 0.5);
  // the layer that came through in the last step is fluid from the next one on
  EXPECT_LE(std::abs(in / kLayer - layers), std::fmod(1000 * volume / kLayer + 0.5, 1) < 0.02 ? 1 : 1e-9);
  EXPECT_NEAR(initial + in,
              reading(d, "fluid_mass") + reading(d, "outlet_end_fluid_mass") + reading(d, "lost_fluid_mass"),
              tolerance(1e-9, 1e-6, 1e-6) * (initial + in));
}

TEST(Admit, TakesOverThePressureOfTheBuffer) {
  const EquationOfState eos{Real(1e5), 7, 0, 1000, false};
  const Frame frame({0, 0, 0}, {1, 1, 1}, false, false, false);
  const Real p = 3e4, superficial = 800;
  std::vector<Id> wall_id{7}, id(1);
  std::vector<Index> layer{0};
  std::vector<Vec3d> wall_x{{0.5, 0.5, 0.5}};
  std::vector<VelocityDensity<>> wall_v{{Real3(1, 0, 0), superficial}};
  std::vector<WallState<>> wall_state{{.mass = 1, .p_over_rho2 = p / square(superficial), .rho = 1000}};
  std::vector<FluidPosition> x(1);
  std::vector<VelocityDensity<>> v_rho(1), flux(1);
  std::vector<EosState<>> state(1);
  std::vector<Real> s(1), mass(1), eps(1), solid_factor(1);
  std::vector<Real3> stress(1), acc(1);
  const auto span = [](auto& host) { return Span(host.data(), Index(host.size())); };
  const InsertPass pass{.frame = frame,
                        .eos = eos,
                        .first = 7,
                        .place = 0,
                        .id = 3,
                        .mass = Real(0.5),
                        .acc = Real3(),
                        .gravity = Real3(0, 0, Real(-9.81)),
                        .layer = span(layer),
                        .wall_id = span(wall_id),
                        .wall_x = span(wall_x),
                        .wall_v_rho = span(wall_v),
                        .wall_state = span(wall_state),
                        .fluid_id = span(id),
                        .x = span(x),
                        .v_rho = span(v_rho),
                        .flux = span(flux),
                        .eos_state = span(state),
                        .compression = span(s),
                        .fluid_mass = span(mass),
                        .eps = span(eps),
                        .solid_factor = span(solid_factor),
                        .out = {span(stress), span(acc)}};
  pass(0);
  EXPECT_EQ(id[0], 3u);
  EXPECT_NEAR(eos.pressure(s[0]), p, tolerance(1e-12, 1e-5, 1e-5) * p);
  EXPECT_EQ(v_rho[0].rho, Real(1000) * (1 + s[0]));
  EXPECT_EQ(eps[0], 1) << "no grains in an orifice";
  EXPECT_EQ(state[0].mass_over_eps, Real(0.5));
  EXPECT_EQ(state[0].p_over_rho2, eos.pressure(s[0]) / square(v_rho[0].rho));
  EXPECT_EQ(state[0].rho, v_rho[0].rho);
  EXPECT_EQ(state[0].eps, 1);
  EXPECT_EQ(flux[0].v, v_rho[0].v);
  EXPECT_EQ(flux[0].rho, v_rho[0].rho);
  wall_state[0].mass = 0;  // no fluid ahead
  pass(0);
  EXPECT_EQ(s[0], 0);
}

TEST(Inlet, LetsInTheVolumeOfItsRate) {  // T-42
  auto s = started(with(kDuct, "rate = 0.0032", "rate = 0.0032\nfactor = \"1+0.5*sin(40*t)\"\nramp = 0.02"));
  run_until(*s, 0.25);
  const double t = s->time();
  // the ramp lasts from 0 to 0.02 s: sums of many small intervals
  double volume = 0;
  const int n = 200000;
  for (int k = 0; k < n; ++k) {
    const double at = (k + 0.5) * t / n, q = std::min(1.0, at / 0.02);
    volume += kRate * q * q * (3 - 2 * q) * (1 + 0.5 * std::sin(40 * at)) * t / n;
  }
  EXPECT_NEAR(reading(*s, "inlet_feed_volume") / volume, 1, 1e-9);
  EXPECT_GT(reading(*s, "inlet_feed_mass"), 8 * kLayer);
  expect_mass_balance(*s, 0);
}

TEST(Inlet, ConstantRateIsExact) {  // T-42
  auto s = started(kDuct);
  run_until(*s, 0.2);
  const double ramp = 10 * 0.015 / 10;
  EXPECT_NEAR(reading(*s, "inlet_feed_volume") / (kRate * (s->time() - ramp / 2)), 1, 1e-9);
  expect_mass_balance(*s, 0);
}

TEST(Inlet, StopsWhenToldTo) {
  auto s = started(with(kDuct, "rate = 0.0032", "velocity = 0.5\nstart = 0.02\nstop = 0.1"));
  run_until(*s, 0.2);
  // closing takes as long as opening
  EXPECT_NEAR(reading(*s, "inlet_feed_volume") / (kRate * 0.08), 1, 1e-9);
  expect_mass_balance(*s, 0);
}

/// The flow runs from the first, so that there are no waves but those of layers coming in and going out.
void expect_steady_flow(const std::string& more, double most) {
  auto s = started(with(kDuct, "rate = 0.0032", "rate = 0.0032\nramp = 1e-6") + kFull +
                   "velocity = [0.5, 0, 0]\n" + more);
  const double dynamic =
      1000 * kSpeed * kSpeed;  // rho u^2; a layer that stopped would raise rho u c, 20 times that
  run_until(*s, 0.1);          // the opening, at once, has died down
  double highest = 0, lowest = 0;
  while (s->time() < 0.4) {
    s->step();
    highest = std::max(highest, reading(*s, "pressure_max"));
    lowest = std::min(lowest, reading(*s, "pressure_min"));
  }
  EXPECT_LT(highest, most * dynamic);
  EXPECT_GT(lowest, -most * dynamic);
  const double out = reading(*s, "outlet_end_fluid_mass"), from = s->time();
  run_until(*s, 0.8);  // 20 layers
  const double flux = (reading(*s, "outlet_end_fluid_mass") - out) / (s->time() - from);
  EXPECT_NEAR(flux / (1000 * kRate), 1, 0.05);
  expect_mass_balance(*s, 1.28);
  const auto ids = ids_of(s->snapshot("fluid"));
  EXPECT_EQ(std::set<Id>(ids.begin(), ids.end()).size(), ids.size());
  EXPECT_GT(*std::max_element(ids.begin(), ids.end()), 1280u + 64 * 38);
}

/// The inlet pulls as walls do: without suction its noise is 0.51 rho u^2, with it below half.
TEST(Inlet, FeedsASteadyFlowWithoutPressureSpikes) {
  expect_steady_flow("", 0.55);
  expect_steady_flow("[wall]\nsuction = true\n", 0.5);
}

TEST(Inlet, FlowRunsOnUniformly) {
  auto s = started(kDuct + kFull);
  run_until(*s, 0.5);
  const HostStore fluid = s->snapshot("fluid");
  const auto* v = fluid.find("velocity")->as<Real>();
  double worst = 0;
  for (std::size_t a = 0; a < fluid.count; ++a) worst = std::max(worst, std::abs(v[3 * a] / kSpeed - 1));
  EXPECT_LT(worst, 0.05);
}

TEST(Inlet, GoesOnBitForBitAfterARestart) {
  const Config config = config_of(kDuct + kFull);
  auto s = started(config);
  run_until(*s, 0.06);
  ASSERT_GT(reading(*s, "inlet_feed_mass"), 0);
  ASSERT_GT(reading(*s, "outlet_end_fluid_count"), 0);
  expect_restart_is_bit_equal(*s, config, 150);
}

/// Fluid gives way to the grains on its way from the orifice: no pressure builds up there.
TEST(Inlet, FeedsFluidAmongGrains) {
  const Config config = config_of(kDuct + kFull + R"(velocity = [0.5, 0, 0]
[grain]
d = 0.008
E = 1e6
[[grain.fill]]
min = [0, 0, 0]
max = [0.1, 0.08, 0.08]
packing_fraction = 0.2
velocity = [0.5, 0, 0]
)");
  auto s = started(config);
  const double initial = reading(*s, "fluid_mass");
  EXPECT_LT(initial, 0.92 * 1.28);
  double highest = 0;
  while (s->time() < 0.15) {
    s->step();
    if (s->time() > 0.05) highest = std::max(highest, reading(*s, "pressure_max"));
  }
  EXPECT_LT(highest, 0.5 * 1000 * kSpeed * 10);  // half of rho u c: the flow is set going within 15 ms
  EXPECT_GT(reading(*s, "inlet_feed_mass"), 5 * kLayer);
  EXPECT_GT(reading(*s, "outlet_end_fluid_count"), 0);
  expect_mass_balance(*s, initial);
  expect_restart_is_bit_equal(*s, config, 100);
}

TEST(Inlet, GoesOnBitForBitWithABodyAmongGrains) {
  const Config config = config_of(kDuct + R"(
[[shape]]
name = "duct"
kind = "box"
min = [0, 0, 0]
max = [0.2, 0.08, 0.08]
[[shape]]
name = "block"
kind = "box"
min = [0.06, 0.02, 0.02]
max = [0.1, 0.06, 0.06]
[[shape]]
name = "water"
kind = "difference"
of = ["duct", "block"]
[[fluid.fill]]
shape = "water"
velocity = [0.5, 0, 0]
[grain]
d = 0.008
E = 1e6
[[grain.fill]]
min = [0, 0, 0]
max = [0.04, 0.08, 0.08]
packing_fraction = 0.2
velocity = [0.5, 0, 0]
[[grain_inlet]]
name = "sand"
shape = "disc"
centre = [0.01, 0.04, 0.04]
direction = [1, 0, 0]
radius = 0.02
rate = 0.2
velocity = [0.5, 0, 0]
[[wall.body]]
name = "block"
shape = "block"
[wall.body.free]
density = 800
velocity = [0.3, 0, 0.1]
)");
  auto s = started(config);
  run_until(*s, 0.05);
  ASSERT_GT(reading(*s, "inlet_feed_mass"), 0);
  const auto block = s->body_state(0);
  ASSERT_GT(std::abs(reading(block, "force_by_grains_x")) + std::abs(reading(block, "angular_velocity_y")),
            0);
  expect_restart_is_bit_equal(*s, config, 100);
}

/// Water let in from below stands as high among grains as their voids ask for.
TEST(Inlet, LetsGoGentlyOfWhatFallsAmongItsLayers) {
  Orifice disc{};
  disc.direction = {0, 0, 1};
  disc.disc = true;
  disc.half[0] = 1;
  disc.behind = 0.5;
  BodyPose layers;
  layers.translation = {0, 0, 0.2};  // the foremost is at -0.3
  layers.v = {0, 0, 2};
  const Repulsion law{10, 0.5, 1e9};
  const Frame frame({-2, -2, -2}, {2, 2, 2}, false, false, false);
  const OrificeRepulsion push{law, 0.1, 100, frame, {&disc, 1}, {&layers, 1}};
  const auto along = [&](double x, double ahead, double v) {
    const Real3 a = push({x, 0, -0.3 + ahead}, {5, 0, Real(v)});
    EXPECT_EQ(a.x, 0);
    EXPECT_EQ(a.y, 0);
    return double(a.z);
  };
  EXPECT_NEAR(along(0, 0.48, 0), double(law(Real(0.48))), 1e-3) << "where there is time, the law of walls";
  for (const double ahead : {0.1, 0.0, -0.9})
    EXPECT_NEAR(along(0.9, ahead, 2), 10, 1e-3) << "0.1 m/s ahead of the layers in one step";
  EXPECT_NEAR(along(0, 0, 1), 110, 1e-3);
  for (const auto& [x, ahead, v] :
       {std::array{0.0, 0.0, 2.2}, {0.0, 0.5, 0.0}, {0.0, -1.1, 0.0}, {1.1, 0.0, 0.0}})
    EXPECT_EQ(along(x, ahead, v), 0) << x << " " << ahead << " " << v;
}

constexpr double kBedWidth = 0.08;  // m

/// Box of a floor, from the corner (x0, y0) to (x1, y1), m.
std::string plate(const char* name, double x0, double y0, double x1, double y1) {
  std::ostringstream text;
  text << "[[wall.body]]\nname = \"" << name << "\"\nshape = \"box\"\nmin = [" << x0 << ", " << y0
       << ", -0.06]\nmax = [" << x1 << ", " << y1 << ", 0]\n";
  return text.str();
}

/// Bed of fixed grains in a tank of 0.08 m x 0.08 m; water comes in from below, through a square of that side
/// (m), until 0.6 s. `walls`: the rest of the floor.
std::string dry_bed(double side, const std::string& walls) {
  const std::string half = std::to_string(side / 2);
  return R"([domain]
min = [-0.02, -0.02, -0.06]
max = [0.1, 0.1, 0.16]
[fluid]
dx = 0.01
vmax = 1.8
[[inlet]]
name = "feed"
shape = "rectangle"
centre = [0.04, 0.04, 0]
direction = [0, 0, 1]
half_a = [)" +
         half + R"(, 0, 0]
half_b = [0, )" +
         half + R"(, 0]
rate = 5.12e-4
stop = 0.6
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, -0.06]
max = [0.08, 0.08, 0.16]
faces = ["x-", "x+", "y-", "y+"]
)" + walls +
         R"([grain]
d = 0.012
fixed = true
[[grain.fill]]
min = [0, 0, 0]
max = [0.08, 0.08, 0.16]
packing_fraction = 0.4
[time]
end = 2
[out]
every = 1
)";
}

TEST(Inlet, IsAFloorForTheWaterThatStandsOnIt) {
  auto s = started(dry_bed(kBedWidth, ""));
  double deepest = 0;
  for (int k = 1; k <= 5; ++k) {
    run_until(*s, 0.2 * k);
    for (const Vec3d& x : vectors(s->snapshot("fluid"), "position")) deepest = std::min(deepest, x.z);
  }
  EXPECT_EQ(reading(*s, "fluid_count"), 320);
  EXPECT_GT(deepest, -0.5 * 0.01) << "the foremost layer stops within a spacing of the orifice";
}

TEST(Inlet, FillsTheVoidsOfADryBed) {
  const double volume = 0.6 * kBedWidth * kBedWidth * kBedWidth;
  auto s =
      started(dry_bed(0.04, plate("left", 0, 0, 0.02, 0.08) + plate("right", 0.06, 0, 0.08, 0.08) +
                                plate("front", 0.02, 0, 0.06, 0.02) + plate("back", 0.02, 0.06, 0.06, 0.08)));
  run_until(*s, 0.9);
  EXPECT_NEAR(reading(*s, "inlet_feed_mass"), 1000 * volume, 0.016);
  EXPECT_EQ(reading(*s, "lost_fluid_count"), 0);
  const HostStore fluid = s->snapshot("fluid");
  const auto x = vectors(fluid, "position");
  const auto eps = scalars(fluid, "porosity");
  double bulk = 0, moment = 0;  // of the bed that is wet, m3, m4
  for (std::size_t a = 0; a < x.size(); ++a) {
    bulk += 1e-6 / eps[a];
    moment += 1e-6 / eps[a] * x[a].z;
  }
  EXPECT_GT(bulk / volume, 1.3) << "void fraction 0.6, more beside the orifice";
  EXPECT_NEAR(2 * moment / bulk / (bulk / (kBedWidth * kBedWidth)), 1, 0.06)
      << "level; 0.9 if it came in as dense as in the bed";
}

TEST(Inlet, RoundJetIntoAnEmptyTank) {
  auto s = started(R"([domain]
min = [-0.04, 0, 0]
max = [0.2, 0.1, 0.1]
[fluid]
dx = 0.005
[[inlet]]
name = "feed"
centre = [0, 0.05, 0.08]
direction = [1, 0, 0]
radius = 0.0125
velocity = 1
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.2, 0.1, 0.1]
faces = ["x+", "y-", "y+", "z-"]
[time]
end = 1
[out]
every = 1
)");
  run_until(*s, 0.2);
  const auto d = s->diagnostics();
  EXPECT_NEAR(reading(d, "inlet_feed_volume") / (0.2 * 3.14159 * 0.0125 * 0.0125), 1, 0.1);
  EXPECT_GE(reading(d, "fluid_count"), 20 * 35);
  // falls 0.08 m, no faster than its head allows
  EXPECT_LT(reading(d, "fluid_speed_max"), 2.2);
}

TEST(Outlet, TakesFluidFromABoxAndAShape) {
  auto s = started(R"([domain]
min = [0, 0, 0]
max = [0.2, 0.08, 0.2]
periodic = [false, true, false]
[fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0.1]
max = [0.2, 0.08, 0.15]
[[shape]]
name = "drain"
kind = "cylinder"
a = [0.15, -0.1, 0.0]
b = [0.15, 0.2, 0.0]
radius = 0.06
[[outlet]]
name = "left"
min = [0, 0, 0]
max = [0.1, 0.08, 0.05]
[[outlet]]
name = "right"
shape = "drain"
phase = "fluid"
[time]
end = 1
[out]
every = 1
)");
  const double initial = reading(*s, "fluid_mass");
  run_until(*s, 0.3);
  const auto d = s->diagnostics();
  const double left = reading(d, "outlet_left_fluid_mass"), right = reading(d, "outlet_right_fluid_mass");
  EXPECT_GT(left, 0.4 * initial);
  EXPECT_GT(right, 0.4 * initial);
  EXPECT_NEAR(left + right + reading(d, "lost_fluid_mass") + reading(d, "fluid_mass"), initial,
              1e-6 * initial);
  EXPECT_EQ(reading(d, "outlet_left_fluid_count") + reading(d, "outlet_right_fluid_count") +
                reading(d, "lost_fluid_count") + reading(d, "fluid_count"),
            20 * 8 * 5);
}

}  // namespace
}  // namespace BL_SOLVER
