// What drives fluid and grains: by volume, mass and particle, over time and place.
#include "tests/boundaries/support.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// Grains of two sizes far apart in a periodic box, of glass and of steel.
const std::string kGrains = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [1, 1, 1]
periodic = [true, true, true]
[grain]
rho = 2500
[[grain.material]]
name = "steel"
rho = 7800
[[grain.fill]]
positions = [[0.25, 0.25, 0.25], [0.75, 0.75, 0.75]]
spins = [[1, 2, 3], [0, 0, 0]]
velocities = [[0, 0, 0.1], [0, 0, 0]]
[[grain.fill.sizes]]
d = 0.02
[[grain.fill]]
positions = [[0.25, 0.75, 0.25]]
material = "steel"
[[grain.fill.sizes]]
d = 0.04
[time]
end = 1
[out]
every = 1
[drive]
)";
double mass_of(double d, double rho) { return M_PI / 6 * d * d * d * rho; }

TEST(DriveSmall, GrainsByMassVolumeAndParticle) {
  const double small = mass_of(0.02, 2500), large = mass_of(0.04, 7800);
  const struct {
    std::string mode;
    double on_small, on_large;  // N per unit of drive.f
  } all[] = {{"mass", small, large}, {"volume", small / 2500, large / 7800}, {"particle", 1, 1}};
  for (const auto& [mode, on_small, on_large] : all) {
    auto s = started(kGrains + "on = \"grains\"\nf = [0.1, 0, 0]\nmode = \"" + mode + '"');
    for (int k = 0; k < 50; ++k) s->step();
    const auto v = vectors(s->snapshot("grains"), "velocity");
    EXPECT_NEAR(v[0].x / (0.1 * on_small / small * s->time()), 1, 1e-5) << mode;
    EXPECT_NEAR(v[2].x / (0.1 * on_large / large * s->time()), 1, 1e-5) << mode;
    EXPECT_NEAR(v[0].z, 0.1, 1e-7) << "velocities of single grains";
    EXPECT_EQ(vectors(s->snapshot("grains"), "angular_velocity")[0], (Vec3d{1, 2, 3}));
    EXPECT_NEAR(reading(*s, "grain_mass") / (2 * small + large), 1, 1e-6);
  }
}

TEST(DriveSmall, GrainsByFormulaInTimeAndPlace) {
  auto s = started(
      kGrains + "on = \"grains\"\nf = [2, 0, 0]\nmode = \"mass\"\nfactor = \"(x > 0.5 ? 2 : 1)*cos(3*t)\"");
  for (int k = 0; k < 200; ++k) s->step();
  const auto v = vectors(s->snapshot("grains"), "velocity");
  const double expected = 2.0 / 3 * std::sin(3 * s->time());
  EXPECT_NEAR(v[0].x / expected, 1, 2e-3);
  EXPECT_NEAR(v[1].x / expected, 2, 4e-3);
}

TEST(DriveSmall, OpposedReachesGrains) {
  auto s = started(kGrains + "on = \"grains\"\nf = [2, 0, 0]\nmode = \"mass\"\nopposed = \"z\"");
  for (int k = 0; k < 20; ++k) s->step();
  const auto v = vectors(s->snapshot("grains"), "velocity");
  EXPECT_GT(v[0].x, 0);
  EXPECT_EQ(v[1].x, -v[0].x);
}

/// Fluid in a periodic box of 8^3 particles of 1 g.
const std::string kFluid = R"(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.08, 0.08, 0.08]
periodic = [true, true, true]
[fluid]
dx = 0.01
vmax = 1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.08, 0.08, 0.08]
[time]
end = 1
[out]
every = 1
[drive]
)";

TEST(DriveSmall, FluidByParticleAndFormula) {
  auto s = started(kFluid + "f = [0.001, 0, 0]\nmode = \"particle\"");
  for (int k = 0; k < 50; ++k) s->step();
  EXPECT_NEAR(vectors(s->snapshot("fluid"), "velocity")[7].x / s->time(), 1, 1e-4);
  auto swings = started(kFluid + "f = [0, 5, 0]\nmode = \"mass\"\nfactor = \"cos(50*t)\"");
  for (int k = 0; k < 200; ++k) swings->step();
  EXPECT_NEAR(vectors(swings->snapshot("fluid"), "velocity")[7].y / (0.1 * std::sin(50 * swings->time())), 1,
              1e-3);
  auto shears = started(kFluid + "f = [5, 0, 0]\nmode = \"mass\"\nfactor = \"sin(2*pi*z/0.08)\"");
  for (int k = 0; k < 5; ++k) shears->step();
  const auto store = shears->snapshot("fluid");
  const auto x = vectors(store, "position"), v = vectors(store, "velocity");
  for (std::size_t a = 0; a < x.size(); ++a)
    ASSERT_NEAR(v[a].x, 5 * shears->time() * std::sin(2 * M_PI * x[a].z / 0.08), 1e-2 * 5 * shears->time());
}

TEST(Drive, BothPhasesShareAForcePerVolume) {
  // the mixture gains f times its volume, all of it on what it is made of
  const std::string case_text = kFluid + R"(on = "both"
f = [100, 0, 0]
[grain]
d = 0.01
[[grain.fill]]
positions = [[0.015, 0.015, 0.015], [0.045, 0.045, 0.045]]
)";
  std::string wide = case_text;
  for (auto at = wide.find("0.08"); at != wide.npos; at = wide.find("0.08", at)) wide.replace(at, 4, "0.12");
  const double grains = 2 * mass_of(0.01, 1);
  auto s = started(wide);
  for (int k = 0; k < 20; ++k) s->step();
  const double gained = reading(*s, "fluid_momentum_x") + reading(*s, "grain_momentum_x");
  const double fluid = reading(*s, "fluid_mass") / 1000;
  EXPECT_NEAR(gained / (100 * (fluid + grains) * s->time()), 1, 1e-3);
  EXPECT_NEAR(fluid + grains, 0.12 * 0.12 * 0.12, 1e-3 * 0.12 * 0.12 * 0.12);
}

TEST(Drive, FormulasGoOnAfterARestart) {
  const Config c = config_of(kFluid + "f = [5, 0, 0]\nmode = \"mass\"\nfactor = \"sin(2*pi*z/0.08 + 40*t)\"");
  auto s = started(c);
  for (int k = 0; k < 30; ++k) s->step();
  expect_restart_is_bit_equal(*s, c, 30);
}

}  // namespace
}  // namespace BL_SOLVER
