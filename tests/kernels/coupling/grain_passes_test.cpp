// What fluid and grains give each other, grain by grain or particle by particle, by hand.

#include <gtest/gtest.h>

#include <numeric>

#include "kernels/boundaries/drop.hpp"
#include "kernels/coupling/buoyancy_pass.hpp"
#include "kernels/coupling/drag_noise.hpp"
#include "kernels/coupling/drag_pass.hpp"
#include "kernels/coupling/interpolation_pass.hpp"
#include "kernels/coupling/porosity_pass.hpp"
#include "kernels/coupling/wetness_pass.hpp"
#include "kernels/smoothing/wendland_c2.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kNear = tolerance(1e-12, 1e-5, 1e-5);

template <class T>
Span<T> all(std::vector<T>& of) {
  return {of.data(), Index(of.size())};
}

/// Mean squares along one axis of what the noise of one step adds to U and omega_f, over 20000 grains of
/// 1e-18 kg whose drag takes the fraction 1 - exp(-x) of their slip.
std::pair<double, double> noise(double x) {
  constexpr std::size_t n = 20000;
  const double R = 1e-6, m = 1e-18, inertia = 0.4 * m * R * R, dt = 1e-3;
  std::vector<Id> id(n);
  std::iota(id.begin(), id.end(), Id(0));
  std::vector<Real> radius(n, Real(R)), K(n, Real(x * m / dt)), K_rot(n, Real(x * inertia / dt));
  std::vector<Real3> U(n), omega(n);
  MassPerR3 per_r3{};
  per_r3.one = m / (R * R * R);
  const DragNoisePass pass{.key = {7, 3},
                           .kT = 4e-21,
                           .dt = dt,
                           .mass_per_r3 = per_r3,
                           .id = all(id),
                           .radius = all(radius),
                           .drag = {all(U), all(omega), all(K), all(K_rot)}};
  double u2 = 0, w2 = 0;
  for (Index j = 0; j < n; ++j) {
    pass(j);
    u2 += norm2(Vec3d(U[j])) / (3 * n);
    w2 += norm2(Vec3d(omega[j])) / (3 * n);
  }
  return {u2 * m / 4e-21, w2 * inertia / 4e-21};
}

/// m U^2 = kT coth(x / 2), so that m v^2 stays kT whatever x = K dt / m. Means over 60000 numbers: to 0.6 %
/// (1 sigma).
TEST(DragNoise, BalancesWhatDragTakesInAStepOfAnyLength) {
  for (const double x : {0.1, 1.0, 20.0}) {
    const auto [u2, w2] = noise(x);
    EXPECT_NEAR(u2 * std::tanh(x / 2), 1, 0.025) << x;
    EXPECT_NEAR(w2 * std::tanh(x / 2), 1, 0.025) << x;
  }
}

TEST(Buoyancy, EndsTheStepWithTheChangeOfTheForce) {
  std::vector<Real3> now{{3, 0, -1}}, force{{1, 1, 1}}, v{{0, 0, 5}};
  std::vector<Real> radius{2};
  MassPerR3 per_r3{};
  per_r3.one = 0.5;
  for (const bool moves : {false, true}) {
    force = {{1, 1, 1}}, v = {{0, 0, 5}};
    BuoyancyKick{.kick = Real(0.1),
                 .mass_per_r3 = per_r3,
                 .moves = moves,
                 .now = all(now),
                 .radius = all(radius),
                 .force = all(force),
                 .v = all(v)}(0);
    const double k = moves ? 0.1 / 4 : 0;
    EXPECT_NEAR(v[0].x, k * 2, kNear);
    EXPECT_NEAR(v[0].y, -k, kNear);
    EXPECT_NEAR(v[0].z, 5 - k * 2, kNear);
    EXPECT_EQ(norm(force[0] - now[0]), 0);
  }
}

TEST(Wetness, IsLinearInWhatFluidFillsOfWhatWallsLeave) {
  const auto wet = [](double S, double free) {
    std::vector<Real> wall_free{Real(free)}, inv_S{S > 0 ? Real(1 / S) : Real(0)}, wetness{-1};
    WetnessPass{Real(0.2), Real(0.8), all(wall_free), all(inv_S), all(wetness)}(0);
    EXPECT_EQ(inv_S[0] > 0, wetness[0] > 0);
    return double(wetness[0]);
  };
  EXPECT_EQ(wet(0, 1), 0);
  EXPECT_EQ(wet(0.15, 1), 0);
  EXPECT_NEAR(wet(0.35, 1), 0.25, kNear);
  EXPECT_NEAR(wet(0.35, 0.7), 0.5, kNear);  // beside a wall: 0.5 of what it leaves
  EXPECT_NEAR(wet(0.9, 1), 1, kNear);
}

TEST(Orifice, SolidsAroundItCountMoreAndMore) {
  Orifice disc{};
  disc.centre = {0, 0, 0}, disc.direction = {0, 0, 1}, disc.half[0] = 0.5, disc.disc = true;
  const OrificeWeight weight{{{-4, -4, -4}, {4, 4, 4}, false, false, false}, {&disc, 1}, 0.1, 0.4};
  EXPECT_EQ(weight({0.2, 0.2, 0.05}), 0);
  EXPECT_NEAR(weight({0.2, 0, 0.2}), 0.15625, kNear);  // a quarter of the way, 3 t^2 - 2 t^3
  EXPECT_NEAR(weight({0.2, 0, 0.3}), 0.5, kNear);
  EXPECT_NEAR(weight({0.8, 0, 0}), 0.5, kNear);  // beside its rim
  EXPECT_NEAR(weight({0.2, 0, 0.6}), 1, kNear);
}

/// Porosity of a fluid particle beside one grain of volume V and velocity (0, 0, 2), and its flux.
struct Beside {
  std::vector<FluidPosition> x{FluidPosition{}};
  std::vector<Real4> volume;
  std::vector<VelocityDensity<>> v_rho{{{1, 0, 0}, 1000}}, flux{{}};
  std::vector<EosState<>> eos_state{{}};
  std::vector<PairPosition> xp{{}}, xp_mid{{}};
  std::vector<Real> mass{Real(0.3)}, eps{0}, factor{0};
  WendlandC2 w{0.1};
  double solid = 0;
  explicit Beside(double fraction) {
    const Real3 r{0, Real(0.05), 0};
    const double V = fraction / double(w.W(Real(0.05)));
    volume = {{0, 0, 2, Real(V)}};
    const PorosityPass<WendlandC2> pass{.w = w,
                                        .shares = true,
                                        .floor = Real(0.3),
                                        .away_from_orifices = {},
                                        .frame = {{-4, -4, -4}, {4, 4, 4}, false, false, false},
                                        .x = all(x),
                                        .volume = all(volume),
                                        .v_rho = all(v_rho),
                                        .mass = all(mass),
                                        .eps = all(eps),
                                        .solid_factor = all(factor),
                                        .flux = all(flux),
                                        .eos_state = all(eos_state),
                                        .xp = all(xp),
                                        .xp_mid = all(xp_mid)};
    auto sum = pass.start(0);
    pass.pair(sum, r, norm2(r), Real(0), volume[0], Unread{});
    pass.finish(0, sum);
  }
};

TEST(Porosity, IsWhatGrainsLeaveButNoLessThanItsFloor) {
  const Beside loose(0.4), dense(0.875);
  EXPECT_NEAR(loose.eps[0], 0.6, kNear);
  EXPECT_EQ(loose.factor[0], 1);
  EXPECT_NEAR(loose.flux[0].v.x, 0.6, kNear);
  EXPECT_NEAR(loose.flux[0].v.z, 0.4 * 2, kNear);
  EXPECT_NEAR(loose.eos_state[0].mass_over_eps, 0.3 / 0.6, kNear);
  EXPECT_EQ(loose.xp[0].weight, loose.eos_state[0].mass_over_eps);
  EXPECT_EQ(loose.xp_mid[0].weight, loose.eos_state[0].mass_over_eps);
  EXPECT_NEAR(dense.eps[0], 0.3, kNear);
  EXPECT_NEAR(dense.factor[0], 0.7 / 0.875, kNear);  // fluid and grains fill the space together
  EXPECT_NEAR(dense.flux[0].v.z, 0.7 * 2, 2 * kNear);
}

/// A grain between two fluid particles, beside a wall that takes 0.4 of its kernel.
TEST(Interpolation, IsTheMeanOverTheFluidAndItsLostMoment) {
  const WendlandC2 w(0.1);
  const Real3 r[2] = {{Real(0.05), 0, 0}, {0, Real(-0.08), 0}};  // from the fluid to the grain
  const double W[2] = {double(w.W(Real(0.05))), double(w.W(Real(0.08)))};
  const double vw[2] = {0.2, 0.1}, S = 0.3;
  std::vector<VelocityDensity<>> v_rho{{{3, 0, 0}, 1000}, {{1, 4, 0}, 900}};
  std::vector<Real4> push{{0, 2, 0, Real(0.8)}, {0, 0, 5, Real(0.5)}};
  std::vector<Real> counted{1, Real(0.25)}, M{Real(1000 * vw[0] / W[0]), Real(900 * vw[1] / W[1])};
  std::vector<Real3> v{{1, 0, 0}}, force{{0, 0, 7}}, arm{{}}, moment{{}};
  std::vector<Real4> volume{{0, 0, 0, 2}};
  std::vector<Real> free{Real(0.6)}, eps{0}, bed_eps{0}, inv_S{0}, rho{0}, fast_slip{0};
  std::vector<FlowSums<>> flow{{}}, fast{{}};
  std::vector<SymmetricMatrix<Real>> inv_M{{}};
  const InterpolationPass<WendlandC2, true, true> pass{.w = w,
                                                       .S_least = Real(0.01),
                                                       .eps_min = Real(0.3),
                                                       .v_rho = all(v_rho),
                                                       .fluid = {all(push), all(counted)},
                                                       .v = all(v),
                                                       .fluid_force = all(force),
                                                       .volume = all(volume),
                                                       .wall_free = all(free),
                                                       .eps = all(eps),
                                                       .bed_eps = all(bed_eps),
                                                       .surroundings = {.inv_S = all(inv_S),
                                                                        .rho = all(rho),
                                                                        .flow = all(flow),
                                                                        .fast = all(fast),
                                                                        .fast_slip = all(fast_slip),
                                                                        .stress = {all(arm), all(inv_M)},
                                                                        .drag = {},
                                                                        .lost_moment = all(moment)}};
  auto sum = pass.start(0);
  for (int a = 0; a < 2; ++a) pass.pair(sum, r[a], norm2(r[a]), M[a], v_rho[a], push[a], counted[a]);
  pass.finish(0, sum);
  EXPECT_NEAR(inv_S[0], 1 / S, 10 * kNear);
  EXPECT_NEAR(eps[0], (0.2 * 0.8 + 0.1 * 0.5) / S, kNear);
  EXPECT_NEAR(rho[0], (0.2 * 1000 + 0.1 * 900) / S, 1000 * kNear);
  EXPECT_NEAR(bed_eps[0], 1 - 0.3 / ((0.2 + 0.1 * 0.25) / S), kNear)
      << "the solids by the weight that they count";
  EXPECT_NEAR(flow[0].u.x / S, 0.4 / S, 10 * kNear);
  EXPECT_NEAR(flow[0].u.y / S, 0.4 / S, 10 * kNear);
  // slips 2 and 4: the mean of u^2 by the weight V W, over that of |u|
  EXPECT_NEAR(fast_slip[0], (0.2 * 4 + 0.1 * 16) / (0.2 * 2 + 0.1 * 4), 10 * kNear);
  const Vec3d at = Vec3d{-0.05 * 0.2, 0.08 * 0.1, 0} / S;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(arm[0][k], at[k], kNear);
  // V times the moment of the stress about the grain, less what the walls bear, 0.4 of the missing 0.7
  const Vec3d turn = -(W[0] * cross(Vec3d(r[0]), Vec3d{0, 2, 0}) + W[1] * cross(Vec3d(r[1]), Vec3d{0, 0, 5}));
  const Vec3d lost = 2.0 * turn - (0.4 / 0.7) * cross(at, Vec3d{0, 0, 7});
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(moment[0][k], lost[k], kNear * norm(turn)) << "xyz"[k];
}

TEST(DragLine, GoesThroughTheLawAtTheMeanAndTheFastSlip) {
  const auto ergun = [](Real w) { return 3 + 2 * w; };
  const DragLine line = drag_line(ergun, Real(1), Real(4));
  EXPECT_NEAR(line.still, 3, 10 * kNear);
  EXPECT_NEAR(line.slope, 2, 10 * kNear);
  EXPECT_NEAR(line.at(Real(2.5)), 8, 20 * kNear);
  const DragLine one = drag_line(ergun, Real(2), Real(2));  // all slips are one
  EXPECT_EQ(one.slope, 0);
  EXPECT_NEAR(one.still, 7, 10 * kNear);
  const DragLine steep = drag_line([](Real w) { return w * w; }, Real(1), Real(4));  // not below zero at rest
  EXPECT_NEAR(steep.still, 0, 100 * kNear);
  EXPECT_NEAR(steep.slope, 4, 10 * kNear);
  EXPECT_EQ(drag_line([](Real w) { return 9 - w; }, Real(1), Real(4)).slope, 0);  // it does not fall
}

TEST(Drop, GivesEachGrainTheNextIdAndPlace) {
  std::vector<NewGrain> grain{{{1, 2, 3}, {0, 0, -1}, 0.5, 0}, {{4, 5, 6}, {0, 1, 0}, 0.25, 1}};
  std::vector<Id> id(3);
  std::vector<Vec3d> x(3);
  std::vector<Real3> v(3);
  std::vector<Real> radius(3), eps(3);
  std::vector<std::uint32_t> material(3);
  std::vector<Index> from(3);
  const DropPass pass{.grain = all(grain),
                      .place = 1,
                      .first = 40,
                      .id = all(id),
                      .x = all(x),
                      .v = all(v),
                      .radius = all(radius),
                      .eps = all(eps),
                      .material = all(material),
                      .source_index = all(from),
                      .clumps = 0,
                      .clump = {},
                      .member = {},
                      .arm = {},
                      .clump_d = {}};
  pass(0), pass(1);
  EXPECT_EQ(id[1], 40u);
  EXPECT_EQ(id[2], 41u);
  EXPECT_EQ(norm(x[2] - Vec3d{4, 5, 6}), 0);
  EXPECT_EQ(v[1].z, -1);
  EXPECT_EQ(radius[2], Real(0.25));
  EXPECT_EQ(material[2], 1u);
  EXPECT_EQ(from[1], kNone);
  EXPECT_EQ(eps[1], 1);
}

}  // namespace
}  // namespace BL_SOLVER
