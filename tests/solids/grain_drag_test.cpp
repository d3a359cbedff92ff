// The grain's side of the coupling: drag is integrated exactly while the fluid is frozen.
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

/// One grain in a fluid of velocity U with drag coefficients K (kg/s) and K_rot (N m s).
struct InFluid : GrainBench {
  void immerse(const Vec3d& U, double K, const Vec3d& omega_f = {}, double K_rot = 0) {
    const std::size_t n = x.size();
    grains->fluid_velocity.assign(std::vector<Real3>(n, Real3(U)));
    grains->fluid_angular_velocity.assign(std::vector<Real3>(n, Real3(omega_f)));
    grains->drag_coefficient.assign(std::vector<Real>(n, Real(K)));
    grains->rot_drag_coefficient.assign(std::vector<Real>(n, Real(K_rot)));
  }
};

TEST(GrainDrag, TerminalVelocityIsExactForAnyStiffness) {
  for (double stiffness : {1e-2, 1.0, 1e2, 1e4, 1e8}) {
    InFluid b;
    b.config.gravity = {0, 0, -9.81};
    b.add({0, 0, 0}, {0.3, 0, 0.2});
    b.start();
    const double dt = 1e-5, rate = stiffness / dt, K = rate * b.mass();
    const Vec3d U{0.5, 0, 0};
    b.immerse(U, K);
    b.run(dt, 5000);
    const double slip = -9.81 / rate;
    EXPECT_NEAR(b.velocity().x / U.x, 1, tolerance(1e-12, 1e-6, 1e-6)) << stiffness;
    // what drag leaves of g dt is known to the rounding of g dt
    EXPECT_NEAR(b.velocity().z, slip, tolerance(1e-9, 1e-5, 1e-5) * -slip + 1e-15 * 9.81 * dt) << stiffness;
  }
}

TEST(GrainDrag, RelaxesExactlyAtAnyRate) {
  for (const double x : {1e-12, 1e-6, 0.99e-4, 1.01e-4, 1e-2, 1.0, 50.0}) {
    const Relaxation slip(x / 0.1, 0.1, true);
    EXPECT_NEAR(slip.fraction / -std::expm1(-x), 1, 1e-15) << x;
    // psi(x) - 1, below 1 by its series; as a difference it is known to 1e-16 / x
    const double lag =
        x < 1 ? -x / 2 * (1 - x / 3 * (1 - x / 4 * (1 - x / 5 * (1 - x / 6)))) : -std::expm1(-x) / x - 1;
    EXPECT_NEAR(slip.lag / lag, 1, 1e-8) << x;
  }
}

TEST(GrainDrag, FollowsTheExponentialAndBooksItsImpulse) {
  InFluid b;
  b.config.gravity = {0, 0, -9.81};
  b.add({0, 0, 0}, {1, 0, 0});
  b.start();
  const double dt = 1e-4, K = b.mass() / 3e-3;  // relaxation in 3 ms
  b.immerse({}, K);
  Vec3d impulse;
  for (int k = 0; k < 50; ++k) {
    b.run(dt / 4, 4);
    impulse += Vec3d(b.of(b.grains->impulse, 0));
    EXPECT_NEAR(b.velocity().x / std::exp(-b.time / 3e-3), 1, tolerance(1e-12, 1e-6, 1e-6));
    EXPECT_NEAR(
        norm(Vec3d(b.of(b.grains->drag_force, 0)) * dt - Vec3d(b.of(b.grains->impulse, 0))) / norm(impulse),
        0, tolerance(1e-12, 1e-6, 1e-6));
  }
  const Vec3d change = (b.velocity() - Vec3d{1, 0, 0} - b.config.gravity * b.time) * b.mass();
  EXPECT_LT(norm(impulse - change), tolerance(1e-12, 1e-6, 1e-6) * norm(change));
}

TEST(GrainDrag, EnergyOfTheSlipNeverRises) {
  for (double power = -2; power <= 8; power += 1) {
    InFluid b;
    const Vec3d U{0.1, -0.2, 0.05};
    b.add({0, 0, 0}, {1, 0.5, -0.3}, {100, -50, 20});
    b.start();
    const double dt = 1e-4;
    b.immerse(U, std::pow(10, power) * b.mass() / dt, {},
              std::pow(10, power) * 0.4 * b.mass() * b.R() * b.R() / dt);
    double slip = norm(b.velocity() - U), spin = norm(b.spin());
    for (int k = 0; k < 20; ++k) {
      b.run(dt, 1);
      EXPECT_LE(norm(b.velocity() - U),
                slip * (1 + tolerance(1e-15, 1e-7, 1e-7)) + tolerance(1e-16, 1e-8, 1e-8));
      EXPECT_LE(norm(b.spin()), spin);
      slip = norm(b.velocity() - U), spin = norm(b.spin());
    }
  }
}

TEST(GrainDrag, SpinDecaysByViscousTorque) {
  InFluid b;
  b.add({0, 0, 0}, {}, {0, 0, 1});
  b.start();
  const double mu = 1e-3, d = 2 * b.R(), K_rot = M_PI * mu * d * d * d,
               inertia = 0.4 * b.mass() * b.R() * b.R();
  b.immerse({}, 0, {}, K_rot);
  double torque_impulse = 0;
  for (int k = 0; k < 100; ++k) {
    b.run(1e-3, 20);
    torque_impulse += b.of(b.grains->spin_impulse, 0).z;
  }
  const double rate = -std::log(b.spin().z) / b.time;
  EXPECT_NEAR(rate / (K_rot / inertia), 1, 1e-3);
  EXPECT_NEAR(torque_impulse / (inertia * (b.spin().z - 1)), 1, tolerance(1e-12, 1e-5, 1e-5));
}

TEST(GrainDrag, ExplicitDragIsOfTheSameOrder) {
  InFluid b;
  b.config.couple.integrator = "explicit";
  b.add({0, 0, 0}, {1, 0, 0});
  b.start();
  b.immerse({}, b.mass() / 1e-7);  // far stiffer than contacts
  const StepLimit stiff = b.solver->stable_dt(*b.grains);
  EXPECT_NEAR(stiff.seconds / 5e-8, 1, 1e-6) << "half of the time in which it relaxes";
  EXPECT_EQ(stiff.limit, Limit::grain_drag);
  b.immerse({}, b.mass() / 1e-2);
  bool listed = false;
  for (const auto& l : b.solver->limits(b.solver->watch(*b.grains)))
    if (l.limit == Limit::grain_drag) {
      listed = true;
      EXPECT_NEAR(l.seconds, 5e-3, 1e-8);
    }
  EXPECT_TRUE(listed);
  b.run(1e-5, 1000);
  EXPECT_NEAR(b.velocity().x, std::exp(-1.0), 1e-3);
}

TEST(GrainDrag, HeldGrainsRestButTheFluidFeelsThem) {
  InFluid b;
  b.config.gravity = {0, 0, -9.81};
  b.add({0, 0, 0.01}, {0, 0, 0});
  b.start();
  b.immerse({0.2, 0, 0}, 1e-3, {0, 3, 0}, 1e-9);
  b.run(1e-4, 10, true);
  EXPECT_EQ(b.position(), Vec3d(0, 0, 0.01));
  EXPECT_EQ(norm(b.velocity()), 0);
  EXPECT_NEAR(b.of(b.grains->impulse, 0).x / (1e-3 * 0.2 * 1e-3), 1, 1e-6);
  EXPECT_NEAR(b.of(b.grains->spin_impulse, 0).y / (1e-9 * 3 * 1e-3), 1, 1e-6);
  b.run(1e-4, 10);
  EXPECT_LT(b.position().z, 0.01) << "released";

  InFluid fixed;
  fixed.config.gravity = {0, 0, -9.81};
  fixed.config.grain.fixed = true;
  fixed.add({0, 0, 0.01});
  fixed.start();
  fixed.run(1e-4, 10);
  EXPECT_EQ(fixed.position(), Vec3d(0, 0, 0.01));
}

TEST(GrainDrag, FluidForceActsAsAnyOther) {
  InFluid b;
  b.add({0, 0, 0});
  b.start();
  b.grains->fluid_force.assign({Real3(0, 0, Real(b.mass()))});  // 1 m/s2
  b.run(1e-4, 1000);
  EXPECT_NEAR(b.velocity().z, 0.1, 1e-6);
  EXPECT_NEAR(b.position().z, 0.005, 1e-8);
}

}  // namespace
}  // namespace BL_SOLVER
