// Flows of fluid whose smoothing lengths follow the volume of its particles.

#include <cmath>
#include <fstream>

#include "tests/boundaries/support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace BL_SOLVER {
namespace {

/// Rows of particles in a plane 60 mm wide, 24 in the lowest and one less every other row: the spacing grows
/// from 2.5 to 5 mm. Returns their height, m.
double write_stretched_column(const std::filesystem::path& file) {
  std::ofstream out(file);
  out << "x [m],y [m],z [m],volume [m3]\n";
  double z = 0;
  for (int row = 0; row < 26; ++row) {
    const int n = 24 - row / 2;
    const double spacing = 0.06 / n;
    for (int k = 0; k < n; ++k)
      out << (k + 0.5) * spacing << ",0.005," << z + spacing / 2 << ',' << spacing * spacing * 0.01 << '\n';
    z += spacing;
  }
  return z;
}

/// Water at rest, twice as fine at the floor as at the surface.
TEST(VariableH, AColumnStretchedTwoToOneKeepsItsPressure) {
  test::TemporaryFolder folder;
  const auto file = folder.path() / "column.csv";
  const double depth = write_stretched_column(file);
  auto s = started(R"([domain]
min = [0, 0, -0.02]
max = [0.06, 0.01, 0.12]
periodic = [true, false, false]
two_d = true
[fluid]
dx = 0.0035
variable_h = true
[[fluid.fill]]
file = ")" + file.string() +
                   R"("
[visc]
alpha = 0.02
[wall]
dx = 0.0025
[[wall.body]]
name = "floor"
shape = "tank"
min = [0, 0, 0]
max = [0.06, 0.01, 0.12]
faces = ["z-"]
[time]
end = 1
[out]
every = 1
)");
  // rows that do not match settle, by hundredths of a spacing, and sound runs up and down since: 27 ms
  const std::size_t n = s->snapshot("fluid").count;
  std::vector<double> error(n), h;
  constexpr int instants = 54;
  for (int k = 0; k < instants; ++k) {
    run_until(*s, 0.1 + 0.002 * k);
    const HostStore fluid = s->snapshot("fluid");
    const auto x = vectors(fluid, "position");
    const auto p = scalars(fluid, "pressure");
    h = scalars(fluid, "smoothing_length");
    for (std::size_t a = 0; a < n; ++a) error[a] += (p[a] - 1000 * 9.81 * (depth - x[a].z)) / instants;
  }
  double worst = 0;
  for (const double e : error) worst = std::max(worst, std::abs(e));
  EXPECT_LT(worst, 0.02 * 1000 * 9.81 * depth);
  const auto [shortest, longest] = std::minmax_element(h.begin(), h.end());
  EXPECT_NEAR(*longest / *shortest, 24.0 / 12, 0.05);
}

/// A disc of liquid stretched to twice its length, flying freely.
TEST(VariableH, AnEllipticDropKeepsItsEnergy) {
  auto s = started(R"(gravity = [0, 0, 0]
[domain]
min = [-2.5, 0, -1.5]
max = [2.5, 0.08, 1.5]
two_d = true
[fluid]
dx = 0.08
vmax = 150
variable_h = true
[[shape]]
name = "drop"
kind = "cylinder"
a = [0, -0.1, 0]
b = [0, 0.2, 0]
radius = 1
[[fluid.fill]]
shape = "drop"
velocity = ["100*x", "0", "-100*z"]
[visc]
model = "none"
[time]
end = 1
[out]
every = 1
)");
  const auto energy = [&] {
    return reading(*s, "fluid_kinetic_energy") + reading(*s, "fluid_elastic_energy");
  };
  const double start = energy();
  double most = start, least = start;
  while (s->time() < 0.0076) {
    s->step();
    most = std::max(most, energy());
    least = std::min(least, energy());
  }
  EXPECT_LT(most, 1.01 * start);
  EXPECT_GT(least, 0.99 * start);
}

/// Water that falls into a dry bed, by all of the preset.
const std::string kBed = R"(preset = "robinson2014"
[domain]
min = [-0.1, -0.1, -0.1]
max = [0.2, 0.2, 0.2]
[fluid]
dx = 0.01
mu = 0.1
[[fluid.fill]]
min = [0.005, 0.005, 0.065]
max = [0.095, 0.095, 0.125]
velocity = [0, 0, -1]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.1, 0.15]
[contact]
k = 1000
[grain]
d = 0.01
fixed = true
[[grain.fill]]
min = [0.005, 0.005, 0.005]
max = [0.095, 0.095, 0.06]
count = 400
[time]
end = 1
[out]
every = 1
)";

TEST(SmallVariableHFlow, AmongGrainsLengthsGrowAndGoOnFromACheckpointBitForBit) {
  const Config config = config_of(kBed);
  auto s = started(config);
  for (int k = 0; k < 150; ++k) s->step();
  const HostStore fluid = s->snapshot("fluid");
  const auto porosity = scalars(fluid, "porosity"), h = scalars(fluid, "smoothing_length");
  double in_the_bed = 0, above = 0, number = 0;
  for (std::size_t a = 0; a < h.size(); ++a) {
    EXPECT_GT(h[a], 0.0145);
    if (porosity[a] > 0.99) above = std::max(above, h[a]);
    if (porosity[a] < 0.7) in_the_bed += h[a], ++number;
  }
  ASSERT_GT(number, 30);
  EXPECT_GT(in_the_bed / number, 0.015 / std::cbrt(0.7));
  EXPECT_LT(above, 0.0155);
  EXPECT_LT(std::abs(reading(*s, "fluid_force_residual_z")), 1e-4 * reading(*s, "fluid_mass") * 9.81);
  expect_restart_is_bit_equal(*s, config, 60);
}

}  // namespace
}  // namespace BL_SOLVER
