// Fluid between near surfaces: one pair by hand, against what is known of spheres, and through the solver.
#include "kernels/contact/lubrication.hpp"

#include <array>
#include <map>
#include <random>

#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kTight = tolerance(1e-12, 2e-6, 2e-6);

Lubrication film(LubricationForces forces, double cut_off = 1, double least_gap = 0.01) {
  return Lubrication::of({forces, cut_off, least_gap}, 0.5);
}

/// Two spheres along z, i above j.
NearSurfaces pair_at(double R_i, double R_j, double gap) {
  const double L = R_i + R_j + gap;
  return NearSurfaces::spheres(Real(R_i), Real(R_j), {0, 0, L}, L);
}

TEST(Lubrication, SqueezesByTheFormulaBetweenItsCutOffs) {  // T-30
  const Lubrication law = film(LubricationForces::normal);
  const double R = 1.0 / (1 / 0.4 + 1 / 0.6), mu = 0.5, v = -0.3;
  const auto force = [&](double s) {
    return law(pair_at(0.4, 0.6, s), {1, 0, Real(v)}, {}, {5, 0, 0}).force;
  };
  for (const double s : {0.02, 0.1, 0.2}) {
    const double expected = -6 * M_PI * mu * R * R * (1 / s - 1 / R) * v;
    EXPECT_NEAR(force(s).z / expected, 1, tolerance(1e-12, 1e-5, 1e-5)) << s;
    EXPECT_EQ(norm(Real3{force(s).x, force(s).y, 0}), 0) << "normal alone";
  }
  EXPECT_EQ(norm(force(R * 1.0001)), 0);
  EXPECT_LT(norm(force(R * 0.9999)), 1e-3 * norm(force(0.1)));
  EXPECT_EQ(force(0.001 * R).z, force(-0.01 * R).z) << "below the least gap, and in contact, as at it";
  EXPECT_NEAR(force(0.001 * R).z / force(0.01 * R).z, 1, 1e-5);
}

TEST(Lubrication, ShearsAsSpheresAndWallsDo) {
  // coefficients of ln(1/gap): equal spheres pi mu R and 8 pi mu R^3 / 5 [jeffrey84]; a wall 8/15 6 pi mu R,
  // 2/15 6 pi mu R^2, 2/5 8 pi mu R^3, by Goldman, Cox and Brenner (1967)
  const Lubrication law = film(LubricationForces::all);
  const double R = 0.4, mu = 0.5, s = 1e-2 * R, wall_log = std::log(1 / 0.01), log = std::log(0.5 * R / s);
  const ContactForce slide = law(pair_at(R, R, s), {1, 0, 0}, {}, {});
  EXPECT_NEAR(slide.force.x / (-M_PI * mu * R * log), 1, 1e-5);
  const ContactForce spin = law(pair_at(R, R, s), {}, {0, 1, 0}, {});
  EXPECT_NEAR(spin.torque_i.y / (-8 * M_PI * mu * R * R * R * 0.2 * log), 1, 2e-2)
      << "arms grow by half the gap";
  EXPECT_NEAR(spin.torque_j.y / (-8 * M_PI * mu * R * R * R * 0.05 * log), 1, 4e-2);

  const NearSurfaces wall{
      .n = {0, 0, 1}, .gap = s, .R_star = Real(R), .skew = 1, .arm_i = Real(R), .arm_j = 0};
  const ContactForce along = law(wall, {1, 0, 0}, {}, {}), turning = law(wall, {}, {0, 1, 0}, {});
  EXPECT_NEAR(along.force.x / (-8.0 / 15 * 6 * M_PI * mu * R * wall_log), 1, 1e-5);
  EXPECT_NEAR(along.torque_i.y / (0.1 * 8 * M_PI * mu * R * R * wall_log), 1, 1e-5);
  EXPECT_NEAR(turning.force.x / (2.0 / 15 * 6 * M_PI * mu * R * R * wall_log), 1, 1e-5);
  EXPECT_NEAR(turning.torque_i.y / (-0.4 * 8 * M_PI * mu * R * R * R * wall_log), 1, 1e-5);
}

TEST(Lubrication, KeepsMomentumRigidMotionFreeAndTakesEnergy) {  // T-30
  const Lubrication law = film(LubricationForces::all);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3d{normal(random), normal(random), normal(random)}; };
  for (int k = 0; k < 200; ++k) {
    const double R_i = 0.2 + std::abs(normal(random)), R_j = 0.2 + std::abs(normal(random));
    Vec3d n = vector();
    n = n / norm(n);
    const double gap = 0.3 * R_i * R_j / (R_i + R_j), L = R_i + R_j + gap;
    const NearSurfaces at = NearSurfaces::spheres(Real(R_i), Real(R_j), L * n, L);
    const Vec3d v = vector(), w_i = vector(), w_j = vector();
    const ContactForce f = law(at, Real3(v), Real3(w_i), Real3(w_j));
    const Vec3d F = Vec3d(f.force), T_i = Vec3d(f.torque_i), T_j = Vec3d(f.torque_j);
    // forces F and -F a distance L apart, and both torques: no moment
    EXPECT_LT(norm(cross(L * n, F) + T_i + T_j), kTight * (L * norm(F) + norm(T_i) + norm(T_j)));
    EXPECT_LE(dot(F, v) + dot(T_i, w_i) + dot(T_j, w_j), 0);
    const ContactForce rigid = law(at, Real3(cross(w_i, L * n)), Real3(w_i), Real3(w_i));
    EXPECT_LT(norm(rigid.force), 20 * kTight * norm(F));
    // partners that see each other the other way round
    const ContactForce back =
        law(NearSurfaces::spheres(Real(R_j), Real(R_i), -L * n, L), Real3(-v), Real3(w_j), Real3(w_i));
    EXPECT_LT(norm(Vec3d(back.force) + F), kTight * norm(F));
    EXPECT_LT(norm(Vec3d(back.torque_j) - T_i), kTight * (norm(T_i) + norm(T_j)));
  }
}

/// Wet grains in a fluid of viscosity mu, Pa s.
struct WetBench : GrainBench {
  explicit WetBench(LubricationForces forces, double mu = 0.05) {
    config.fluid.mu = mu;
    config.lubrication.forces = forces;
  }
  void begin(const std::vector<Real>& wetness) {
    build();
    grains->wetness.assign(wetness);
    refresh();
    set_poses(1, 0);
    solver->evaluate(*grains, poses());
  }
};

TEST(LubricationSmall, SlowsGrainsThatApproachByTheirGap) {
  // m* dv = -6 pi mu R*^2 (1/s - 1/s_c) ds, which has an integral
  WetBench b(LubricationForces::normal);
  const double R = b.R() / 2, m = b.mass() / 2, s0 = 0.9 * R, v0 = -0.02;
  b.add({-b.R() - s0 / 2, 0, 0}, {-v0 / 2, 0, 0});
  b.add({b.R() + s0 / 2, 0, 0}, {v0 / 2, 0, 0});
  b.config.skin_grain = 0.2;
  b.begin({1, 1});
  ASSERT_GT(s0, b.solver->skin()) << "beyond what contacts alone would list";
  b.run(2e-5, 1200);
  const double s = b.position(1).x - b.position(0).x - 2 * b.R(), v = b.velocity(1).x - b.velocity(0).x;
  const double expected = v0 - 6 * M_PI * 0.05 * R * R / m * (std::log(s / s0) - (s - s0) / R);
  EXPECT_LT(s, 0.8 * s0);
  EXPECT_LT(std::abs(v), 0.9 * std::abs(v0));
  EXPECT_NEAR(v / expected, 1, 1e-3);
  EXPECT_NEAR(b.velocity(0).x + b.velocity(1).x, 0, 1e-6 * std::abs(v0));
}

TEST(LubricationSmall, ActsAsFarAsTheDrierGrainIsWetAndOnWalls) {
  WetBench b(LubricationForces::normal);
  const double s = 0.2 * b.R(), v = 0.01;
  b.plane({0, 0, 0}, {0, 0, 1});
  b.add({0, 0, b.R() + s}, {0, 0, -v});  // beside the wall
  b.add({0, 0, 0.05}, {0, 0, 0});        // a wet one and a half dry one
  b.add({2 * b.R() + 0.2 * b.R(), 0, 0.05}, {-v, 0, 0});
  b.begin({1, 1, Real(0.5)});
  const double R = b.R(), by_wall = 6 * M_PI * 0.05 * R * R * (1 / s - 1 / R) * v;
  EXPECT_NEAR(b.force(0).z / by_wall, 1, 1e-5);
  const double half = 0.5 * R, by_grain = 6 * M_PI * 0.05 * half * half * (1 / (0.2 * R) - 1 / half) * v;
  EXPECT_NEAR(b.force(1).x / (-0.5 * by_grain), 1, 1e-4);
  EXPECT_EQ(b.force(1).x, -b.force(2).x);
  EXPECT_NEAR(b.solver->body_loads(*b.grains, b.poses())[0].force().z / -by_wall, 1, 1e-5)
      << "the wall feels it";
}

/// On another grain, and aslant with spin on a wall that moves towards it and along itself, an advance a
/// substep. Without damping of contacts it takes all that is lost head-on.
TEST(LubricationSmall, WhatItTakesOfAnImpactIsInTheEnergyBooks) {
  for (const bool wall : {false, true}) {
    WetBench b(LubricationForces::all);
    b.config.out.spectra = true;
    b.config.grain.e = wall ? 0.7 : 1;
    const double R = b.R(), speed = wall ? 1 : 0.5;
    if (wall) {
      b.plane({0, 0, -0.01}, {0, 0, 1});
      b.motion = [](int, double t) {
        BodyPose p;
        p.v = {0.1, 0, 0.3}, p.translation = t * p.v;
        return p;
      };
      b.add({0, 0, -0.01 + 2.1 * R}, {0.2, 0, -speed}, {0, 60, 20});
    } else {
      b.add({-1.6 * R, 0, 0}, {speed / 2, 0, 0});
      b.add({1.6 * R, 0, 0}, {-speed / 2, 0, 0});
    }
    b.begin(std::vector<Real>(b.x.size(), Real(1)));
    const auto kinetic = [&] {
      const GrainTotals t = b.solver->totals(*b.grains);
      EXPECT_EQ(t.contacts + t.wall_contacts, 0);
      return t.kinetic + t.rotational;
    };
    const double before = kinetic(), dt = b.contact_time(speed, wall) / 40;
    for (int k = 0; k < int(0.008 / speed * 0.5 / dt); ++k) b.run(dt, 1);
    std::map<std::string, double> terms;
    for (const Quantity& q : b.solver->energy_terms(*b.grains)) terms[q.name] = q.value;
    const double films = terms["grain_dissipated_lubrication"], normal = terms["grain_dissipated_normal"];
    const double lost = before - kinetic() + terms["grain_work_walls"];
    EXPECT_GT(films, 0.3 * lost);
    EXPECT_LT(std::abs(terms["grain_energy_residual"]), 5e-3 * lost) << wall;
    std::uint64_t ended = 0;
    double entered = 0;
    const ContactSpectra& layout = b.solver->spectra()->layout();
    for (const SpectrumBin& bin : b.solver->spectra()->bins())
      ended += bin.count, entered += bin.sum.value() * layout.unit();
    EXPECT_EQ(ended, 2u) << "one by normal force, and by sliding";
    EXPECT_NEAR(entered, normal + terms["grain_dissipated_sliding"] + terms["grain_dissipated_rolling"],
                1e-6 * lost);
    if (wall) {  // does the work of what it changes of the momentum
      const double work = b.mass() * dot(b.motion(0, 0).v, b.velocity(0) - b.v[0]);
      EXPECT_GT(work, 0.1 * lost);
      EXPECT_NEAR(terms["grain_work_walls"] / work, 1, 1e-4);
    } else {
      EXPECT_NEAR(films / lost, 1, 5e-3);
    }
  }
}

TEST(Lubrication, CloudKeepsMomentumAndAngularMomentum) {
  WetBench b(LubricationForces::all, 1.0);
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.6, 1.0);
  for (int i = 0; i < 64; ++i) {
    const Vec3d at = Vec3d(i % 4 - 1.5, i / 4 % 4 - 1.5, i / 16 - 1.5) * 3e-3;
    const Vec3d jitter{normal(random), normal(random), normal(random)};
    b.add(at, at * -10.0 + jitter * 0.05, jitter * 20.0, b.R() * unit(random));
  }
  b.begin(std::vector<Real>(64, Real(1)));
  double scale = 0, turning = 0;
  for (std::size_t i = 0; i < b.v.size(); ++i) {
    scale += b.mass(b.radius[i]) * norm(b.v[i]);
    turning += b.mass(b.radius[i]) * norm(cross(b.x[i], b.v[i]));
  }
  // stress by pairs is what forces on the grains come to: here films alone act
  Buffer<PairMoment<>> moments;
  b.solver->film_moments(*b.grains, moments);
  ASSERT_EQ(b.solver->totals(*b.grains).contacts, 0);
  const auto x = b.grains->x.values();
  const auto force = b.grains->force.values();
  std::array<double, 9> pairs{}, grains{};
  for (const PairMoment<>& one : moments.to_host())
    for (int k = 0; k < 9; ++k) pairs[k] += double(one.row[k / 3][k % 3]);
  double size = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int k = 0; k < 9; ++k) grains[k] += double(force[i][k / 3]) * x[i][k % 3];
  for (const double value : grains) size = std::max(size, std::abs(value));
  ASSERT_GT(size, 0);
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(pairs[k], grains[k], 100 * kInvariant * size) << k;

  const GrainTotals before = b.solver->totals(*b.grains);
  b.run(5e-6, 1500);
  const GrainTotals after = b.solver->totals(*b.grains);
  EXPECT_LT(after.kinetic + after.rotational, 0.9 * (before.kinetic + before.rotational));
  EXPECT_LT(norm(after.momentum - before.momentum), kInvariant * scale);
  EXPECT_LT(norm(after.angular - before.angular), kInvariant * turning);
}

}  // namespace
}  // namespace BL_SOLVER
