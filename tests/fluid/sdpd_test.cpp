// SDPD: what its pairs keep, its viscosities, its temperature, its densities.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/fluid_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Fluid in reduced units: spacing, density and mass of a particle are one.
Config sdpd_box(int n, const std::string& model, double kT = 0) {
  Config c = periodic_box(n, 1.0);
  c.fluid.model = model;
  c.fluid.rho0 = 1;
  c.fluid.mu = 3;
  c.fluid.zeta = 20.0 / 21 * c.fluid.mu;
  c.fluid.c = 10;
  c.density.method = DensityMethod::summation;
  c.sdpd.kT = kT;
  return c;
}

Vec3d random_vector(std::mt19937& rng, double size) {
  std::uniform_real_distribution<double> u(-size, size);
  const double x = u(rng), y = u(rng);
  return {x, y, u(rng)};
}

/// Random velocities, densities and, where there are any, spins.
void randomise(FluidBox& box) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> u(-1, 1);
  for (std::size_t a = 0; a < box.position.size(); ++a) {
    box.velocity[a] = random_vector(rng, 1);
    box.s[a] = 0.02 * u(rng);
  }
  box.upload();
  std::vector<Real3> spin;
  for (std::size_t a = 0; a < box.position.size(); ++a) spin.push_back(Real3(random_vector(rng, 1)));
  if (box.solver->spin()) box.solver->spin()->omega.assign(spin);
}

struct Balance {
  Vec3d force, moment;
  double forces = 0, moments = 0;  ///< sums of magnitudes
};

/// Of all forces and couples about the middle of the box.
Balance balance(FluidBox& box) {
  Balance out;
  const auto acc = box.fluid.acc_next.values();
  const auto m = box.fluid.mass.values();
  const auto x = box.coordinates_now();
  std::vector<Real3> turning(acc.size());
  const Spin* spin = box.solver->spin();
  if (spin) turning = spin->acc.values();
  const Vec3d middle = 0.5 * (box.config.domain.min + box.config.domain.max);
  for (std::size_t a = 0; a < acc.size(); ++a) {
    const Vec3d f = double(m[a]) * Vec3d(acc[a]);
    const Vec3d t = cross(x[a] - middle, f), couple = m[a] * (spin ? spin->inertia : 0) * Vec3d(turning[a]);
    out.force += f, out.moment += t + couple;
    out.forces += norm(f), out.moments += norm(t) + norm(couple);
  }
  return out;
}

struct Choice {
  std::string model, noise;
};

TEST(Sdpd, PairsKeepMomentum) {  // T-2
  for (const Choice& k : {Choice{"sdpd", "vector"}, {"sdpd_a", "vector"}, {"sdpd_a", "tensor"}}) {
    Config c = sdpd_box(10, k.model, 0.5);
    c.sdpd.noise = k.noise;
    FluidBox box(c, 0.4, true);
    randomise(box);
    box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0.01);
    const Balance b = balance(box);
    ASSERT_GT(b.forces, 0);
    EXPECT_LT(norm(b.force) / b.forces, kInvariant) << k.model << k.noise;
  }
}

TEST(Sdpd, SpinKeepsAngularMomentum) {  // T-2, without periodic images
  for (const std::string model : {"sdpd", "sdpd_a"}) {
    Config c = sdpd_box(10, model, 0.5);
    c.domain.periodic = {false, false, false};
    FluidBox box(c, 0.4, true);
    randomise(box);
    box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0.01);
    const Balance b = balance(box);
    if (model == "sdpd_a")
      EXPECT_LT(norm(b.moment) / b.moments, kInvariant);
    else
      EXPECT_GT(norm(b.moment) / b.moments, 1e-4) << "without spin the test could not fail";
  }
}

TEST(Sdpd, RigidRotationFeelsNoFriction) {  // T-4
  Config c = sdpd_box(10, "sdpd_a");
  c.domain.periodic = {false, false, false};
  c.sdpd.force_scale = {0, 1, 1, 1};
  FluidBox box(c, 0.4, true);
  const Vec3d omega{0.3, -0.7, 0.5};
  for (std::size_t a = 0; a < box.position.size(); ++a) box.velocity[a] = cross(omega, box.position[a]);
  box.upload();
  const auto sum_of_magnitudes = [&] {
    box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
    return balance(box).forces;
  };
  const double without_spin = sum_of_magnitudes();
  box.solver->spin()->omega.assign(std::vector<Real3>(box.position.size(), Real3(omega)));
  EXPECT_LT(sum_of_magnitudes() / without_spin, 20 * kInvariant);
}

/// The viscosity that a wave of velocity feels on the lattice, spin being half the vorticity.
double viscosity_of_wave(const std::string& model, int direction, double bulk, double h_over_dx) {
  Config c = sdpd_box(10, model);
  c.domain.max.z = 40;
  c.fluid.h_over_dx = h_over_dx;
  c.fluid.zeta = bulk * c.fluid.mu;
  c.sdpd.force_scale = {0, 1, 1, 1};
  FluidBox box(c);
  const double k = 2 * pi / 40;
  std::vector<Vec3d> v(box.position.size());
  for (std::size_t a = 0; a < v.size(); ++a) box.velocity[a][direction] = std::cos(k * box.position[a].z);
  box.upload();
  const auto x = box.coordinates_now();
  if (model == "sdpd_a" && direction == 0) {
    std::vector<Real3> spin;
    for (const Vec3d& at : x) spin.push_back({0, Real(-0.5 * k * std::sin(k * at.z)), 0});
    box.solver->spin()->omega.assign(spin);
  }
  box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
  const auto theta = box.fluid.stress_acceleration.values();
  double top = 0, bottom = 0;
  for (std::size_t a = 0; a < x.size(); ++a) {
    const double wave = std::cos(k * x[a].z);
    top -= double(theta[a][direction]) * wave;
    bottom += wave * wave * k * k;
  }
  return top / bottom;
}

TEST(Sdpd, SpinningViscosityOnALattice) {  // T-7: h/dx = 1.5, default zeta
  EXPECT_NEAR(viscosity_of_wave("sdpd_a", 0, 20.0 / 21, 1.5) / 3, 1, 3e-2);
}

/// Shear, and compression by 4/3 mu + zeta. Forces along the line of centres alone are 5 % off on the lattice
/// with h = 1.5 dx, whose fourth moments are not those of a sphere.
TEST(SlowSdpd, ViscositiesOnALattice) {
  for (const std::string model : {"sdpd", "sdpd_a"})
    for (double bulk : {0.2, 20.0 / 21, 1.6}) {
      EXPECT_NEAR(viscosity_of_wave(model, 0, bulk, 2.2) / 3, 1, 3e-2) << model << bulk;
      EXPECT_NEAR(viscosity_of_wave(model, 2, bulk, 2.2) / 3, 4.0 / 3 + bulk, 3e-2 * (4.0 / 3 + bulk))
          << model << bulk;
    }
}

struct Temperatures {
  double linear = 0, spin = 0, linear_error = 0, spin_error = 0;  ///< over kT
};

/// Of particles that stay where they are: friction and noise alone.
Temperatures frozen_bath(const std::string& model, const std::string& noise, double bulk, int steps = 3000) {
  Config c = sdpd_box(8, model, 0.6);
  c.sdpd.noise = noise;
  c.fluid.zeta = bulk * c.fluid.mu;
  c.sdpd.force_scale = {0, 1, 1, 1};
  c.time.friction = 0.02;
  FluidBox box(c, 0.4);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> m(0.5, 2);
  for (double& mass : box.mass) mass = m(rng);
  box.upload();
  const double dt = box.solver->friction_limit({}).seconds;
  const bool spins = box.solver->spin() != nullptr;
  const double inertia = spins ? box.solver->spin()->inertia : 0;
  const auto mass = box.fluid.mass.values();
  constexpr int skipped = 500, blocks = 20;
  std::vector<double> linear(blocks), spin(blocks);
  for (int n = 0; n < steps; ++n) {
    box.solver->kick_drift(box.fluid, dt / 2, 0, 0, false);
    box.solver->state(box.fluid, dt / 2, false);
    box.solver->forces(box.fluid, box.walls, {}, box.moment(n + 1), dt);
    box.solver->correct(box.fluid, dt / 2);
    if (n < skipped || n % 5 != 0) continue;
    const auto v = box.fluid.v_rho.values();
    const auto w = spins ? box.solver->spin()->omega.values() : std::vector<Real3>(v.size());
    const int block = (n - skipped) * blocks / (steps - skipped);
    for (std::size_t a = 0; a < v.size(); ++a) {
      const double each = 1.0 / (3 * 0.6 * v.size() * ((steps - skipped) / blocks / 5));
      linear[block] += mass[a] * norm2(Vec3d(v[a].v)) * each;
      spin[block] += mass[a] * inertia * norm2(Vec3d(w[a])) * each;
    }
  }
  Temperatures out;
  const auto mean = [&](const std::vector<double>& of, double& error) {
    double sum = 0, squares = 0;
    for (double x : of) sum += x / blocks, squares += x * x / blocks;
    error = std::sqrt(std::max(0.0, squares - sum * sum) / (blocks - 1));
    return sum;
  };
  out.linear = mean(linear, out.linear_error);
  out.spin = mean(spin, out.spin_error);
  return out;
}

TEST(SlowSdpdBath, HoldsItsTemperatureWithAnyMasses) {  // T-15: masses 0.5..2
  for (const auto& [k, bulk] : {std::pair{Choice{"sdpd", "vector"}, 0.95},
                                {Choice{"sdpd", "tensor"}, 1.6},
                                {Choice{"sdpd_a", "vector"}, 0.2}}) {
    const Temperatures t = frozen_bath(k.model, k.noise, bulk, 4500);
    // total momentum stays at nothing: three degrees of freedom less
    EXPECT_NEAR(t.linear, 1 - 1.0 / 512, 1.5e-2 + 3 * t.linear_error) << k.model << k.noise << bulk;
    if (k.model == "sdpd_a") {
      EXPECT_NEAR(t.spin, 1, 1.5e-2 + 3 * t.spin_error) << k.noise << bulk;
    }
    EXPECT_LT(t.linear_error, 0.01) << "too few steps to tell";
  }
}

TEST(SlowSdpdBath, HoldsItsTemperatureByTensorNoise) {  // T-15
  const Temperatures t = frozen_bath("sdpd_a", "tensor", 0.95);
  EXPECT_NEAR(t.linear, 1 - 1.0 / 512, 1.5e-2 + 3 * t.linear_error);
  EXPECT_NEAR(t.spin, 1, 1.5e-2 + 3 * t.spin_error);
}

TEST(Sdpd, SummationGivesTheLatticeItsDensity) {
  for (const std::string kernel : {"wendland_c2", "cubic", "lucy"}) {
    Config c = sdpd_box(10, "sdpd");
    c.fluid.kernel = kernel;
    if (kernel == "lucy") c.fluid.h_over_dx = 3;
    FluidBox box(c);
    for (double& m : box.mass) m *= 1.1;
    box.upload();
    box.solver->density(box.fluid, box.walls, {}, box.moment(), 0.01);
    for (Real s : box.fluid.compression.values()) ASSERT_NEAR(s, 0.1, tolerance(1e-6, 1e-5, 1e-4)) << kernel;
  }
}

TEST(Sdpd, AveragesLeaveAConstantAlone) {  // T-12: reinitialisation and pressure filter
  Config c = sdpd_box(10, "sdpd");
  c.density.method = DensityMethod::continuity;
  c.density.reinit_every = 3;
  c.eos.filter = true;
  FluidBox box(c, 0.4, true);
  for (double& s : box.s) s = 0.03;
  box.upload();
  const double p = box.fluid.p_rho2.values()[0];
  box.solver->density(box.fluid, box.walls, {}, box.moment(2), 0);  // the next step is the third
  for (Real s : box.fluid.compression.values()) ASSERT_NEAR(s, 0.03, 10 * kInvariant);
  box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
  for (Real found : box.fluid.p_rho2.values()) ASSERT_NEAR(found / p, 1, 20 * kInvariant);
}

TEST(Sdpd, AveragesSmoothWhatDiffers) {
  const auto spread = [](std::int64_t every, std::int64_t step) {
    Config c = sdpd_box(10, "sdpd");
    c.density.method = DensityMethod::continuity;
    c.density.reinit_every = every;
    FluidBox box(c, 0.4, true);
    randomise(box);
    box.solver->density(box.fluid, box.walls, {}, box.moment(step), 0);
    double sum = 0;
    for (Real s : box.fluid.compression.values()) sum += double(s) * s;
    return sum;
  };
  EXPECT_LT(spread(3, 2), 0.2 * spread(0, 2));
  EXPECT_EQ(spread(3, 3), spread(0, 3)) << "not due";
}

TEST(Sdpd, ForceScaleSwitchesPartsOff) {
  const auto forces = [](std::vector<double> scale) {
    Config c = sdpd_box(10, "sdpd_a", 0.5);
    c.sdpd.force_scale = scale;
    FluidBox box(c, 0.4, true);
    randomise(box);
    box.solver->forces(box.fluid, box.walls, {}, box.moment(4), 0.01);
    return box.fluid.acc_next.values();
  };
  const auto all = forces({1, 1, 1, 1});
  std::vector<std::vector<Real3>> parts;
  for (int k = 0; k < 4; ++k) {
    std::vector<double> scale(4, 0.0);
    scale[k] = 1;
    parts.push_back(forces(scale));
  }
  double error = 0, scale = 0;
  for (std::size_t a = 0; a < all.size(); ++a) {
    const Vec3d sum = Vec3d(parts[0][a]) + Vec3d(parts[1][a]) + Vec3d(parts[2][a]) + Vec3d(parts[3][a]);
    error = std::max(error, norm(sum - Vec3d(all[a])));
    scale = std::max(scale, norm(Vec3d(all[a])));
  }
  EXPECT_LT(error / scale, 10 * kInvariant);
  for (const auto& part : parts) {
    double most = 0;
    for (const Real3& a : part) most = std::max(most, norm(Vec3d(a)));
    EXPECT_GT(most, 1e-3 * scale);
  }
}

}  // namespace
}  // namespace BL_SOLVER
