// Periodic flow: viscosity, sound, order of convergence.

#include "support.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// Sine of a velocity along z, by its component.
Setup::Nodes wave(std::uint32_t n, int component, double amplitude) {
  Setup::Nodes nodes = periodic_nodes(1, 1, n);
  nodes.v.assign(n, {});
  for (std::uint32_t k = 0; k < n; ++k) nodes.v[k][component] = amplitude * std::sin(2 * M_PI * k / n);
  return nodes;
}
double amplitude(const std::vector<Vec3d>& v, int component) {
  double sum = 0;
  for (std::size_t k = 0; k < v.size(); ++k)
    sum += v[k][component] * std::sin(2 * M_PI * double(k) / double(v.size()));
  return 2 * sum / double(v.size());
}

TEST(LatticeWaves, ShearDecaysByTheViscosity) {
  constexpr std::uint32_t n = 64;
  const double k2 = std::pow(2 * M_PI / n, 2);
  for (const double tau : {0.51, 0.6, 1.0, 2.0}) {
    LatticeFlow flow(lattice_units(tau), wave(n, 0, 1e-3));
    const double nu = (tau - 0.5) / 3;
    flow.run(100);  // the stress adapts first
    const double from = amplitude(flow.velocity(), 0);
    const auto steps = std::int64_t(std::ceil(0.5 / (nu * k2)));
    flow.run(steps);
    const double rate = std::log(from / amplitude(flow.velocity(), 0)) / double(steps);
    // waves of a few times the mean free path decay faster, by the square of the ratio
    EXPECT_NEAR(rate / (nu * k2), 1, 1e-3 + 0.35 * (tau - 0.5) * (tau - 0.5) * k2) << tau;
  }
}

/// A standing wave changes sign after a quarter of its period.
TEST(LatticeWaves, SoundTravelsAtTheRootOfAThird) {
  constexpr std::uint32_t n = 128;
  LatticeFlow flow(lattice_units(0.51), wave(n, 2, 1e-4));
  double before = 1e-4, after = before;
  while (after > 0 && flow.time() < n) {
    before = after;
    flow.run(1);
    after = amplitude(flow.velocity(), 2);
  }
  const double quarter = flow.time() - 1 + before / (before - after);
  EXPECT_NEAR(n / (4 * quarter) * std::sqrt(3.0), 1, 5e-3);
}

/// Largest relative error of decaying vortices, root mean square, where they have lost part of their speed.
double vortex_error(std::uint32_t n) {
  const double tau = 0.8, nu = (tau - 0.5) / 3, k = 2 * M_PI / n, u0 = 2e-4 * std::pow(16.0 / n, 2);
  Setup::Nodes nodes = periodic_nodes(n, n, 1);
  const auto exact = [&](std::uint32_t i, std::uint32_t j, double t) {
    return u0 * std::exp(-2 * nu * k * k * t) *
           Vec3d{std::sin(k * i) * std::cos(k * j), -std::cos(k * i) * std::sin(k * j), 0};
  };
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) nodes.v.push_back(exact(i, j, 0));
  LatticeFlow flow(lattice_units(tau), nodes);
  flow.run(std::int64_t(40 * std::pow(n / 16.0, 2)));
  const auto v = flow.velocity();
  double error = 0, all = 0;
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const Vec3d wanted = exact(i, j, flow.time());
      error += norm2(v[std::size_t(j) * n + i] - wanted);
      all += norm2(wanted);
    }
  return std::sqrt(error / all);
}

TEST(LatticeWaves, VorticesConvergeWithTheSquareOfTheSpacing) {
  const double coarse = vortex_error(16), middle = vortex_error(32), fine = vortex_error(64);
  EXPECT_LT(coarse, 0.03);
  EXPECT_NEAR(std::log2(coarse / middle), 2, 0.1);
  EXPECT_NEAR(std::log2(middle / fine), 2, 0.1);
}

}  // namespace
}  // namespace BL_SOLVER
