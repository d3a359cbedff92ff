// Collisions through the whole solver: restitution, duration, friction, what a gas of grains conserves.
#include <random>

#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

/// Two grains that just touch and approach each other at `speed`; returns the ratio of speeds after and
/// before.
double rebound(const ContactConfig& contact, double e, double speed) {
  GrainBench b;
  b.config.contact = contact;
  b.config.contact.rolling = "none";
  b.config.grain.e = e;
  b.add({-b.R(), 0, 0}, {0.5 * speed, 0, 0});
  b.add({b.R(), 0, 0}, {-0.5 * speed, 0, 0});
  b.start();
  const double t_c =
      contact.normal == "linear" ? M_PI * std::sqrt(0.5 * b.mass() / contact.k) : b.contact_time(speed);
  bool touched = false;
  for (int step = 0; step < 1500; step += GrainBench::kChunk) {
    b.run(t_c / 100, GrainBench::kChunk);
    const bool touches = b.solver->totals(*b.grains).contacts > 0;
    if (touched && !touches) break;
    touched = touched || touches;
  }
  EXPECT_TRUE(touched);
  EXPECT_NEAR(b.velocity(0).x + b.velocity(1).x, 0, 1e-6 * speed);
  return (b.velocity(1).x - b.velocity(0).x) / speed;
}

TEST(Impact, HertzRestitutionIsTheOneAskedForAtAnySpeed) {
  for (bool clip : {true, false})
    for (double e : {0.1, 0.3, 0.5, 0.7, 0.9, 0.99})
      for (double speed : {1e-3, 1.0}) {
        ContactConfig c;
        c.clip_tension = clip;
        EXPECT_NEAR(rebound(c, e, speed), e, 2e-3) << "clip " << clip << ", speed " << speed;
      }
}

TEST(Impact, LinearRestitutionIsTheOneAskedFor) {
  for (bool clip : {true, false})
    for (double e : {0.15, 0.3, 0.5, 0.7, 0.9, 0.99})
      for (double speed : {1e-3, 1.0}) {
        ContactConfig c;
        c.normal = NormalLaw::linear, c.tangential = SlidingLaw::linear;
        c.k = 1e4;
        c.clip_tension = clip;
        EXPECT_NEAR(rebound(c, e, speed), e, 2e-3) << "clip " << clip << ", speed " << speed;
      }
}

TEST(Impact, PaperDampingReboundsLess) {
  ContactConfig c;
  c.he_damping = true;
  c.clip_tension = false;
  const double asked[] = {0.9, 0.6, 0.3}, got[] = {0.891, 0.571, 0.262};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(rebound(c, asked[k], 0.1), got[k], 2e-3);
}

TEST(Impact, DurationAndDeepestOverlapAreHertz) {
  GrainBench b;
  b.config.grain.e = 1;
  b.add({-b.R(), 0, 0}, {0.05, 0, 0});
  b.add({b.R(), 0, 0}, {-0.05, 0, 0});
  b.start();
  const double dt = 1.737e-4 / 2000;
  double deepest = 0, before = 0, duration = 0;
  for (int step = 1; step < 2100; ++step) {
    b.run(dt, 1);
    const double overlap = 2 * b.R() - (b.position(1).x - b.position(0).x);
    deepest = std::max(deepest, overlap);
    if (step > 10 && overlap <= 0) {
      duration = (step - 1 + before / (before - overlap)) * dt;
      break;
    }
    before = overlap;
  }
  EXPECT_NEAR(duration / 1.737e-4, 1, 1e-3);
  EXPECT_NEAR(deepest / 5.901e-6, 1, 1e-3);
}

TEST(Impact, StickingRecoilsByTheDampingOfItsSpring) {
  // Both springs swing alike at k_t = 2/7 k, where the point of contact moves as 2/7 of the mass would.
  // Undamped it comes back with about -1. A damping of c_n sqrt(k_t/k) has sqrt(7/2) of the damping ratio
  // along the normal. Near the end, where damping pulls, friction has nothing left to act with: hence e close
  // to 1.
  const double e = 0.9;
  for (const double damping : {1.0, 0.5, 0.0}) {
    GrainBench b;
    b.config.contact.normal = NormalLaw::linear, b.config.contact.tangential = SlidingLaw::linear;
    b.config.contact.k = 1e4;
    b.config.contact.clip_tension = false;
    b.config.contact.tangential_damping = damping;
    b.config.grain.e = e;
    b.config.grain.mu = 5;
    const double speed = 0.1, along = 0.005;
    b.plane({0, 0, 0}, {0, 0, 1});
    b.add({0, 0, b.R()}, {along, 0, -speed});
    b.start();
    b.run(M_PI * std::sqrt(b.mass() / b.config.contact.k) / 2000, 2400);
    ASSERT_EQ(b.solver->totals(*b.grains).wall_contacts, 0);
    const double beta = -std::log(e) / std::hypot(M_PI, std::log(e)), w = M_PI / std::sqrt(1 - beta * beta);
    const double g = damping * beta * std::sqrt(3.5), wd = std::sqrt(1 - g * g);
    const double expected = std::exp(-g * w) * (std::cos(wd * w) - g / wd * std::sin(wd * w));
    const double point = b.velocity().x - b.spin().y * b.R();
    EXPECT_NEAR(point / along, expected, 0.01) << "damping " << damping;
  }
}

TEST(Impact, AWallOfItsOwnMaterialGivesWayByIt) {
  GrainBench b;
  b.plane({0, 0, 0}, {0, 0, 1});
  b.config.wall.bodies[0].E = 3e9;
  b.config.wall.bodies[0].nu = 0.2;
  const double overlap = 1e-6;
  b.add({0, 0, b.R() - overlap});
  b.start();
  const auto& g = b.config.grain;
  const double E = 1 / ((1 - g.nu * g.nu) / g.E + (1 - 0.04) / 3e9);
  const double force = 4.0 / 3 * E * std::sqrt(b.R()) * std::pow(overlap, 1.5);
  EXPECT_NEAR(b.force().z / force, 1, 1e-3);
  EXPECT_GT(force, 1.5 * 4.0 / 3 * b.E_star() * std::sqrt(b.R()) * std::pow(overlap, 1.5))
      << "as if of grains";
}

TEST(Impact, GrossSlipObeysCoulombThroughout) {
  GrainBench b;
  b.config.grain.mu = 0.1;
  b.config.grain.E = 1e10;
  b.config.grain.e = 0.8;
  const double speed = 0.1, along = 1.0;
  b.plane({0, 0, 0}, {0, 0, 1});
  b.add({0, 0, b.R()}, {along, 0, -speed});
  b.start();
  b.run(b.contact_time(speed, true) / 400, 1000);
  ASSERT_EQ(b.solver->totals(*b.grains).wall_contacts, 0);
  const double e = b.velocity().z / speed, slip = b.config.grain.mu * (1 + e) * speed;
  EXPECT_NEAR(e, 0.8, 2e-3);
  EXPECT_NEAR((along - b.velocity().x) / slip, 1, 1e-3);
  EXPECT_NEAR(b.spin().y / (2.5 * slip / b.R()), 1, 1e-3);
}

/// A cloud of grains that falls together: many collisions, then dispersal.
struct Cloud : GrainBench {
  Cloud(bool sizes, int n = 5) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> unit(0.6, 1.0);
    for (int i = 0; i < n * n * n; ++i) {
      const double r = R() * (sizes ? unit(random) : 1.0);
      const Vec3d at = Vec3d(i % n - 2.0, i / n % n - 2.0, i / (n * n) - 2.0) * 2.9e-3;
      const Vec3d jitter{normal(random), normal(random), normal(random)};
      add(at, at * -40.0 + jitter * 0.05,
          sizes ? Vec3d(normal(random), normal(random), normal(random)) * 20.0 : Vec3d{}, r);
    }
  }
  double momentum_scale() const {
    double s = 0;
    for (std::size_t i = 0; i < v.size(); ++i) s += mass(radius[i]) * norm(v[i]);
    return s;
  }
};

TEST(Impact, GasOfGrainsKeepsMomentumAndAngularMomentum) {
  Cloud b(true);
  b.config.contact.rolling = "epsd";
  b.config.grain.mu_r = 0.1;
  b.start();
  const GrainTotals before = b.solver->totals(*b.grains);
  double angular_scale = 0;
  for (std::size_t i = 0; i < b.v.size(); ++i)
    angular_scale += norm(cross(b.x[i], b.v[i])) * b.mass(b.radius[i]);
  double contacts = 0;
  for (int k = 0; k < 20; ++k) {
    b.run(4e-6, 100);
    contacts = std::max(contacts, b.solver->totals(*b.grains).contacts);
  }
  const GrainTotals after = b.solver->totals(*b.grains);
  EXPECT_GT(contacts, 10);
  EXPECT_GT(b.refreshes, 3);
  EXPECT_LT(after.kinetic, 0.9 * before.kinetic);
  EXPECT_LT(norm(after.momentum - before.momentum), kInvariant * b.momentum_scale());
  EXPECT_LT(norm(after.angular - before.angular), kInvariant * angular_scale);
}

TEST(Impact, FrictionlessElasticGasKeepsEnergy) {
  Cloud b(false);
  b.config.grain.e = 1;
  b.config.grain.mu = 0;
  b.start();
  const GrainTotals before = b.solver->totals(*b.grains);
  double least = before.kinetic;
  for (int k = 0; k < 40; ++k) {
    b.run(1e-6, 200);
    const GrainTotals now = b.solver->totals(*b.grains);
    least = std::min(least, now.kinetic);
    EXPECT_NEAR((now.kinetic + now.elastic) / before.kinetic, 1, 1e-4) << k;
  }
  EXPECT_LT(least, 0.9 * before.kinetic) << "energy must pass through the contacts";
  EXPECT_EQ(b.solver->totals(*b.grains).rotational, 0);
}

}  // namespace
}  // namespace BL_SOLVER
