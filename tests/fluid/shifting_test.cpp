// Particle shifting: what drifts, what does not, and what it is for.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/fluid_box.hpp"
#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kShift = 200;

/// Drift of a disordered free block, 12 spacings wide, whose fluid moves as `velocity` has it at the middle's
/// distance.
template <class Velocity>
std::unique_ptr<FluidBox> drifting(const Velocity& velocity, TimeIntegrator integrator = TimeIntegrator::kdk,
                                   bool smooth = true) {
  Config c = periodic_box(12);
  c.shift = kShift;
  c.time.integrator = integrator;
  if (!smooth) c.density.delta = c.density.void_relaxation = 0;
  c.domain.periodic = {false, false, false};
  auto out = std::make_unique<FluidBox>(c, 0.2);
  FluidBox& box = *out;
  const Vec3d middle = 0.5 * (c.domain.min + c.domain.max);
  for (std::size_t a = 0; a < box.position.size(); ++a) box.velocity[a] = velocity(box.position[a] - middle);
  box.upload();
  if (box.solver->one_pass())
    box.solver->forces(box.fluid, box.walls, {}, box.moment(), 1e-4);
  else
    box.solver->density(box.fluid, box.walls, {}, box.moment(), 1e-4);
  return out;
}

double largest(const std::unique_ptr<FluidBox>& box) {
  double out = 0;
  for (const Real3& u : box->fluid.drift.values()) out = std::max(out, double(norm(u)));
  return out;
}

TEST(Shifting, IsTheSameInOnePassAndWithoutSmoothing) {
  const auto shear = [](const Vec3d& r) { return Vec3d{r.z, 0, 0}; };
  const auto kdk = drifting(shear)->fluid.drift.values();
  for (const bool smooth : {true, false}) {
    const auto one = drifting(shear, TimeIntegrator::ab3, smooth)->fluid.drift.values();
    ASSERT_EQ(one.size(), kdk.size());
    for (std::size_t a = 0; a < kdk.size(); ++a)
      EXPECT_LE(norm(one[a] - kdk[a]), tolerance(1e-10, 1e-5, 1e-4) * norm(kdk[a]) + 1e-7);
  }
}

TEST(Shifting, TakesStrainAndNeitherTranslationNorRotation) {
  const double strained = largest(drifting([](const Vec3d& r) { return Vec3d{r.z, 0, 0}; }));
  const double faster = largest(drifting([](const Vec3d& r) { return Vec3d{2 * r.z, 0, 0}; }));
  EXPECT_GT(strained, 1e-3);
  EXPECT_NEAR(faster / strained, 2, 1e-3) << "in proportion to the strain";
  EXPECT_LT(largest(drifting([](const Vec3d& r) {
              return cross(Vec3d{0.3, 1, -0.5}, r);
            })),
            0.25 * strained)
      << "what disorder makes of it";
  EXPECT_LT(largest(drifting([](const Vec3d&) {
              return Vec3d{2, -1, 3};
            })),
            strained * tolerance(1e-9, 1e-3, 1e-3));
  const double fastest = largest(drifting([](const Vec3d& r) { return Vec3d{1e4 * r.z, 0, 0}; }));
  EXPECT_NEAR(fastest * 1e-4, 0.1 * 0.01, 1e-8) << "a tenth of a spacing a step at most";
}

TEST(Shifting, LeavesCrowdedPlacesWithinTheFluidAndNothingAtItsSurface) {
  const auto block = drifting([](const Vec3d& r) { return Vec3d{r.z, 0, 0}; });
  const FluidBox& box = *block;
  const auto x = box.coordinates_now();
  const auto u = box.fluid.drift.values();
  const auto crowding = [&](double step) {
    double sum = 0;
    for (std::size_t a = 0; a < x.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const Vec3d r = x[a] - x[b] + step * (Vec3d(u[a]) - Vec3d(u[b]));
        sum += std::exp(-2e4 * norm2(r));
      }
    return sum;
  };
  EXPECT_LT(crowding(1e-3 * 0.01 / norm(u[x.size() / 2])), crowding(0));
  for (std::size_t a = 0; a < x.size(); ++a) {
    const Vec3d r = x[a], far = box.config.domain.max - r;
    if (std::min({r.x, r.y, r.z, far.x, far.y, far.z}) < 0.8 * box.config.fluid.h()) {
      EXPECT_EQ(norm(u[a]), 0);
    }
  }
}

/// Near a surface that is known from the step before, places change along it.
TEST(Shifting, GoesAlongAFreeSurfaceBesideIt) {
  Config c = periodic_box(12);
  c.shift = kShift;
  c.domain.periodic[2] = false;
  FluidBox box(c, 0.2);
  for (std::size_t a = 0; a < box.position.size(); ++a) box.velocity[a] = {box.position[a].z, 0, 0};
  box.upload();
  for (int k = 0; k < 2; ++k) box.solver->density(box.fluid, box.walls, {}, box.moment(), 1e-4);
  const auto x = box.coordinates_now();
  const auto u = box.fluid.drift.values();
  double across = 0, along = 0, across_within = 0, along_within = 0;
  for (std::size_t a = 0; a < x.size(); ++a) {
    const double depth = std::min(x[a].z, c.domain.max.z - x[a].z) / c.fluid.dx;
    if (depth > 1.2 && depth < 2.2) across += square(double(u[a].z)), along += square(double(u[a].x));
    if (depth > 4.2) across_within += square(double(u[a].z)), along_within += square(double(u[a].x));
  }
  EXPECT_GT(along, 0);
  EXPECT_LT(across, 0.02 * along) << "what the normals of single particles differ by";
  EXPECT_NEAR(across_within / along_within, 1, 0.2) << "within, it knows no direction";
}

double left_of_vortices(double shift) {
  Config c = periodic_box(40, 0.025);
  c.domain.max.y = 0.025;
  c.domain.two_d = true;
  c.fluid.mu = 10;
  c.fluid.c = 10;
  c.shift = shift;
  c.fluid.fills = {
      {c.domain.min, c.domain.max, {"sin(2*pi*x)*cos(2*pi*z)", "0", "-cos(2*pi*x)*sin(2*pi*z)"}}};
  auto s = started(c);
  const double before = reading(s->diagnostics(), "fluid_kinetic_energy");
  run_until(*s, 0.5);
  const double exact = std::exp(-16 * M_PI * M_PI * 0.01 * s->time());
  return reading(s->diagnostics(), "fluid_kinetic_energy") / before / exact;
}

/// Without it a lattice resists shear by its pressure, at any resolution; Taylor-Green, Re 100.
TEST(Shifting, LetsVorticesDecayByViscosityAlone) {
  EXPECT_NEAR(left_of_vortices(kShift), 1, 0.05);
  EXPECT_LT(left_of_vortices(0), 0.5);
}

/// The same vortices through a depth of eight spacings, 20 to a wavelength, also around one grain.
double left_of_deep_vortices(double shift, bool grain) {
  Config c = periodic_box(20, 0.05);
  c.domain.max.y = 0.4;
  c.fluid.mu = 10;
  c.fluid.c = 10;
  c.shift = shift;
  c.fluid.fills = {
      {c.domain.min, c.domain.max, {"sin(2*pi*x)*cos(2*pi*z)", "0", "-cos(2*pi*x)*sin(2*pi*z)"}}};
  if (grain) {
    c.grain.present = true;
    c.grain.d = c.grain.d_min = c.grain.d_max = 0.02;
    c.grain.rho = c.fluid.rho0;
    c.grain.E = 1e6;
    c.couple.hc = c.fluid.h();
    GrainFill fill;
    fill.positions = {{0.5, 0.2, 0.5}};
    c.grain.fills = {fill};
  }
  auto s = started(c);
  const double before = reading(s->diagnostics(), "fluid_kinetic_energy");
  run_until(*s, 0.4);
  const double exact = std::exp(-16 * M_PI * M_PI * 0.01 * s->time());
  return reading(s->diagnostics(), "fluid_kinetic_energy") / before / exact;
}

TEST(SlowShifting, ActsInThreeDimensionsAndAmongGrains) {
  EXPECT_NEAR(left_of_deep_vortices(kShift, false), 1, 0.07);
  EXPECT_NEAR(left_of_deep_vortices(kShift, true), 1, 0.07);
  EXPECT_LT(left_of_deep_vortices(0, false), 0.8);
}

}  // namespace
}  // namespace BL_SOLVER
