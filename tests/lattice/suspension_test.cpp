// Viscosity of a suspension of resolved spheres in simple shear: a small case of suspension_viscosity.

#include "tests/boundaries/support.hpp"

namespace BL_SOLVER {
namespace {

const std::string kSuspension = R"case(gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.0024, 0.0024, 0.0024]
periodic = [true, true, true]
shear_rate = 15
[fluid]
model = "lattice"
dx = 1e-4
mu = 0.1
[lattice]
tau_max = 1.5
[contact]
normal = "linear"
k = 4
[grain]
d = 8e-4
rho = 1000
mu = 0
mu_r = 0
E = 1e6
[[grain.fill]]
min = [0, 0, 0]
max = [0.0024, 0.0024, 0.0024]
packing_fraction = 0.1
[lubrication]
forces = "all"
least_gap = 0.02
[time]
end = 1
[out]
every = 1
)case";

double shear_stress(const HostStore& store) {
  double sum = 0;
  for (const HostArray& a : store.arrays)
    if (a.name.starts_with("stress_"))
      for (std::size_t k = 0; k < store.count; ++k)
        sum -= a.type == Scalar::f64 ? a.as<double>()[9 * k + 2] : double(a.as<float>()[9 * k + 2]);
  return sum;
}

TEST(SlowLatticeSuspension, HasTheViscosityOfBatchelorAndGreen) {
  const Config config = config_of(kSuspension);
  auto s = started(config);
  const double side = 0.0024, phi = s->counts().grains * M_PI / 6 * 0.512 / 13.824;
  double mean = 0, samples = 0;
  for (int k = 0; k < 2000; ++k) {  // a strain of 1
    s->step();
    if (k < 300 || k % 20 != 0) continue;
    mean += shear_stress(s->rheology("fluid")) + shear_stress(s->rheology("grains"));
    ++samples;
  }
  const double relative = mean / samples / (side * side * side) / (0.1 * config.domain.shear_rate);
  EXPECT_NEAR(phi, 0.1, 0.01);
  EXPECT_NEAR(relative / (1 + 2.5 * phi + 5.2 * phi * phi), 1, 0.05);
}

}  // namespace
}  // namespace BL_SOLVER
