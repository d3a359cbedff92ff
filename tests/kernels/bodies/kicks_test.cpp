// Kicks of one free body or one group of grains, by hand.

#include <gtest/gtest.h>

#include "kernels/bodies/body_kicks.hpp"
#include "kernels/bodies/clumps.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kNear = 1e-12;
const Quat<double> kQuarter = Quat<double>::from_rotation({0, 0, M_PI / 2});

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = kNear) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << "xyz"[k];
}
template <class T>
Span<T> all(std::vector<T>& of) {
  return {of.data(), Index(of.size())};
}

/// A body of 2 kg, a quarter turn about z on, whose centre of mass lies beside its reference point.
struct Lone {
  std::vector<RigidBody> body{1};
  std::vector<Vec3d> x{{1, 2, 3}}, v{{0.5, 0, 0}}, L{{0, 0, 4}}, a{{8, 0, 0}}, alpha{{0, 0, 8}};
  std::vector<Vec4<double>> rotation{to_vec4(kQuarter)};
  std::vector<Vec3d> grain_force{{7, 7, 7}}, grain_torque{{7, 7, 7}}, contact_force{{0, 2, 0}},
      contact_torque{{0, 0, 5}}, fluid_force{{0, 0, 3}}, fluid_torque{{2, 0, 0}};
  std::vector<Vec3d> x_before{{}}, v_before{{}}, omega_before{{}};
  std::vector<Vec4<double>> rotation_before{to_vec4(Quat<double>{})};

  Lone() {
    RigidBody& k = body[0];
    k.mass = 2, k.moments = {1, 2, 4}, k.arm = {0.5, 0, 0}, k.centre = {1, 1, 1};
  }
  BodyFields fields() {
    return {.x = all(x),
            .v = all(v),
            .angular_momentum = all(L),
            .a = all(a),
            .alpha = all(alpha),
            .rotation = all(rotation),
            .grain_force = all(grain_force),
            .grain_torque = all(grain_torque),
            .contact_force = all(contact_force),
            .contact_torque = all(contact_torque),
            .fluid_force = all(fluid_force),
            .fluid_torque = all(fluid_torque),
            .x_before = all(x_before),
            .v_before = all(v_before),
            .omega_before = all(omega_before),
            .rotation_before = all(rotation_before)};
  }
  void kick(double drift = 0, double time = 1, bool begins = false) {
    LoadSum grains = LoadSum::zero();
    grains.add({1, 0, 0}, {0, 3, 0});
    BodyPass{.bodies = body.data(),
             .s = fields(),
             .by_grains = &grains,
             .by_contacts = nullptr,
             .gravity = {0, 0, -10},
             .kick = 0.1,
             .fluid_kick = 0.2,
             .drift = drift,
             .time = time,
             .begins = begins,
             .row = nullptr}(0);
  }
};

TEST(BodyKick, IsByContactsWeightAndFluidEachForItsTime) {
  Lone one;
  one.kick(0, 1, true);
  expect_near(one.x_before[0], {1, 2, 3});
  expect_near(one.v_before[0], {0.5, 0, 0});
  expect_near(one.omega_before[0], {0, 0, 1});
  expect_near(one.grain_force[0], {1, 0, 0});
  // the weight acts at (0, 0.5, 0) from the reference point: (-10, 0, 0) N m
  expect_near(one.v[0], {0.5 + 0.05, 0.1, -1 + 0.3});
  expect_near(one.L[0], {0.1 * -10 + 0.2 * 2, 0.1 * 3, 4 + 0.1 * 5});
  expect_near(one.x[0], {1, 2, 3});
}

TEST(BodyKick, OfABodyThatIsDeafToTheFluid) {
  Lone one;
  one.body[0].fluid = 0;
  one.kick();
  expect_near(one.v[0], {0.55, 0.1, -1});
  expect_near(one.L[0], {-1, 0.3, 4.5});
}

TEST(BodyKick, WaitsForTheReleaseButKnowsItsLoads) {
  Lone one;
  one.body[0].release = 2;
  one.kick(0.5);
  expect_near(one.v[0], {0.5, 0, 0}, 0);
  expect_near(one.x[0], {1, 2, 3}, 0);
  expect_near(one.grain_force[0], {1, 0, 0}, 0);
}

TEST(BodyKick, ComesBeforeTheDrift) {
  Lone one;
  one.kick(0.5);
  expect_near(one.x[0], Vec3d{1, 2, 3} + 0.5 * one.v[0]);
  EXPECT_EQ(norm(one.x_before[0]), 0) << "this kick begins no step";
}

TEST(BodyPose, OfTheMiddleHasTheMeanVelocitiesOfTheStep) {
  Lone one;
  one.x_before[0] = {0.8, 2, 2.6};
  one.rotation_before[0] = to_vec4(Quat<double>::from_rotation({0, 0, M_PI / 2 - 0.6}));
  std::vector<BodyPose> row(1);
  MidPosePass{.bodies = one.body.data(), .s = one.fields(), .dt = 0.2, .row = row.data()}(0);
  expect_near(row[0].origin(), {0.9, 2, 2.8});
  expect_near(row[0].v, {1, 0, 2});
  expect_near(row[0].omega, {0, 0, 3});
  const double angle = M_PI / 2 - 0.3;
  expect_near(row[0].rotation.rotate({1, 0, 0}), {std::cos(angle), std::sin(angle), 0});
}

TEST(BodyAcceleration, IsAMeanOverSteps) {
  Lone one;
  one.v_before[0] = {0.1, 0, 0};      // 0.4 m/s in 0.1 s
  one.omega_before[0] = {0, 0, 0.8};  // and 0.2 rad/s, to L / 4
  BodyAccelerationPass{.bodies = one.body.data(), .s = one.fields(), .dt = 0.1, .weight = 0.25}(0);
  expect_near(one.a[0], {0.75 * 8 + 0.25 * 4, 0, 0});
  expect_near(one.alpha[0], {0, 0, 0.75 * 8 + 0.25 * 2});
}

TEST(RigidBody, GivesWayByMassAndInertia) {
  RigidBody k;
  k.mass = 2, k.moments = {1, 2, 4};
  const Quat<double> none;
  EXPECT_NEAR(k.inverse_effective_mass(none, {0, 3, 0}, {1, 0, 0}), 1.0 / 2 + 9.0 / 4, kNear);
  EXPECT_NEAR(k.inverse_effective_mass(kQuarter, {0, 0, 3}, {1, 0, 0}), 1.0 / 2 + 9.0 / 1, kNear)
      << "its x axis points along y";
  // about a point of contact 3 m off: 4 + 2 3^2 kg m2
  EXPECT_NEAR(k.inverse_rolling_inertia(none, {0, 3, 0}, {0, 0, 1}), 1.0 / 22, kNear);
  k.move = BodyMove::none;
  EXPECT_NEAR(k.inverse_effective_mass(none, {0, 3, 0}, {1, 0, 0}), 9.0 / 4, kNear);
}

/// A clump of two grains, twice as large as its kind, a quarter turn about z on, and a grain by itself.
struct Pair {
  std::vector<RigidBody> kinds{1};
  std::vector<std::uint32_t> kind{0};
  std::vector<double> size{2};
  std::vector<Index> grain{0, 1}, begin{0, 2}, first{0, 1};
  std::vector<Vec3d> offset{{}}, x{{1, 0, 0}}, v{{0.25, 0, 0}}, L{{0, 0, 2}},
      arm{{2, 0, 0}, {-2, 0, 0}, {9, 9, 9}};
  std::vector<Vec4<double>> rotation{to_vec4(kQuarter)};
  std::vector<std::uint32_t> clump{1, 1, 0};
  std::vector<Vec3d> place{{}, {}, {5, 5, 5}};
  std::vector<Real3> grain_v{{}, {}, {5, 5, 5}}, omega{{}, {}, {5, 5, 5}}, v_rest, omega_rest;
  std::vector<Real> radius{1, 1, 1};
  MassPerR3 per_r3{};
  Pair() {
    // 6 kg and 4 kg m2: turns at 0.5 rad/s
    kinds[0].mass = 6.0 / 8, kinds[0].moments = {4.0 / 32, 4.0 / 32, 4.0 / 32};
    per_r3.one = 3;
  }
  ClumpView fields() {
    return {kinds.data(), offset.data(), all(kind),     all(size),  all(x),
            all(v),       all(L),        all(rotation), all(clump), all(arm)};
  }
  FollowPass follow_pass() {
    const Frame frame{{-8, -8, -8}, {8, 8, 8}, false, false, false};
    return {fields(), frame, all(place), {all(grain_v), all(omega)}, {all(v_rest), all(omega_rest)}};
  }
  GainPass gain_pass(std::vector<Vec3d>& momentum, std::vector<Vec3d>& angular) {
    return {.all = fields(),
            .grain = all(grain),
            .mass_per_r3 = per_r3,
            .radius = all(radius),
            .now = {all(grain_v), all(omega)},
            .rest = {all(v_rest), all(omega_rest)},
            .momentum = all(momentum),
            .angular = all(angular)};
  }
  void follow() {
    for (Index i = 0; i < 3; ++i) follow_pass()(i);
  }
  LoadSum gained() {
    LoadSum sum;
    std::vector<Vec3d> momentum(2), angular(2);
    const GainPass gain = gain_pass(momentum, angular);
    gain(0), gain(1);
    SumGainsPass{{all(grain), all(begin), all(first)}, all(momentum), all(angular), &sum}(0);
    return sum;
  }
};

TEST(ClumpPasses, GrainsFollowIt) {
  Pair pair;
  pair.follow();
  expect_near(pair.place[0], {1, 2, 0});
  expect_near(pair.place[1], {1, -2, 0});
  expect_near(pair.place[2], {5, 5, 5}, 0);
  expect_near(Vec3d(pair.grain_v[0]), {0.25 - 1, 0, 0}, kInvariant);
  expect_near(Vec3d(pair.grain_v[1]), {0.25 + 1, 0, 0}, kInvariant);
  expect_near(Vec3d(pair.omega[1]), {0, 0, 0.5}, kInvariant);
}

TEST(ClumpPasses, GainsWhatItsGrainsGainWithTheirRests) {
  Pair pair;
  pair.follow();
  pair.grain_v[0] += Real3{Real(0.5), 0, 0};
  pair.grain_v[1] += Real3{0, 0, Real(0.25)};
  pair.omega[0] += Real3{0, Real(0.125), 0};
  // 3 kg at (0, 2, 0) and (0, -2, 0), 0.4 m R^2 = 1.2 kg m2
  const Vec3d moved{1.5, 0, 0.75}, turned = Vec3d{0, 0, -3} + Vec3d{-1.5, 0, 0} + Vec3d{0, 0.15, 0};
  LoadSum sum = pair.gained();
  expect_near(sum.force(), moved, 20 * kInvariant);
  expect_near(sum.torque(), turned, 20 * kInvariant);
  pair.v_rest = {{}, {Real(0.5), 0, 0}, {9, 9, 9}};
  pair.omega_rest = {{0, 0, Real(0.25)}, {}, {9, 9, 9}};
  sum = pair.gained();
  expect_near(sum.force(), moved + Vec3d{1.5, 0, 0}, 20 * kInvariant);
  expect_near(sum.torque(), turned + Vec3d{0, 0, 3} + Vec3d{0, 0, 0.3}, 20 * kInvariant);
  pair.follow();
  for (Index i = 0; i < 2; ++i) EXPECT_EQ(norm(pair.v_rest[i]) + norm(pair.omega_rest[i]), 0);
  EXPECT_NEAR(norm(pair.gained().force()), 0, 20 * kInvariant);
}

TEST(ClumpPasses, MovesByWhatItGained) {
  Pair pair;
  LoadSum gained = LoadSum::zero();
  gained.add({3, 0, 0}, {0, 0, 2});
  MoveClumpsPass{pair.fields(), all(pair.first), &gained, {}, 0.1}(0);
  expect_near(pair.v[0], {0.75, 0, 0});
  expect_near(pair.L[0], {0, 0, 4});
  expect_near(pair.x[0], {1 + 0.075, 0, 0});
  const double angle = M_PI / 2 + 0.1;  // at 1 rad/s
  expect_near(to_quat(pair.rotation[0]).rotate({1, 0, 0}), {std::cos(angle), std::sin(angle), 0});
}

TEST(ClumpPasses, InOneAreTheThree) {
  Pair one, three;
  for (Pair* pair : {&one, &three}) {
    pair->per_r3.one = 0.7;
    pair->L[0] = {0.3, -0.6, 1.7};
    pair->arm = {{1.9, 0.2, 0.1}, {-1.7, 0.3, -0.6}, {9, 9, 9}};
    pair->follow();
    pair->grain_v[0] += Real3{Real(0.3), Real(0.7), Real(0.1)};
    pair->omega[1] += Real3{Real(-0.6), Real(0.9), Real(0.2)};
  }
  const LoadSum sum = three.gained();
  MoveClumpsPass{three.fields(), all(three.first), &sum, {0, 0, -2}, 0.1}(0);
  three.follow();
  std::vector<Vec3d> none;
  ClumpPass{one.gain_pass(none, none),
            all(one.begin),
            {one.fields(), all(one.first), nullptr, {0, 0, -2}, 0.1},
            one.follow_pass()}(0);
  for (Index i = 0; i < 3; ++i) {
    expect_near(one.place[i], three.place[i], 0);
    expect_near(Vec3d(one.grain_v[i]), Vec3d(three.grain_v[i]), 0);
    expect_near(Vec3d(one.omega[i]), Vec3d(three.omega[i]), 0);
  }
}

TEST(ClumpPasses, GravityDoesNotTurnIt) {
  Pair pair;
  pair.offset[0] = {0.125, 0, 0};  // of the masses of its grains: at (0, 0.25, 0) as it lies
  LoadSum gained = LoadSum::zero();
  gained.add({0, 0, -12}, {-3, 0, 0});  // 6 kg fall at 2 m/s
  MoveClumpsPass{pair.fields(), all(pair.first), &gained, {0, 0, -2}, 0}(0);
  expect_near(pair.v[0], {0.25, 0, -2});
  expect_near(pair.L[0], {0, 0, 2});
}

}  // namespace
}  // namespace BL_SOLVER
