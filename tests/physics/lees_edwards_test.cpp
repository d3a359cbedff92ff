// Fluid that Lees-Edwards boundaries shear, through whole simulations.

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// In reduced units: spacing and mass of a particle are one.
Config sheared_box(const std::string& model, double rate, double kT = 0) {
  Config c = periodic_box(8, 1.0);
  c.domain.shear_rate = rate;
  c.fluid.model = model;
  c.fluid.rho0 = 1;
  c.fluid.mu = 2;
  c.fluid.c = 10;
  c.fluid.fills = {{c.domain.min, c.domain.max}};
  c.time.end = 1;
  c.shift = 0;
  if (model == "wcsph") return c;
  c.fluid.kernel = "lucy";
  c.fluid.h_over_dx = 2.5;
  c.eos.type = EosType::democritus;
  c.eos.p0 = c.eos.beta = 100 / 7.0;
  c.density.method = DensityMethod::summation;
  c.visc.model = ViscosityModel::none;
  c.sdpd.kT = kT;
  c.sdpd.kI = 0.4;
  c.time.friction = kT > 0 ? 0.05 : 0.4;
  return c;
}

/// Velocities less the mean flow.
std::vector<Vec3d> peculiar(Simulation& s, const Config& c) {
  const HostStore store = s.snapshot("fluid");
  const auto x = vectors(store, "position");
  auto v = vectors(store, "velocity");
  for (std::size_t a = 0; a < x.size(); ++a) v[a].x -= c.domain.shear_rate * (x[a].z - c.domain.max.z / 2);
  return v;
}

/// Shear stress of all pairs and motion, Pa.
double shear_stress(Simulation& s, const Config& c) {
  const HostStore store = s.rheology("fluid");
  const Vec3d side = c.domain.max - c.domain.min;
  double sum = 0;
  for (const HostArray& a : store.arrays)
    if (a.name.starts_with("stress_"))
      for (std::size_t k = 0; k < store.count; ++k)
        sum -= a.type == Scalar::f64 ? a.as<double>()[9 * k + 2] : a.as<float>()[9 * k + 2];
  for (const Vec3d& u : peculiar(s, c)) sum -= u.x * u.z;
  return sum / (side.x * side.y * side.z);
}

TEST(LeesEdwards, KeepsPeculiarMomentum) {
  for (const auto& [model, kT] : {std::pair{"sdpd_a", 0.8}, {"sdpd", 0.0}, {"wcsph", 0.0}}) {
    const Config c = sheared_box(model, 0.5, kT);
    auto s = started(c);
    double at_start = 0, fastest = 0;
    for (const Vec3d& u : peculiar(*s, c)) at_start += norm(u);
    for (int n = 0; n < 200; ++n) s->step();
    Vec3d sum;
    for (const Vec3d& u : peculiar(*s, c)) sum += u;
    for (const Vec3d& v : vectors(s->snapshot("fluid"), "velocity")) fastest = std::max(fastest, norm(v));
    EXPECT_GT(at_start, 500) << model;
    EXPECT_GT(fastest, 1.5) << model << ": particles have not gone with the shear";
    EXPECT_LT(norm(sum) / at_start, kInvariant) << model;
  }
}

TEST(LeesEdwards, ShearsFluidFromRestAtItsViscosity) {
  for (const std::string model : {"wcsph", "sdpd", "sdpd_a"}) {
    Config c = sheared_box(model, 0.2);
    if (model != "wcsph") c.fluid.h_over_dx = 3;  // with 65 neighbours a lattice has 4 % less viscosity
    auto s = started(c);
    EXPECT_EQ(norm(vectors(s->snapshot("fluid"), "velocity")[0]), 0);
    const double wave = square(8) / (4 * kPi * kPi * c.fluid.mu);  // s, in which it decays by e
    run_until(*s, 6 * wave);
    double stress = 0, rough = 0;
    int samples = 0;
    while (s->time() < 10 * wave) {
      s->step();
      if (s->steps() % 5 == 0) stress += shear_stress(*s, c), ++samples;
    }
    for (const Vec3d& u : peculiar(*s, c)) rough = std::max(rough, std::abs(u.x));
    EXPECT_LT(rough, 0.02 * 0.2 * 8) << model << ": velocity off the line";
    EXPECT_NEAR(stress / samples / 0.2 / c.fluid.mu, 1, 0.03) << model;
  }
}

TEST(LeesEdwards, MissesNoPairHoweverLongListsLast) {
  std::vector<Vec3d> all[2];
  double rebuilds[2];
  for (const double skin : {0.02, 0.6}) {
    Config c = sheared_box("sdpd", 0.5);
    c.skin_fluid = skin;
    auto s = started(c);
    for (int n = 0; n < 80; ++n) s->step();
    rebuilds[skin > 0.1] = reading(s->diagnostics(), "rebuilds");
    all[skin > 0.1] = peculiar(*s, c);
  }
  EXPECT_GT(rebuilds[0], 3 * rebuilds[1]);
  for (std::size_t a = 0; a < all[0].size(); ++a)
    EXPECT_LT(norm(all[0][a] - all[1][a]), tolerance(1e-9, 1e-3, 1e-2)) << a;
}

TEST(LeesEdwards, RunsTheSameOnAnyNumberOfThreads) {
  std::vector<std::byte> all[2];
  const int most = omp_get_max_threads();
  for (int threads : {1, 3}) {
    omp_set_num_threads(threads);
    auto s = started(sheared_box("sdpd_a", 0.5, 0.8));
    for (int n = 0; n < 30; ++n) s->step();
    all[threads / 2] = bits(*s);
  }
  omp_set_num_threads(most);
  EXPECT_TRUE(all[0] == all[1]);
}

TEST(LeesEdwards, ContinuesBitForBit) {  // over rebuilds, and a strain that has come round
  for (const auto& [model, kT] : {std::pair{"sdpd_a", 0.8}, {"wcsph", 0.0}}) {
    const Config c = sheared_box(model, 2, kT);
    auto whole = started(c);
    for (int n = 0; n < 60; ++n) whole->step();
    const SavedState saved = whole->save();
    for (int n = 0; n < 60; ++n) whole->step();
    EXPECT_GT(2 * whole->time(), 0.5) << model;
    std::vector<std::string> warnings;
    auto again = make_coupled(c, build_setup(c, warnings));
    again->load(saved);
    for (int n = 0; n < 60; ++n) again->step();
    EXPECT_TRUE(bits(*whole) == bits(*again)) << model;
  }
}

}  // namespace
}  // namespace BL_SOLVER
