// Smoothing lengths that follow the volume of their particles.

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/smoothing/registry.hpp"
#include "tests/support/fluid_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kJitter = 0.2;

/// Particles of random mass at random places with random velocities, which continuity alone acts upon.
Config varied(const char* kernel, bool plane = false) {
  Config c = periodic_box(10);
  c.fluid.variable_h = true;
  c.fluid.kernel = kernel;
  c.visc.model = "none";
  c.density.delta = c.density.void_relaxation = c.shift = 0;
  c.density.cavitation_limit = 0.5;
  c.domain.two_d = plane;
  if (plane) c.domain.max.y = c.fluid.dx;
  return c;
}

void randomise(FluidBox& box) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> u(-1, 1);
  const bool plane = box.config.domain.two_d;
  for (std::size_t a = 0; a < box.position.size(); ++a) {
    box.velocity[a] = {u(rng), plane ? 0 : u(rng), u(rng)};
    if (plane) box.position[a].y = box.config.domain.middle();
  }
}

/// Density by summation and lengths that go with it: rho_a = sum_b m_b W_ab(h_a), all pairs, in fp64.
class Summation {
 public:
  explicit Summation(const FluidBox& box)
      : box_(box), plane_(box.config.domain.two_d), dimensions_(plane_ ? 2 : 3) {}

  std::vector<double> operator()(const std::vector<Vec3d>& x) const {
    std::vector<double> rho;
    for (std::size_t a = 0; a < x.size(); ++a) rho.push_back(at(x, a));
    return rho;
  }
  double length(double m, double rho) const {
    const double area = plane_ ? box_.config.domain.thickness() : 1;
    return box_.config.fluid.sigma_h * std::pow(m / rho / area, 1.0 / dimensions_);
  }

 private:
  double at(const std::vector<Vec3d>& x, std::size_t a) const {
    std::vector<std::pair<double, double>> near;  // distance, m, and mass, kg
    for (std::size_t b = 0; b < x.size(); ++b)
      if (const double r = norm(box_.frame.nearest_image(x[a] - x[b])); r < 0.045)
        near.emplace_back(r, box_.mass[b]);
    double lo = 300, hi = 3000;  // the sum falls short of rho where rho is large
    for (int k = 0; k < 48; ++k) {
      const double rho = 0.5 * (lo + hi);
      (sum(near, length(box_.mass[a], rho)) > rho ? lo : hi) = rho;
    }
    return 0.5 * (lo + hi);
  }
  double sum(const std::vector<std::pair<double, double>>& near, double h) const {
    double rho = 0;
    for (const auto& [r, m] : near)
      if (r < 2 * h) rho += m * W(r / h);
    return rho / std::pow(h, dimensions_) / (plane_ ? box_.config.domain.thickness() : 1);
  }
  double W(double q) const {
    if (box_.config.fluid.kernel == KernelFunction::cubic) {
      const double t = 2 - q, inner = 1 - 1.5 * q * q + 0.75 * q * q * q, outer = 0.25 * t * t * t;
      return (plane_ ? 10.0 / 7 : 1.0) / M_PI * (q < 1 ? inner : outer);
    }
    return (plane_ ? 7.0 / 4 : 21.0 / 16) / M_PI * square(square(1 - q / 2)) * (1 + 2 * q);
  }

  const FluidBox& box_;
  bool plane_;
  int dimensions_;
};

/// The box at the density of its particles, with lengths and lists to go with it.
void upload_at(FluidBox& box, const std::vector<double>& rho) {
  for (std::size_t a = 0; a < rho.size(); ++a) box.s[a] = rho[a] / box.config.fluid.rho0 - 1;
  box.upload();
  box.solver->refresh(box.fluid, box.walls, true, {});
  box.solver->state(box.fluid, 0, false);
}

class VariableH : public testing::TestWithParam<std::tuple<const char*, bool>> {};
INSTANTIATE_TEST_SUITE_P(Kernels, VariableH,
                         testing::Combine(testing::Values("wendland_c2", "cubic"), testing::Bool()));

TEST_P(VariableH, ContinuityIsTheRateOfTheSummation) {  // T-6
  const auto [kernel, plane] = GetParam();
  FluidBox box(varied(kernel, plane), kJitter, true);
  randomise(box);
  const Summation summation(box);
  const double dt = 1e-5;
  std::vector<Vec3d> before, after;
  for (std::size_t a = 0; a < box.position.size(); ++a) {
    before.push_back(box.position[a] - dt * box.velocity[a]);
    after.push_back(box.position[a] + dt * box.velocity[a]);
  }
  upload_at(box, summation(box.position));
  const auto s = box.fluid.compression.values();  // as the box has them
  box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
  box.solver->density(box.fluid, box.walls, {}, box.moment(), 1);
  const auto next = box.fluid.compression.values();
  const auto id = box.fluid.id.values();
  const auto h = box.solver->lengths()->h.values();
  const auto rho = summation(box.position), early = summation(before), late = summation(after);
  double error = 0, scale = 0, shortest = 1, longest = 0;
  for (std::size_t k = 0; k < id.size(); ++k) {
    const double rate = (late[id[k]] - early[id[k]]) / (2 * dt) / box.config.fluid.rho0;
    error = std::max(error, std::abs(double(next[k]) - s[k] - rate));
    scale = std::max(scale, std::abs(rate));
    EXPECT_NEAR(h[k], summation.length(box.mass[id[k]], rho[id[k]]), 1e-5 * h[k]);
    shortest = std::min(shortest, double(h[k]));
    longest = std::max(longest, double(h[k]));
  }
  EXPECT_GT(longest, 1.3 * shortest);
  EXPECT_LT(error / scale, tolerance(1e-5, 1e-4, 1e-3));
}

TEST(SmallVariableH, ForcesOfAllTermsBalance) {  // T-2: each pair is in both rows, however far one reaches
  for (const char* model : {"signal", "monaghan", "morris"}) {
    Config c = varied("cubic");
    c.visc.model = model;
    c.fluid.mu = 5;
    c.visc.alpha = 0.1;
    c.visc.beta = 0.2;
    FluidBox box(c, 0.4, true);
    randomise(box);
    for (std::size_t a = 0; a < box.s.size(); ++a) box.s[a] = 0.02 * box.velocity[a].x;
    box.upload();
    box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
    const auto acc = box.fluid.acc_next.values();
    const auto m = box.fluid.mass.values();
    Vec3d force;
    double scale = 0;
    for (std::size_t a = 0; a < acc.size(); ++a) {
      force += double(m[a]) * Vec3d(acc[a]);
      scale += double(m[a]) * norm(Vec3d(acc[a]));
    }
    ASSERT_GT(scale, 0);
    EXPECT_LT(norm(force) / scale, kInvariant) << model;
  }
}

/// What pressure gives to motion it takes from compression, at one instant: sum m v . a = -sum m P/rho^2
/// drho/dt.
TEST(SmallVariableH, PressureIsNoSourceOfEnergy) {
  FluidBox box(varied("wendland_c2"), 0.4, true);
  randomise(box);
  for (std::size_t a = 0; a < box.s.size(); ++a) box.s[a] = 0.05 * box.velocity[a].z;
  box.upload();
  box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
  box.solver->density(box.fluid, box.walls, {}, box.moment(), 1);
  const auto acc = box.fluid.stress_acceleration.values();
  const auto v = box.fluid.v_rho.values();
  const auto state = box.fluid.eos_state.values();
  const auto m = box.fluid.mass.values(), s = box.fluid.compression_next.values(),
             next = box.fluid.compression.values();
  double motion = 0, compression = 0, scale = 0;
  for (std::size_t a = 0; a < acc.size(); ++a) {
    const double work = double(m[a]) * dot(Vec3d(v[a].v), Vec3d(acc[a]));
    motion += work;
    scale += std::abs(work);
    compression += double(m[a]) * state[a].p_over_rho2 * box.config.fluid.rho0 * (double(next[a]) - s[a]);
  }
  EXPECT_LT(std::abs(motion + compression) / scale, tolerance(1e-12, 3e-6, 3e-5));
}

TEST(SmallVariableH, ListsBoundHowFarLengthsGrow) {
  FluidBox box(varied("cubic"));
  box.upload();
  const auto length = [&] { return double(box.solver->lengths()->h.values()[5]); };
  const auto extremes = [&] {
    box.solver->survey(box.fluid);
    return box.solver->extremes();
  };
  const double most = double(kLengthGrowth) * 0.015;
  EXPECT_FALSE(box.solver->due(extremes(), 0, 0));
  EXPECT_NEAR(length(), 0.015, 1e-7);
  box.fluid.compression.assign(std::vector<Real>(box.s.size(), Real(-0.2)));  // volumes grow by a quarter
  box.solver->state(box.fluid, 0, false);
  EXPECT_NEAR(length(), most, 1e-6);
  EXPECT_TRUE(box.solver->due(extremes(), 0, 0));
  EXPECT_NEAR(extremes().h_min, most, 1e-6);
  const double range = box.solver->range();
  box.solver->refresh(box.fluid, box.walls, false, {});
  EXPECT_NEAR(length(), 0.015 * std::cbrt(1.25), 1e-6);
  EXPECT_FALSE(box.solver->due(extremes(), 0, 0));
  EXPECT_GE(box.solver->range(), 2 * double(kLengthGrowth) * length());
  EXPECT_GT(box.solver->range(), range) << "cells grow with the lengths";
}

TEST(SmallVariableH, LengthsKeepWithinTheirBounds) {
  FluidBox box(varied("cubic"));
  box.mass[0] *= 100;
  box.mass[1] /= 100;
  box.upload();
  const auto id = box.fluid.id.values();
  const auto h = box.solver->lengths()->h.values();
  for (std::size_t k = 0; k < id.size(); ++k) {
    const double expected = id[k] == 0 ? 0.03 : id[k] == 1 ? 0.0075 : 0.015;
    EXPECT_NEAR(h[k], expected, 1e-7);
  }
}

}  // namespace
}  // namespace BL_SOLVER
