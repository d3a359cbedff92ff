// Cases with fluid.model = "lattice" as whole simulations.

#include "support.hpp"
#include "tests/boundaries/support.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

const std::string kCavity = "gravity = [0, 0, 0]\n" + kLidAndBall + R"case(factor = "1 + 0.5*sin(3*t)"
[[probe]]
name = "lid"
type = "force"
body = "lid"
[[probe]]
name = "core"
type = "point"
at = [0.002, 0.006, 0.006]
[[probe]]
name = "upper"
type = "box"
min = [0, 0, 0.006]
max = [0.016, 0.012, 0.012]
)case";

TEST(LatticeSimulation, BooksOfMomentumAndMassClose) {
  auto s = started(kCavity);
  const double mass = reading(*s, "fluid_mass");
  for (int k = 0; k < 320; ++k) s->step();  // the mass is restored in the last
  const auto rows = s->diagnostics();
  const double exchanged =
      std::abs(reading(rows, "impulse_by_walls_y")) + std::abs(reading(rows, "impulse_by_forces_y"));
  EXPECT_GT(exchanged, 0);
  for (const char* axis : {"x", "y", "z"})
    EXPECT_LT(std::abs(reading(rows, std::string("fluid_momentum_residual_") + axis)),
              tolerance(1e-11, 1e-5, 1e-5) * exchanged);
  EXPECT_NEAR(reading(rows, "fluid_mass") / mass, 1, tolerance(1e-9, 1e-6, 1e-6));
  EXPECT_GT(reading(rows, "fluid_speed_max"), 0.002);
  EXPECT_LT(reading(rows, "fluid_speed_max"), 0.0101);
}

TEST(LatticeSimulation, RestartsAndRepeatsToTheLastBit) {
  const Config config = config_of(kCavity);
  expect_same_on_any_number_of_threads(config, 70);
  for (const int begin : {34, 35}) {
    auto s = started(config);
    for (int k = 0; k < begin; ++k) s->step();
    s->begin_interval(config.out.probes[0]);
    s->step();
    expect_restart_is_bit_equal(*s, config, 50);
  }
}

TEST(LatticeSimulation, ProbesReadWhatDiagnosticsAndFramesShow) {
  const Config config = config_of(kCavity);
  auto s = started(config);
  for (int k = 0; k < 40; ++k) s->step();
  const std::vector<ProbeConfig>& probes = config.out.probes;
  ProbeConfig now = probes[0];
  now.sample = ForceSample::instant;
  const auto force = s->measure(now);
  const auto body = s->body_state(1);
  EXPECT_EQ(reading(force, "force_by_fluid_x"), reading(body, "force_by_fluid_x"));

  // the mean force is the impulse over the time
  s->begin_interval(probes[0]);
  const double from = s->time();
  double sum = 0;
  for (int k = 0; k < 25; ++k) {
    s->step();
    sum += reading(s->measure(now), "force_by_fluid_x");
  }
  EXPECT_NEAR(reading(s->measure(probes[0]), "force_by_fluid_x") / (sum / 25), 1, 1e-6);
  EXPECT_LT(sum, 0) << "the fluid drags at the lid";
  EXPECT_GT(s->time(), from);

  // frames: nodes at cell centres, solid in the ball
  const HostStore frame = s->snapshot("fluid");
  ASSERT_TRUE(frame.grid);
  EXPECT_EQ(frame.grid->count, (std::array<std::size_t, 3>{16, 12, 12}));
  EXPECT_EQ(frame.count, 16u * 12u * 12u);
  double fluid = 0;
  const double* x = frame.find("position")->as<double>();
  const auto* solid = frame.find("solid")->as<std::uint32_t>();
  for (std::size_t k = 0; k < frame.count; ++k) {
    const Vec3d at{x[3 * k], x[3 * k + 1], x[3 * k + 2]};
    EXPECT_EQ(solid[k] == 1, norm(at - Vec3d{0.0083, 0.0061, 0.0057}) < 0.0028);
    fluid += solid[k] == 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cells = at[axis] / 0.001 - 0.5;
      EXPECT_NEAR(cells, std::rint(cells), 1e-6);
    }
  }
  EXPECT_EQ(fluid, reading(*s, "fluid_count"));
  const auto point = s->measure(probes[1]);
  EXPECT_NEAR(reading(point, "kernel_sum"), 1, 1e-9);
  EXPECT_GT(std::abs(reading(point, "velocity_x")), 0);
  const auto box = s->measure(probes[2]);
  EXPECT_GT(reading(box, "velocity_x"), 0) << "dragged by the lid";
  EXPECT_LT(reading(box, "count"), reading(*s, "fluid_count"));
}

/// Rest under its own weight: hydrostatic from the start.
TEST(LatticeSimulation, WeightIsHeldByTheFloor) {
  auto s = started(R"(gravity = [0, 0, -9.81]
[domain]
min = [0, 0, 0]
max = [0.004, 0.004, 0.02]
periodic = [true, true, false]
[fluid]
model = "lattice"
dx = 0.001
mu = 0.01
vmax = 0.05
[[wall.body]]
name = "floor"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
[[wall.body]]
name = "lid"
shape = "plane"
point = [0, 0, 0.02]
normal = [0, 0, -1]
[time]
end = 1
[out]
every = 1
)");
  for (int k = 0; k < 400; ++k) s->step();
  const auto rows = s->diagnostics();
  EXPECT_NEAR(reading(rows, "force_walls_on_fluid_z") / (1000 * 9.81 * 0.004 * 0.004 * 0.02), 1, 0.01);
  EXPECT_LT(reading(rows, "fluid_speed_max"), 2e-4);
  const double head = reading(rows, "pressure_max") - reading(rows, "pressure_min");
  EXPECT_NEAR(head / (1000 * 9.81 * 0.019), 1, 0.01);
}

TEST(LatticeSimulation, FaultNamesTheFastestPlace) {
  Config config = config_of(kCavity);
  config.wall.bodies[1].surface_velocity = {0.2, 0, 0};  // far above vmax, from which the step follows
  auto s = started(config);
  try {
    for (int k = 0; k < 200; ++k) s->step();
    FAIL() << "no fault";
  } catch (const SimulationFault& fault) {
    const std::string text = fault.what();
    EXPECT_NE(text.find("nodes a step"), std::string::npos) << text;
    EXPECT_NE(text.find("increase fluid.vmax"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace BL_SOLVER
