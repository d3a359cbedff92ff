// Density by summation that counts grains as fluid of their volume ("single pressure").

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/smoothing/lucy.hpp"
#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// Grains of one spacing on one in twelve sites of a periodic box, where they replace fluid.
Config slurry() {
  Config c = periodic_box(8, 1.0);
  c.domain.max = {8, 9, 8};
  c.fluid.model = "sdpd_a";
  c.fluid.kernel = "lucy";
  c.fluid.h_over_dx = 2.5;
  c.fluid.rho0 = 1;
  c.fluid.mu = 2;
  c.fluid.c = 10;
  c.density.method = DensityMethod::summation;
  c.density.count_grains = true;
  c.visc.model = ViscosityModel::none;
  c.fluid.fills = {{c.domain.min, c.domain.max}};
  c.grain.present = true;
  c.grain.d = c.grain.d_min = c.grain.d_max = 1;
  c.grain.rho = 2;
  c.couple.hc = 3;
  c.couple.kernel = CouplingKernel::top_hat;
  GrainFill fill;
  fill.max = c.domain.max;
  fill.every = {2, 3, 2};
  fill.replaces_fluid = true;
  c.grain.fills = {fill};
  c.time.dt = 1e-5;
  c.time.end = 1;
  return c;
}

TEST(SmallCountedGrains, AreFluidOfTheirVolumeInTheDensity) {
  const Config c = slurry();
  auto s = started(c);
  s->step();
  const auto fluid = s->snapshot("fluid");
  const auto x = vectors(fluid, "position"), grains = vectors(s->snapshot("grains"), "position");
  const auto density = scalars(fluid, "density"), eps = scalars(fluid, "porosity");
  ASSERT_EQ(grains.size(), 48u);
  const Frame frame = frame_of(c);
  const Lucy w(2.5);
  const auto W = [&](const Vec3d& d) { return double(w.W(Real(norm(d)))); };
  double lattice = 0;
  for (int k = 0; k < 343; ++k) lattice += W(Vec3d(k % 7 - 3, k / 7 % 7 - 3, k / 49 - 3));
  const double total = 8 * 9 * 8,
               share = total / double(x.size());  // volume for which a fluid particle stands
  const double V = 4.0 / 3 * M_PI / 8;
  // at the start a particle got the mass of the fluid in its volume
  double mean = 0;
  for (std::size_t a = 0; a < x.size(); ++a) {
    double rho = 0;
    for (std::size_t b = 0; b < x.size(); ++b) rho += eps[b] * share * W(frame.separation(x[a], x[b]));
    for (const Vec3d& g : grains) rho += V * W(frame.separation(x[a], g));
    ASSERT_NEAR(density[a], rho / lattice, tolerance(1e-6, 1e-5, 5e-5)) << a;
    mean += density[a] / double(x.size());
  }
  EXPECT_NEAR(mean, 1, 0.05) << "grains make up for the fluid whose place they take";
  for (std::size_t a = 0; a < eps.size(); ++a) ASSERT_LT(eps[a], 0.99) << "no grains";
}

TEST(SmallCountedGrains, AreLeftOutIfNotAsked) {
  Config c = slurry();
  auto with = started(c);
  c.density.count_grains = false;
  auto without = started(c);
  with->step(), without->step();
  const auto counted = scalars(with->snapshot("fluid"), "density"),
             mixture = scalars(without->snapshot("fluid"), "density");
  double most = 0;
  for (std::size_t a = 0; a < counted.size(); ++a) most = std::max(most, std::abs(counted[a] - mixture[a]));
  EXPECT_GT(most, 1e-3) << "the mixture's mass and grains one by one tell apart";
}

}  // namespace
}  // namespace BL_SOLVER
