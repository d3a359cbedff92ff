// Pair terms of the fluid: balance, invariance, equation of state, operators on lattices.

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/smoothing/wendland_c2.hpp"
#include "tests/support/fluid_box.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// 10^3 particles, random places, masses, velocities and densities, every pair term on.
Config all_terms() {
  Config c = periodic_box(10);
  c.fluid.mu = 5;
  c.visc.alpha = 0.1;
  c.visc.beta = 0.2;
  c.tensile = 1;
  c.fluid.kernel = "cubic";
  c.xsph = 0.3;
  return c;
}

struct Balance {
  Vec3d force;
  double scale = 0;  // sum of magnitudes
};

void randomise(FluidBox& box, double shift = 0) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> u(-1, 1);
  for (std::size_t a = 0; a < box.position.size(); ++a) {
    box.velocity[a] = {u(rng) + shift, u(rng) - shift, u(rng) + shift};
    box.s[a] = 0.02 * u(rng);
  }
}

Balance balance(const FluidBox& box, const std::vector<Real3>& a) {
  Balance out;
  const auto m = box.fluid.mass.values();
  for (std::size_t i = 0; i < a.size(); ++i) {
    out.force += Vec3d(a[i]) * double(m[i]);
    out.scale += norm(Vec3d(a[i])) * double(m[i]);
  }
  return out;
}

TEST(SmallFluidPairs, ForcesOfAllTermsBalance) {  // T-2
  FluidBox box(all_terms(), 0.4, true);
  randomise(box);
  box.upload();
  box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
  const auto b = balance(box, box.fluid.acc_next.values());
  ASSERT_GT(b.scale, 0);
  EXPECT_LT(norm(b.force) / b.scale, kInvariant);
}

TEST(FluidPairs, CentralForcesExertNoTorque) {  // T-2: pressure, artificial viscosity and tensile term
  Config c = all_terms();
  c.visc.model = "none";
  c.domain.periodic = {false, false, false};
  FluidBox box(c, 0.4, true);
  randomise(box);
  box.upload();
  box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
  const auto a = box.fluid.acc_next.values();
  const auto m = box.fluid.mass.values();
  const auto x = box.coordinates_now();
  Vec3d torque;
  double scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec3d t = cross(x[i] - Vec3d{0.05, 0.05, 0.05}, Vec3d(a[i]) * double(m[i]));
    torque += t;
    scale += norm(t);
  }
  EXPECT_LT(norm(torque) / scale, kInvariant);
}

TEST(FluidPairs, GalileanShiftLeavesForcesAlone) {  // T-3, shift of 100 c
  Config c = all_terms();
  c.xsph = 0;
  std::vector<Real3> a[2];
  for (int k : {0, 1}) {
    FluidBox box(c, 0.4, true);
    randomise(box, k * 100 * c.fluid.c);
    box.upload();
    box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
    a[k] = box.fluid.acc_next.values();
  }
  double error = 0, scale = 0;
  for (std::size_t i = 0; i < a[0].size(); ++i) {
    error = std::max(error, norm(Vec3d(a[0][i]) - Vec3d(a[1][i])));
    scale = std::max(scale, norm(Vec3d(a[0][i])));
  }
  EXPECT_LT(error / scale, tolerance(1e-11, 1e-4, 1e-4));
}

TEST(FluidPairs, TaitAndDemocritusPressures) {  // T-5
  const EquationOfState tait{Real(1000), Real(7), Real(0), Real(1000), false};
  EXPECT_NEAR(double(tait.pressure(Real(0.01))) / 1000, 0.0721354, 0.0721354 * tolerance(1e-6, 1e-6, 1e-5));
  const double exact = std::pow(1.01, 7) - 1;
  EXPECT_NEAR(double(tait.pressure(Real(0.01))) / 1000, exact, exact * 2 * kInvariant);
  const EquationOfState democritus{Real(100), Real(7), Real(100 - 30), Real(3), false};
  EXPECT_NEAR(double(democritus.pressure(0)), 70, 70 * kInvariant);
  for (double x : {-0.2, -0.05, 1e-6, 1e-3, 0.3})
    EXPECT_NEAR(double(tait.compression(tait.pressure(Real(x)))), x,
                std::abs(x) * tolerance(1e-9, 1e-5, 1e-5));
  EXPECT_EQ((EquationOfState{Real(1000), 7, 0, Real(1000), true}).pressure(Real(-0.1)), Real(0));
}

TEST(FluidPairs, ArtificialViscosityAndTensileTermByHand) {  // [monaghan92], Monaghan 2000
  const ArtificialViscosity artificial{Real(0.1), Real(0.2), 20, Real(0.015)};
  const double m = 2e-3, near = -3e-3, rho = 900, r2 = 1.2e-4, F = 5e9;
  const double mu = 0.015 * near / (r2 + 0.01 * 0.015 * 0.015);
  const double expected = m * F * (0.2 * mu * mu - 0.1 * 20 * mu) / rho;
  EXPECT_NEAR(artificial.term(Real(m), Real(near), Real(rho), Real(r2), Real(F)) / expected, 1, kInvariant);
  EXPECT_EQ(artificial.term(Real(m), Real(-near), Real(rho), Real(r2), Real(F)), 0) << "receding";
  const TensileTerm tensile{Real(0.01), Real(0.2), 2};  // of pressure, of tension, W at the spacing
  const double f = std::pow(3.0 / 2, 4);
  EXPECT_NEAR(tensile.R(Real(3), Real(4), Real(-5)) / (f * (0.01 * 4 + 0.2 * 5)), 1, kInvariant);
  EXPECT_NEAR(tensile.R(Real(3), Real(-4), Real(5)) / (f * (0.2 * 4 + 0.01 * 5)), 1, kInvariant);
}

TEST(FluidPairs, FragmentedFluidCavitates) {
  Config c = periodic_box(4);
  c.density.cavitation_limit = 0.02;
  FluidBox box(c);
  for (std::size_t a = 0; a < box.s.size(); ++a) box.s[a] = a % 2 ? -0.1 : -0.01;  // fragmented, stretched
  box.upload();
  const auto id = box.fluid.id.values();
  const auto m = box.fluid.eos_state.values();
  const auto s = box.fluid.compression.values();
  for (std::size_t k = 0; k < id.size(); ++k) {
    const double density = id[k] % 2 ? -0.02 : -0.01;
    EXPECT_NEAR(m[k].rho, 1000 * (1 + density), 1e-3);
    EXPECT_NEAR(s[k], id[k] % 2 ? -0.1 : -0.01, 1e-7) << "it forgets how far it is fragmented";
    EXPECT_LT(m[k].p_over_rho2, 0) << "it pulls";
  }
}

TEST(FluidPairs, EnergyOfCompressionIsTheWorkOfThePressure) {  // fragmented fluid too
  EquationOfState eos{Real(1e5), 7, Real(300), Real(1000), false};
  eos.least = Real(-0.02);
  for (const double x : {-0.3, -0.05, -0.01, 0.0, 0.03}) {
    const double d = 1e-4, rho = eos.density(Real(x));
    EXPECT_NEAR((eos.energy(x + d) - eos.energy(x - d)) / (2 * d) * rho * rho / 1000, eos.pressure(Real(x)),
                1e-3 * 1e4)
        << x;
  }
}

/// From the friction of v = cos kz in slow flow on a lattice, h/dx = 1.5, kh = 0.24, Pa s.
double viscosity_on_a_lattice(const char* model, const char* kernel, double mu) {
  Config c = periodic_box(10);
  c.domain.max.z = 0.4;
  c.fluid.mu = mu;
  c.visc.model = model;
  c.fluid.kernel = kernel;
  FluidBox box(c);
  const double k = 2 * 3.14159265358979 / 0.4;
  for (std::size_t a = 0; a < box.position.size(); ++a)
    box.velocity[a].x = 1e-3 * c.fluid.c * std::cos(k * box.position[a].z);
  box.upload();
  box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
  const auto v = box.fluid.v_rho.values();
  const auto theta = box.fluid.stress_acceleration.values();
  double top = 0, bottom = 0;
  for (std::size_t a = 0; a < v.size(); ++a) {
    top -= double(theta[a].x) * v[a].v.x * 1000;
    bottom += double(v[a].v.x) * v[a].v.x * k * k;
  }
  return top / bottom;
}

TEST(FluidPairs, ViscosityOnALattice) {  // T-7
  const double mu = 2;
  EXPECT_NEAR(viscosity_on_a_lattice("morris", "wendland_c2", mu), mu, 3e-2 * mu);
  for (const char* kernel : {"wendland_c2", "cubic"})
    EXPECT_NEAR(viscosity_on_a_lattice("signal", kernel, mu), mu, 3e-2 * mu) << kernel;
}

TEST(FluidPairs, SignalsRunFasterBetweenParticlesInRelativeMotion) {  // whichever way
  const WendlandC2 w(0.015);
  const double nu = 2e-3, c = 20;
  const Viscosity viscosity = Viscosity::of(ViscosityModel::signal, 1000 * nu, 1000, c, w);
  const Real3 r{Real(0.01), Real(0.005), 0};
  const Real r2 = norm2(r), F = w.F(std::sqrt(r2));
  for (const double speed : {-4.0, 0.1, 4.0}) {
    const Real3 v = Real(speed) / std::sqrt(r2) * r;
    // alpha = 9 nu / (h c) with this kernel; Eq. 9 times grad W
    const double alpha = 9 * nu / (0.015 * c), u_sig = c + std::abs(speed);
    const Real3 found = viscosity(Real(1e-3), Real(1000), Real(1010), v, r, r2, F);
    const double expected = -1e-3 * alpha * u_sig * speed / 1005 * double(F) * double(r.x);
    EXPECT_NEAR(found.x, expected, 1e-3 * std::abs(expected));
    EXPECT_NEAR(found.y, found.x / 2, 1e-5 * std::abs(expected));
  }
}

TEST(FluidPairs, XsphMovesTheCentreOfMassWithTheMomentum) {  // T-12
  FluidBox box(all_terms(), 0.4, true);
  randomise(box);
  box.upload();
  box.solver->forces(box.fluid, box.walls, {}, box.moment(), 0);
  const auto drift = box.fluid.drift.values();
  const auto b = balance(box, drift);
  EXPECT_LT(norm(b.force) / b.scale, kInvariant);
  const auto v = box.fluid.v_rho.values();
  double along = 0;
  for (std::size_t a = 0; a < v.size(); ++a) along += dot(Vec3d(drift[a]), Vec3d(v[a].v));
  EXPECT_LT(along, 0) << "towards the mean velocity around";
}

TEST(FluidPairs, PenetrationLimitStopsShortOfTheWall) {
  const double dx = 0.01, dt = 1e-4;
  const PenetrationLimit limit{Real(dx), Real(30 / dx), Real(1 / dt)};
  for (const Real sheet : {0, 1}) {  // fluid that others cover; a sheet one particle thick
    double r = 0.6 * dx, v = -20, energy = v * v, nearest = r;
    for (int k = 0; k < 4000; ++k) {
      v -= 2000 * dt;  // pressed on
      v += dt * double(limit(Real(r), Real(-v), sheet));
      r += v * dt;
      nearest = std::min(nearest, r);
      EXPECT_LE(v * v, energy + 2 * 2000 * 0.6 * dx);
    }
    EXPECT_GT(nearest, sheet > 0 ? 0.3 * dx : 0.01 * dx);
    EXPECT_EQ(limit(Real(0.1 * dx), Real(-1), sheet), 0) << "what leaves is let go";
    EXPECT_EQ(limit(Real(0.51 * dx), Real(100), sheet), 0);
    EXPECT_EQ(limit(Real(0.3 * dx), Real(100), sheet) > 0, sheet > 0);
  }
}

TEST(FluidPairs, RepulsionVanishesAtItsRange) {  // T-17
  const Repulsion r{Real(3), Real(0.01), Real(1e9)};
  EXPECT_EQ(r(Real(0.01)), Real(0));
  EXPECT_NEAR(double(r(Real(0.00999999))), 0, 0.01);
  EXPECT_NEAR(double(r(Real(0.005))), 3 * (16 - 4) / 0.005, 0.01);  // r = r0 / 2
  const Repulsion capped{Real(3), Real(0.01), Real(10)};
  EXPECT_EQ(capped(Real(1e-3)), Real(10));
  EXPECT_EQ(capped(Real(-1e-3)), Real(10));  // also behind the wall
}

}  // namespace
}  // namespace BL_SOLVER
