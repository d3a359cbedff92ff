// A box of fluid on nodes whose images across z move along x, with grains that cross its sides.

#include "support.hpp"
#include "tests/boundaries/support.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kSide = 0.016, kRate = 1.5, kMu = 0.01;

const std::string kFluid = R"case(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.016, 0.012, 0.016]
periodic = [true, true, true]
shear_rate = 1.5
[fluid]
model = "lattice"
dx = 0.001
mu = 0.01
[[fluid.fill]]
min = [0, 0, 0]
max = [0.016, 0.012, 0.016]
velocity = ["1.5*(z-0.008)", "0", "0"]
[lattice]
mass_every = 40
[time]
end = 10
[out]
every = 1
)case";

/// Grains in pairs across the sheared sides, one of which leaves through them.
const std::string kGrains = kFluid + R"case([contact]
normal = "linear"
k = 0.5
[grain]
d = 0.0052
rho = 1500
[[grain.fill]]
positions = [[0.0043, 0.0061, 0.0007], [0.0041, 0.0058, 0.0116], [0.0121, 0.0064, 0.0075]]
velocity = [0.001, 0, -0.004]
)case";

TEST(ShearedLattice, HasALinearProfileAndItsStress) {
  auto s = started(kFluid);
  for (int k = 0; k < 600; ++k) s->step();
  const HostStore nodes = s->snapshot("fluid");
  EXPECT_EQ(nodes.count, 16u * 12u * 16u);
  const double* x = nodes.find("position")->as<double>();
  const auto v = vectors(nodes, "velocity");
  for (std::size_t k = 0; k < nodes.count; ++k) {
    EXPECT_NEAR(v[k].x, kRate * (x[3 * k + 2] - 0.008), 1e-4 * kRate * kSide);
    EXPECT_NEAR(v[k].z, 0, 1e-4 * kRate * kSide);
  }
  const HostStore fluid = s->rheology("fluid");
  constexpr int xz = 2;
  const double volume = kSide * kSide * 0.012;
  EXPECT_NEAR(-(total(fluid, "friction", xz) + total(fluid, "kinetic", xz)) / volume / (kMu * kRate), 1,
              1e-3);
}

TEST(ShearedLattice, BooksOfMassAndMomentumClose) {
  for (const bool grains : {false, true}) {
    auto s = started(grains ? kGrains : kFluid);
    const double mass = reading(*s, "fluid_mass");
    for (int k = 0; k < 320; ++k) s->step();  // the mass is restored in the last
    const auto rows = s->diagnostics();
    EXPECT_NEAR(reading(rows, "fluid_mass") / mass, 1, tolerance(1e-9, 1e-6, 1e-6));
    // forces on grains, which at first move against the fluid, leave hardly any sum
    const double exchanged =
        grains ? reading(rows, "grain_mass") * kRate * kSide / 2 : 1e-3 * mass * kRate * kSide;
    for (const char* axis : {"x", "y", "z"})
      EXPECT_LT(std::abs(reading(rows, std::string("fluid_momentum_residual_") + axis)),
                tolerance(1e-9, 1e-3, 1e-3) * exchanged)
          << grains << axis;
  }
}

/// Sides are no special place: a grain that lies across them spins and strains the fluid as one in the
/// middle.
TEST(ShearedLattice, GrainsAtItsSidesFeelWhatTheyDoInTheMiddle) {
  struct Found {
    double spin = 0, stresslet = 0;
  };
  const auto of = [](double z) {
    Config c = config_of(kGrains);
    c.grain.fills[0].positions = {{0.0083, 0.0061, z}};
    c.grain.fills[0].velocity = {kRate * (z - 0.008), 0, 0};
    auto s = started(c);
    Found mean;
    constexpr int begin = 250, end = 350;  // forces vary with the place among nodes
    for (int k = 0; k < end; ++k) {
      s->step();
      if (k < begin) continue;
      mean.spin += vectors(s->snapshot("grains"), "angular_velocity")[0].y / (end - begin);
      mean.stresslet += total(s->rheology("grains"), "particles", 2) / (end - begin);
    }
    return mean;
  };
  const Found middle = of(0.0083), side = of(0.0003);
  EXPECT_NEAR(middle.spin / (kRate / 2), 1, 0.15);
  EXPECT_NEAR(side.spin / middle.spin, 1, 0.02);
  EXPECT_NEAR(side.stresslet / middle.stresslet, 1, 0.02);
  EXPECT_LT(middle.stresslet, 0) << "it adds to the shear stress";
}

TEST(ShearedLattice, RestartsAndRepeatsToTheLastBit) {
  const Config config = config_of(kGrains);
  expect_same_on_any_number_of_threads(config, 90);
  for (const int begin : {34, 35}) {
    auto s = started(config);
    for (int k = 0; k < begin; ++k) s->step();
    expect_restart_is_bit_equal(*s, config, 60);
  }
}

}  // namespace
}  // namespace BL_SOLVER
