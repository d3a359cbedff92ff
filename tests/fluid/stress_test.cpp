// Stress by the forces of pairs: without walls the sum of F r over pairs is that of force times place over
// particles.

#include <gtest/gtest.h>

#include "tests/support/fluid_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kDt = 0.01;  // s, by which the noise goes

/// Fluid without periodic images, in reduced units, thrown about.
Config lone_box(const std::string& model, double kT = 0) {
  Config c = periodic_box(8, 1.0);
  c.domain.periodic = {false, false, false};
  c.fluid.model = model;
  c.fluid.rho0 = 1;
  c.fluid.mu = 3;
  c.fluid.zeta = 20.0 / 21 * c.fluid.mu;
  c.fluid.c = 10;
  c.sdpd.kT = kT;
  return c;
}

struct Thrown : FluidBox {
  explicit Thrown(const Config& config) : FluidBox(config, 0.4, true) {
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> u(-1, 1);
    for (std::size_t a = 0; a < position.size(); ++a) {
      for (int k = 0; k < 3; ++k) velocity[a][k] = u(rng);
      s[a] = 0.02 * u(rng);
    }
    upload();
    std::vector<Real3> spin(position.size());
    for (Real3& w : spin) w = {Real(u(rng)), Real(u(rng)), Real(u(rng))};
    if (solver->spin()) solver->spin()->omega.assign(spin);
    solver->forces(fluid, walls, {}, moment(), kDt);
    solver->moments(fluid, walls, moment(), kDt, moments);
  }
  /// Row i, column j: sum of F_i x_j, J; of what forces() has found.
  std::array<double, 9> of_particles() const {
    std::array<double, 9> sum{};
    const auto acc = fluid.acc_next.values();
    const auto m = fluid.mass.values();
    const auto x = coordinates_now();
    for (std::size_t a = 0; a < x.size(); ++a)
      for (int k = 0; k < 9; ++k) sum[k] += double(m[a]) * double(acc[a][k / 3]) * x[a][k % 3];
    return sum;
  }
  static std::array<double, 9> sum_of(const Buffer<PairMoment<>>& part) {
    std::array<double, 9> sum{};
    for (const PairMoment<>& one : part.to_host())
      for (int k = 0; k < 9; ++k) sum[k] += double(one.row[k / 3][k % 3]);
    return sum;
  }
  FluidMoments moments;
};

void expect_same(const std::array<double, 9>& a, const std::array<double, 9>& b, const std::string& what) {
  double size = 0;
  for (const double value : b) size = std::max(size, std::abs(value));
  ASSERT_GT(size, 1) << what;
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(a[k], b[k], 30 * kInvariant * size) << what << ' ' << k;
}

std::array<double, 9> operator+(std::array<double, 9> a, const std::array<double, 9>& b) {
  for (int k = 0; k < 9; ++k) a[k] += b[k];
  return a;
}

TEST(SmallStress, OfPairsIsWhatForcesOnParticlesComeTo) {
  for (const std::string model : {"wcsph", "sdpd", "sdpd_a"}) {
    Config c = lone_box(model, model == "wcsph" ? 0 : 0.5);
    if (model == "wcsph") c.visc.alpha = 0.2, c.tensile = 1, c.shift = 0;
    const Thrown box(c);
    auto all = Thrown::sum_of(box.moments.pressure) + Thrown::sum_of(box.moments.friction);
    if (model != "wcsph") all = all + Thrown::sum_of(box.moments.noise);
    expect_same(all, box.of_particles(), model);
    EXPECT_EQ(box.moments.noise.size() > 0, model != "wcsph");
  }
}

TEST(SmallStress, PressureIsThePartWithoutViscosity) {
  for (const std::string model : {"wcsph", "sdpd_a"}) {
    Config c = lone_box(model, model == "wcsph" ? 0 : 0.5);
    const Thrown box(c);
    c.fluid.mu = c.fluid.zeta = 0;  // and with it the noise
    const Thrown inviscid(c);
    expect_same(Thrown::sum_of(box.moments.pressure), inviscid.of_particles(), model);
  }
}

}  // namespace
}  // namespace BL_SOLVER
