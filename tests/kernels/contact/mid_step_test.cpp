// What slides is taken with the normal in the middle of the substep. With that of its end (a contact whose
// geometry has no drift) a small grain sticks to larger ones that it rolls over [vyas25].
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/contact_law.hpp"
#include "tests/support/saddle.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kR = 0.25e-3, kTurn = 2 * M_PI;
const double kMass = 2500 * 4.0 / 3 * M_PI * kR * kR * kR;

/// Of grains of d = 2 kR beside others `ratio` times as large.
Config sand(double mu, double ratio = 1) {
  Config c;
  c.grain.d = c.grain.d_min = 2 * kR, c.grain.d_max = 2 * kR * ratio;
  c.grain.mu = mu, c.grain.e = 0.5;
  c.contact.rolling = "none";
  return c;
}
double default_substep(const Config& c) {
  double dt = std::numeric_limits<double>::infinity();
  for (const StepLimit& limit : solid_parameters(c).limits.at(0)) dt = std::min(dt, limit.seconds);
  return dt;
}

enum class Normal { middle, end };

/// Angle from the top at which a grain leaves the saddle, degrees; 180 if it gets under it.
double release(double mu, double ratio, double substeps, Normal normal = Normal::middle) {
  const Config c = sand(mu, ratio);
  const ContactLaw law = contact_law_of(c);
  const double dt = default_substep(c) * substeps;
  const Saddle saddle{kR, ratio};
  const Sphere small{Real(kR), Real(kMass)}, large{Real(ratio * kR), Real(cube(ratio) * kMass)};
  Vec3d x = saddle.start(1), v, omega;
  ContactHistory histories[2];
  double left = 0;
  for (;;) {
    x += dt * v;
    Vec3d force{0, 0, -Saddle::kG * kMass}, torque;
    bool touches = false;
    for (const int side : {0, 1}) {
      ContactHistory& h = histories[side];
      const Vec3d r = x - saddle.large(side);
      const double distance = norm(r), overlap = saddle.apart() - distance;
      if (!(overlap > 0)) {
        h = {};
        continue;
      }
      touches = true;
      const Vec3d drift = normal == Normal::middle ? dt * v : Vec3d{};
      const ContactForce f = law(sphere_contact(small, large, r, distance, overlap, drift), Real3(v),
                                 Real3(omega), {}, Real(dt), h);
      force += Vec3d(f.force), torque += Vec3d(f.torque_i);
    }
    v += force * (dt / kMass), omega += torque * (dt / (0.4 * kMass * kR * kR));
    const double angle = std::atan2(x.x, x.z) * 180 / M_PI;
    if (touches) left = angle;
    if (saddle.gap(x) > 0.1 * kR) return left;
    if (angle > 150 || angle < 0) return 180;
  }
}

TEST(MidStep, ARollingGrainFallsOffTheSaddleOfTwoLargerOnes) {
  for (const double ratio : {1.0, 5.0, 10.0, 20.0, 50.0, 100.0})
    EXPECT_NEAR(release(5, ratio, 1), Saddle({kR, ratio}).release(1), 1) << "ratio " << ratio;
}

TEST(MidStep, WithTheNormalOfTheEndItSticksToThem) {
  for (const double ratio : {2.0, 5.0})
    EXPECT_EQ(release(5, ratio, 1, Normal::end), 180) << "ratio " << ratio;
  EXPECT_GT(release(0.8, 10, 1, Normal::end), Saddle({kR, 10}).release(1) + 10)
      << "it slides, and still holds on";
}

TEST(MidStep, TheAngleDoesNotDependOnTheSubstep) {
  for (const double ratio : {5.0, 10.0, 20.0, 50.0, 100.0})
    EXPECT_NEAR(release(0.5, ratio, 1), release(0.5, ratio, 0.1), 0.1) << "ratio " << ratio;
}

/// Spring of two grains of unlike sizes that turn as one body ten times about an axis aslant, over kR.
double stretch_in_rotation(Normal normal) {
  const ContactLaw law = contact_law_of(sand(5));
  const Sphere small{Real(kR), Real(kMass)}, large{Real(2 * kR), Real(8 * kMass)};
  const double overlap = 1e-3 * kR, distance = 3 * kR - overlap, dt = 1e-6;
  const int substeps = 20000;  // of a turn
  const Vec3d axis = Vec3d{0.6, 0, 0.8}, omega = axis * (kTurn / substeps / dt);
  const auto at = [&](int s) {
    return Quat<double>::from_rotation(axis * (kTurn / substeps * s)).rotate(Vec3d{0, 0, distance});
  };
  ContactHistory h;
  for (int s = 1; s <= 10 * substeps; ++s) {
    const Vec3d r = at(s), drift = r - at(s - 1);
    law(sphere_contact(small, large, r, distance, overlap, normal == Normal::middle ? drift : Vec3d{}),
        Real3(drift * (1 / dt)), Real3(omega), Real3(omega), Real(dt), h);
  }
  return norm(h.xi) / kR;
}

TEST(MidStep, TwoGrainsThatTurnAsOneBodyDoNotSlide) {
  // arms and velocities are Real: 188 kR of way past each other, times its round-off
  EXPECT_LT(stretch_in_rotation(Normal::middle), tolerance(1e-6, 2e-5, 2e-5));
  EXPECT_GT(stretch_in_rotation(Normal::end), 1e-3);
}

struct Round {
  double energy, axial;  ///< J; m
};
/// Of a grain that rolls once round inside a cylinder of 20 kR, without gravity, and drifts along it.
Round roll_round(double substeps) {
  const Config c = sand(0.5);
  const ContactLaw law = contact_law_of(c);
  const double dt = default_substep(c) * substeps, orbit = 19 * kR, inertia = 0.4 * kMass * kR * kR;
  const Sphere grain{Real(kR), Real(kMass)};
  // rolls, and spins about its normal
  Vec3d x{orbit, 0, 0}, v{0, 0.1, 0.05}, omega{200, 0.05 / kR, -0.1 / kR}, before{-1, 0, 0};
  ContactHistory h;
  for (double angle = 0, last = 0; angle < kTurn;) {
    x += dt * v;
    const double across = std::hypot(x.x, x.y), overlap = across - orbit;
    const Vec3d n{-x.x / across, -x.y / across, 0};
    if (overlap > 0) {
      const ContactForce f =
          law(wall_contact(grain, before, n, overlap), Real3(v), Real3(omega), {}, Real(dt), h);
      v += Vec3d(f.force) * (dt / kMass), omega += Vec3d(f.torque_i) * (dt / inertia);
    } else {
      h = {};
    }
    before = n;
    const double now = std::atan2(x.y, x.x);
    angle += std::remainder(now - last, kTurn), last = now;
  }
  return {0.5 * kMass * norm2(v) + 0.5 * inertia * norm2(omega), x.z};
}

TEST(MidStep, AGrainThatRollsRoundACylinderKeepsItsEnergy) {
  const Round fine = roll_round(0.1), coarse = roll_round(1);
  EXPECT_NEAR(coarse.energy / fine.energy, 1, 1e-3);
  EXPECT_NEAR(coarse.axial / fine.axial, 1, 1e-3);
}

}  // namespace
}  // namespace BL_SOLVER
