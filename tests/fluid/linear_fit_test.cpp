// Pressure forces that are exact for linear pressures (LinearFit).

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/fluid_box.hpp"
#include "tests/support/free_body.hpp"
#include "tests/support/run.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kSlope = 1000, kLeast = 1000;  // Pa/m, Pa

/// Disordered fluid between two free surfaces, whose pressure grows along x on the way between them.
struct Slab {
  explicit Slab(double mu, TimeIntegrator integrator = TimeIntegrator::kdk, bool linear_exact = true)
      : config(periodic_box(14)) {
    config.domain.periodic[0] = false;
    config.fluid.mu = mu;
    config.time.integrator = integrator;
    config.pressure.linear_exact = linear_exact;
    box = std::make_unique<FluidBox>(config, 0.2);
    for (std::size_t a = 0; a < box->position.size(); ++a)
      box->s[a] = double(box->solver->eos().compression(Real(kLeast + kSlope * box->position[a].x)));
    box->upload();
    const double dt = 1e-7;
    if (!box->solver->one_pass()) box->solver->density(box->fluid, box->walls, {}, box->moment(), dt);
    box->solver->forces(box->fluid, box->walls, {}, box->moment(), dt);
  }
  /// Largest error of the acceleration at least four spacings from the surfaces, m/s2.
  double error() const {
    const auto x = box->coordinates_now();
    const auto theta = box->fluid.stress_acceleration.values();
    const Vec3d right{-kSlope / config.fluid.rho0, 0, 0};
    double out = 0;
    for (std::size_t a = 0; a < x.size(); ++a)
      if (depth(x[a]) > 4) out = std::max(out, norm(Vec3d(theta[a]) - right));
    return out;
  }
  double depth(const Vec3d& x) const { return std::min(x.x, config.domain.max.x - x.x) / config.fluid.dx; }

  Config config;
  std::unique_ptr<FluidBox> box;
};

TEST(LinearFit, MakesTheForceOfALinearPressureExact) {
  EXPECT_LT(Slab(10).error(), 0.03) << "which density and volume differ by";
  EXPECT_LT(Slab(10, TimeIntegrator::ab3).error(), 0.03);
  EXPECT_GT(Slab(10, TimeIntegrator::kdk, false).error(), 1) << "by pairs alone";
}

TEST(LinearFit, LeavesTheOutermostLayerAndFluidThatIsNotViscous) {
  const Slab slab(10);
  const auto x = slab.box->coordinates_now();
  const auto correction = slab.box->fluid.correction.values();
  for (std::size_t a = 0; a < x.size(); ++a)
    if (slab.depth(x[a]) < 0.8) {
      EXPECT_LT(norm(correction[a].xyz()), 0.01) << "m/s2, of some 3 within";
    }
  // cell Reynolds number of 1000 Pa: dx (rho P)^(1/2) / mu
  const auto largest = [](double mu) {
    double out = 0;
    const Slab slab(mu);
    for (const Real4& u : slab.box->fluid.correction.values()) out = std::max(out, double(norm(u.xyz())));
    return out;
  };
  const double all = largest(10);
  EXPECT_NEAR(largest(0.2), all, 0.02 * all) << "50";
  EXPECT_LT(largest(0.05), 0.7 * all) << "200";
  EXPECT_EQ(largest(0.02), 0) << "500";
}

/// Mean speed of fluid driven to and fro, over that of Poiseuille's flow, under `background` Pa; the stress
/// at the planes in between is 0.375 Pa.
double flow(double background, bool linear_exact = true) {
  Config c = periodic_box(12, 1e-3);
  c.fluid.mu = 0.1;
  c.fluid.vmax = 0.8, c.fluid.c = 8;
  c.eos.background = background;
  c.pressure.linear_exact = linear_exact;
  c.drive.f = {125, 0, 0};
  c.drive.opposed = "z";
  c.fluid.fills = {{c.domain.min, c.domain.max}};
  auto s = started(c);
  run_until(*s, 0.14);
  const auto x = vectors(s->snapshot("fluid"), "position"), v = vectors(s->snapshot("fluid"), "velocity");
  double sum = 0;
  for (std::size_t a = 0; a < x.size(); ++a) sum += x[a].z < 0.006 ? v[a].x : -v[a].x;
  return sum / x.size() / (125 * square(0.012) / (48 * 0.1));
}

TEST(SlowLinearFit, LetsViscousFluidFlowUnderAnyPressure) {
  const double without = flow(0);
  EXPECT_NEAR(without, 1, 0.06);
  for (const double background : {3.75, 37.5, 375.0}) EXPECT_NEAR(flow(background), without, 0.01 * without);
  EXPECT_LT(flow(375, false), 0.5 * without) << "a lattice bears the stress";
}

/// What it costs: momentum, by as much as the diagnostics tell.
TEST(SmallLinearFit, TellsTheMomentumThatItAdds) {
  Config c = periodic_box(8);
  c.fluid.mu = 1;
  c.eos.background = 400;
  c.drive.f = {1000, 0, 0};
  c.drive.opposed = "z";
  c.fluid.fills = {{c.domain.min, c.domain.max, {"0.3*sin(78.54*y)", "0.1*cos(78.54*z)", "0"}}};
  auto s = started(c);
  double most = 0;
  for (int k = 0; k < 60; ++k) {
    s->step();
    const auto d = s->diagnostics();
    const Vec3d added = vector_of(d, "force_pressure_correction"),
                left = vector_of(d, "fluid_force_residual");
    most = std::max(most, norm(added));
    EXPECT_LT(norm(left), 1e-4 * 1000 * 5.12e-4) << "of the drive";
  }
  EXPECT_GT(most, 0);
  EXPECT_LT(most, 0.02 * 1000 * 5.12e-4);
}

}  // namespace
}  // namespace BL_SOLVER
