// Cases with fluid.model = "lattice" and grains as whole simulations.

#include "support.hpp"
#include "tests/boundaries/support.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// Two grains beside the ball.
const std::string kCell = "gravity = [0, 0, -0.01]\n" + kLidAndBall + R"case([contact]
normal = "linear"
k = 0.5
[grain]
d = 0.005
E = 1e5
[[grain.fill]]
positions = [[0.0029, 0.0061, 0.0057], [0.0138, 0.0058, 0.0064]]
)case";

Config cell(bool fixed) {
  Config c = config_of(kCell);
  c.grain.fixed = fixed;
  return c;
}

TEST(LatticeGrains, RestartAndRepeatToTheLastBit) {
  for (const bool fixed : {true, false}) {
    const Config config = cell(fixed);
    expect_same_on_any_number_of_threads(config, 90);
    for (const int begin : {34, 35}) {
      auto s = started(config);
      for (int k = 0; k < begin; ++k) s->step();
      expect_restart_is_bit_equal(*s, config, 50);
    }
  }
}

TEST(LatticeGrains, BooksOfMassAndMomentumClose) {
  for (const bool fixed : {true, false}) {
    auto s = started(cell(fixed));
    const double mass = reading(*s, "fluid_mass");
    const Vec3d from = vectors(s->snapshot("grains"), "position")[0];
    for (int k = 0; k < 320; ++k) s->step();  // the mass is restored in the last
    const auto rows = s->diagnostics();
    EXPECT_NEAR(reading(rows, "fluid_mass") / mass, 1, tolerance(1e-9, 1e-6, 1e-6));
    double exchanged = 0;
    for (const char* axis : {"x", "y", "z"})
      exchanged += std::abs(reading(rows, std::string("impulse_on_grains_") + axis)) +
                   std::abs(reading(rows, std::string("impulse_by_walls_") + axis));
    EXPECT_GT(exchanged, 0);
    const double moved = norm(vectors(s->snapshot("grains"), "position")[0] - from);
    for (const char* axis : {"x", "y", "z"})
      EXPECT_LT(std::abs(reading(rows, std::string("fluid_momentum_residual_") + axis)),
                tolerance(1e-11, 1e-5, 1e-5) * exchanged)
          << fixed;
    if (fixed)
      EXPECT_EQ(moved, 0);
    else
      EXPECT_GT(moved, 1e-4);
  }
}

/// A box full of fluid and colliding grains, where nothing else acts: what the fluid loses the grains have,
/// or it is owed to them, and that is little.
TEST(LatticeGrains, ShareAllMomentumWithTheFluid) {
  Config config = config_of(R"case(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.016, 0.016, 0.016]
periodic = [true, true, true]
[fluid]
model = "lattice"
dx = 0.001
mu = 0.005
vmax = 0.02
[contact]
normal = "linear"
k = 1
[grain]
d = 0.0066
E = 1e5
rho = 1500
[[grain.fill]]
positions = [[0.004, 0.0041, 0.0043], [0.0122, 0.0124, 0.0038], [0.0123, 0.0041, 0.012], [0.0039, 0.0118, 0.0123],
             [0.0081, 0.008, 0.0076], [0.0005, 0.0082, 0.0003]]
velocity = [0.01, 0.005, 0.004]
[[grain.fill]]
positions = [[0.0041, 0.0041, 0.0122]]
velocity = [-0.01, 0.008, -0.015]
[time]
end = 100
[out]
every = 1
)case");
  auto s = started(config);
  const auto momentum = [&](const std::vector<Quantity>& rows, const std::string& axis) {
    return reading(rows, "fluid_momentum_" + axis) + reading(rows, "grain_momentum_" + axis);
  };
  const auto from = s->diagnostics();
  const double scale = reading(from, "grain_mass") * 0.02;
  for (int k = 0; k < 400; ++k) s->step();
  const auto rows = s->diagnostics();
  double owed = 0;
  for (const std::string axis : {"x", "y", "z"}) {
    EXPECT_LT(std::abs(reading(rows, "fluid_momentum_residual_" + axis)),
              tolerance(1e-12, 1e-5, 1e-5) * scale)
        << axis;
    const double due = reading(rows, "impulse_owed_to_grains_" + axis);
    EXPECT_LT(std::abs(momentum(rows, axis) + due - momentum(from, axis)),
              tolerance(1e-12, 1e-5, 1e-5) * scale)
        << axis;
    owed += std::abs(due);
  }
  EXPECT_GT(owed, 1e-9 * scale);
  EXPECT_LT(owed, 0.05 * scale);
}

/// Nodes in a grain are solid; frames and diagnostics agree on the force.
TEST(LatticeGrains, FramesShowWhatGrainsCoverAndFeel) {
  auto s = started(cell(false));
  for (int k = 0; k < 100; ++k) s->step();
  const HostStore nodes = s->snapshot("fluid"), grains = s->snapshot("grains");
  const auto at = vectors(grains, "position"), force = vectors(grains, "fluid_force");
  const double* x = nodes.find("position")->as<double>();
  const auto* solid = nodes.find("solid")->as<std::uint32_t>();
  int covered = 0;
  for (std::size_t k = 0; k < nodes.count; ++k)
    for (const Vec3d& centre : at) {
      Vec3d d = Vec3d{x[3 * k], x[3 * k + 1], x[3 * k + 2]} - centre;
      d.x -= 0.016 * std::rint(d.x / 0.016);
      if (norm(d) > 0.0025 * (1 - 1e-6)) continue;
      EXPECT_EQ(solid[k], 1u);
      ++covered;
    }
  EXPECT_NEAR(covered, 2 * M_PI / 6 * 125, 12);
  EXPECT_NEAR(reading(*s, "force_fluid_on_grains_z") / (force[0] + force[1]).z, 1, 1e-5);
  EXPECT_EQ(vectors(grains, "fluid_torque").size(), 2u);
  EXPECT_EQ(s->counts().grains, 2);
}

/// A grain that settles in a periodic box, whose fluid is held back by as much: Stokes flow through a simple
/// cubic array [zick82].
TEST(LatticeGrains, SettleAtTheSpeedOfStokesFlow) {
  const double d = 0.01, n = 24, dx = 0.001, side = n * dx, R = d / 2, mu = 0.1,
               c = M_PI / 6 * std::pow(d / side, 3);
  const double weight = 4.0 / 3 * M_PI * R * R * R * 1000 * 0.01;  // of a density difference of 1000 kg/m3
  Config config = config_of(R"(gravity = [0, 0, -0.01]
[domain]
min = [0, 0, 0]
max = [0.024, 0.024, 0.024]
periodic = [true, true, true]
[fluid]
model = "lattice"
dx = 0.001
mu = 0.1
vmax = 0.005
[contact]
normal = "linear"
k = 10
[grain]
d = 0.01
rho = 2000
E = 1e5
[[grain.fill]]
positions = [[0.0121, 0.0123, 0.0117]]
[time]
end = 10
[out]
every = 1
)");
  config.drive.f = {0, 0, weight / (side * side * side * (1 - c))};
  auto s = started(config);
  for (int k = 0; k < 1500; ++k) s->step();
  double slip = 0;
  constexpr int window = 50;
  for (int k = 0; k < window; ++k) {
    for (int n = 0; n < 10; ++n) s->step();
    const auto rows = s->diagnostics();
    const double v = reading(rows, "grain_momentum_z") / reading(rows, "grain_mass"),
                 flow = reading(rows, "fluid_momentum_z") / (1000 * side * side * side) + c * v;
    slip += (v - flow) / window;
  }
  const double K = 1 / (1 - 1.7601 * std::cbrt(c) + c - 1.5593 * c * c);
  EXPECT_NEAR(slip * (1 - c) * 6 * M_PI * mu * R * K / -weight, 1, 0.02);
}

/// One that moves in a periodic box at rest, as light as it may be and heavier, leaves its momentum to the
/// fluid.
TEST(LatticeGrains, LightOnesComeToRest) {
  Config config = config_of(R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.016, 0.016, 0.016]
periodic = [true, true, true]
[fluid]
model = "lattice"
dx = 0.001
mu = 0.01
vmax = 0.02
[lattice]
tau = 0.6
[contact]
normal = "linear"
k = 1
[grain]
d = 0.006
E = 1e5
[[grain.fill]]
positions = [[0.0081, 0.0083, 0.0077]]
velocity = [0.01, 0.002, 0]
[time]
end = 100
[out]
every = 1
)");
  for (const double rho : {2000.0, 1000.0, 417.0}) {  // the last: R / dx times the ratio of densities is 1.25
    config.grain.rho = rho;
    auto s = started(config);
    double least = 1;
    for (int k = 0; k < 8; ++k) {
      for (int n = 0; n < 50; ++n) s->step();
      const double now = reading(*s, "grain_speed_max") / 0.0102;
      EXPECT_LT(now, std::max(1.2 * least, 0.1)) << rho << ' ' << k;  // 0.054 is left of the heaviest
      least = std::min(least, now);
    }
    EXPECT_LT(least, 0.1) << rho;
  }
}

TEST(LatticeGrains, FaultsWhereTheyMoveOverNodes) {
  Config config = cell(false);
  config.grain.fills[0].velocity = {0, 0, 0.1};
  auto s = started(config);
  try {
    s->step();
    FAIL() << "no fault";
  } catch (const SimulationFault& fault) {
    EXPECT_NE(std::string(fault.what()).find("nodes a step, above the 0.2"), std::string::npos)
        << fault.what();
  }
}

}  // namespace
}  // namespace BL_SOLVER
