// Stress of fluid on nodes with grains in it, against the force on plates.

#include "support.hpp"
#include "tests/boundaries/support.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kSide = 0.012;

/// Grains between plates that move against each other.
const std::string kSheared = R"case(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.012, 0.012, 0.012]
periodic = [true, true, false]
[fluid]
model = "lattice"
dx = 0.001
mu = 0.01
[[wall.body]]
name = "lower"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
surface_velocity = [-0.01, 0, 0]
[[wall.body]]
name = "upper"
shape = "plane"
point = [0, 0, 0.012]
normal = [0, 0, -1]
surface_velocity = [0.01, 0, 0]
[grain]
d = 0.0052
fixed = true
[[grain.fill]]
positions = [[0.0063, 0.0058, 0.0047]]
[time]
end = 10
[out]
every = 1
)case";

/// In steady flow momentum that crosses the suspension is what the plates have, and what holds the grain.
TEST(LatticeRheology, StressOfFluidAndGrainsIsThatOnThePlates) {
  auto s = started(kSheared);
  for (int k = 0; k < 3000; ++k) s->step();
  const HostStore fluid = s->rheology("fluid"), grains = s->rheology("grains");
  const double on_upper = reading(s->body_state(1), "force_by_fluid_x");
  const Vec3d held = vectors(s->snapshot("grains"), "fluid_force")[0];
  double inside = 0;
  constexpr int xz = 2;
  for (const char* part : {"pressure", "friction", "kinetic"}) inside += total(fluid, part, xz);
  const double stresslet = total(grains, "particles", xz);
  const double expected = on_upper * kSide + held.x * 0.0047;
  EXPECT_NEAR((inside + stresslet) / expected, 1, tolerance(1e-3, 2e-3, 2e-3));
  EXPECT_GT(stresslet / expected, 0.05) << "a grain adds to the stress";

  double volume = 0, mass = 0;
  for (std::size_t k = 0; k < fluid.count; ++k)
    volume += fluid.find("volume")->as<double>()[k], mass += fluid.find("mass")->as<double>()[k];
  EXPECT_NEAR(volume / (kSide * kSide * kSide), 1, 1e-9);
  EXPECT_NEAR(mass / reading(*s, "fluid_mass"), 1, 1e-5) << "what links bring in a step";
}

/// Looking at the stress does not change the run.
TEST(LatticeRheology, LeavesTheFlowAsItIs) {
  const Config config = config_of(kSheared);
  auto one = started(config), two = started(config);
  for (int k = 0; k < 40; ++k) {
    one->step();
    two->step();
    two->rheology("fluid");
  }
  one->step();
  two->step();
  EXPECT_EQ(reading(*one, "fluid_kinetic_energy"), reading(*two, "fluid_kinetic_energy"));
  EXPECT_EQ(reading(one->body_state(1), "force_by_fluid_x"), reading(two->body_state(1), "force_by_fluid_x"));
}

}  // namespace
}  // namespace BL_SOLVER
