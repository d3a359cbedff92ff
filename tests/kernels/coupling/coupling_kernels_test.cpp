#include <gtest/gtest.h>

#include <cmath>

#include "kernels/coupling/drag_pass.hpp"
#include "kernels/coupling/limit_pass.hpp"
#include "kernels/smoothing/wendland_c2.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

TEST(SpinDrag, IsKirchhoffsAtLowReynoldsNumber) {
  const double d = 2e-3, rho = 1000, mu = 1e-3;
  const double expected = M_PI * mu * d * d * d;
  for (double spin : {0.0, 1e-6, 1.0, 7.9})  // Re = rho d2 spin / mu, up to 31.6
    EXPECT_NEAR(spin_drag(Real(d), Real(rho), Real(mu), Real(spin)), expected, kInvariant * expected);
}

TEST(SpinDrag, BothBranchesMeet) {
  const double below = spin_drag(Real(2e-3), 1000, Real(1e-3), Real(7.999));
  const double above = spin_drag(Real(2e-3), 1000, Real(1e-3), Real(8.001));
  EXPECT_NEAR(above / below, 1, 3e-3);
}

TEST(SpinDrag, FollowsTheFitAtHighReynoldsNumber) {
  const double d = 2e-3, rho = 1000, mu = 1e-3, spin = 250;  // Re = 1000
  const double per_spin = 0.5 * rho * std::pow(d / 2, 5) * (12.9 / std::sqrt(1000.0) + 0.1284) * spin;
  EXPECT_NEAR(spin_drag(Real(d), Real(rho), Real(mu), Real(spin)), per_spin, 5 * kInvariant * per_spin);
}

/// In Stokes flow a grain reads 0.537 d / h_c of its own slip through Wendland's kernel (specification, 14),
/// and of its volume the integral of W^2.
TEST(OwnWake, IsThatOfStokesFlowAndFadesWithInertiaAndOthers) {
  const double h_c = 0.02, mu = 0.5, d = 0.004;
  const OwnWake own = OwnWake::of(WendlandC2(h_c), h_c, mu, true);
  const Real K = Real(3 * M_PI * mu * d);
  EXPECT_NEAR(own.fraction(K, 0, 1, 1000, Real(mu)), 0.537 * d / h_c, 1e-3 * d / h_c);
  const double Re_10 = 10 * mu / (1000 * h_c);  // m/s; 0.2054 by the integral over Oseen's flow
  EXPECT_NEAR(own.fraction(K, Real(Re_10), 1, 1000, Real(mu)), 0.2054 * 0.537 * d / h_c, 3e-3 * d / h_c);
  EXPECT_NEAR(own.fraction(K, 0, Real(0.5), 1000, Real(mu)), 0.537 * d / h_c / 256, 1e-5);
  EXPECT_EQ(own.fraction(1000 * K, 0, 1, 1000, Real(mu)), Real(0.5));
  double squares = 0;
  for (int k = 0; k < 1000; ++k) {
    const double r = (k + 0.5) * 2 * h_c / 1000;
    squares += 4 * M_PI * r * r * std::pow(double(WendlandC2(h_c).W(Real(r))), 2) * 2 * h_c / 1000;
  }
  const double V = M_PI / 6 * d * d * d;
  EXPECT_NEAR(own.porosity(1 - Real(V * squares), Real(V)), 1, 9 * square(V * squares) + 2e-7);
  const OwnWake wide = OwnWake::of(WendlandC2(2 * h_c), 2 * h_c, mu, true), widened = own.with(Real(0.5));
  EXPECT_NEAR(widened.mobility / wide.mobility, 1, 1e-5);
  EXPECT_NEAR(widened.h_c / wide.h_c, 1, 1e-6);
  EXPECT_NEAR(widened.per_volume / wide.per_volume, 1, 1e-5);
  EXPECT_EQ(OwnWake{}.porosity(Real(0.7), Real(V)), Real(0.7));
}

TEST(AllowedFraction, IsWholeUpToOneStepAndNeverMoreThanTheFluidHolds) {
  for (double x : {0.0, 1e-9, 0.5, 1.0}) EXPECT_EQ(allowed_fraction(Real(x)), Real(1));
  for (double x : {1.001, 50.0, 1e8}) EXPECT_NEAR(double(allowed_fraction(Real(x))) * x, 1, 2e-7);
}

/// A grain of which fluid to one side carries the force: three particles of equal weight.
struct Sided {
  std::vector<Real3> at{{1, 0, 0}, {0, 2, 0}, {1, 1, 3}};
  std::vector<Real3> arm{{}}, u{{}}, omega{{}}, U{{}}, omega_f{{}};
  std::vector<SymmetricMatrix<Real>> inv_M{{}};
  std::vector<Real> one{1}, half{Real(0.5)}, radius{Real(0.1)}, K{0}, K_rot{0}, still{0};
  std::vector<Real> inv_S{Real(1.0 / 3)}, rho{1000}, at_centre{0}, off_centre{0}, sum{0};
  std::vector<FlowSums<>> flow{{}};

  template <class T>
  static Span<T> all(std::vector<T>& of) {
    return {of.data(), Index(of.size())};
  }
  DragLevers levers() { return {all(at_centre), all(off_centre), all(sum)}; }
  void run() {
    for (const Real3& r : at) flow[0].add<true>(1, {}, r);
    GrainSurroundings around{};
    around.inv_S = all(inv_S), around.rho = all(rho), around.flow = all(flow);
    around.drag = {all(arm), all(inv_M)};
    struct Law {
      BL_HD Real K(Real, Real, Real, Real, Real) const { return 1; }
    };
    const DragPass<Law, false> pass{.lines = {.law = {},
                                              .mu = 1,
                                              .shares = false,
                                              .wake = {},
                                              .shrink = {},
                                              .fluid = {.bodies = {{}, all(radius), {}},
                                                        .eps = all(one),
                                                        .bed_eps = all(one),
                                                        .surroundings = around}},
                                    .torque = false,
                                    .couple = true,
                                    .wetness = all(one),
                                    .v = all(u),
                                    .omega = all(omega),
                                    .weights = {all(still), {}},
                                    .drag = {all(U), all(omega_f), all(K), all(K_rot)},
                                    .levers = levers()};
    pass(0);
  }
};

/// With s = r - arm, the mean of r: a particle gets the force -(F - A x s) / n with A = M^-1 (arm x F), at
/// most (1 + |arm| |M^-1| n |s|) F / n.
TEST(DragLevers, BoundWhatTheCoupleAddsToTheForce) {
  Sided sided;
  sided.run();
  const Vec3d arm = Vec3d{2, 3, 3} / 3;
  SymmetricMatrix<double> moment;
  double second = 0;
  for (const Real3& r : sided.at) {
    moment.add_outer(1.0 / 3, Vec3d(r) - arm);
    second += norm2(Vec3d(r) - arm) / 3;
  }
  const double off_centre = norm(arm) * moment.inertia().inverse().norm(), far = std::sqrt(second);
  EXPECT_NEAR(sided.off_centre[0], off_centre, 1e-5 * off_centre);
  EXPECT_NEAR(sided.at_centre[0], 1 + off_centre * norm(arm), 1e-5 * off_centre);
  EXPECT_NEAR(sided.sum[0], 1 + off_centre * far, 1e-5 * off_centre);
}

TEST(DragLevers, WeakenTheDragOfAGrainByTheirSum) {
  std::vector<Real> radius{1}, rate{200}, sum{3}, K{5}, K_rot{7}, stiffness{0};
  const auto all = [](auto& of) { return Span(of.data(), Index(of.size())); };
  const auto weakened = [&](double dt, bool couple) {
    K = {5}, K_rot = {7};
    const LimitPass pass{.dt = Real(dt),
                         .range = {2},
                         .radius = all(radius),
                         .rate = all(rate),
                         .lever_sum = couple ? Span<const Real>(all(sum)) : Span<const Real>(),
                         .drag = {{}, {}, all(K), all(K_rot)},
                         .stiffness = all(stiffness)};
    auto most = pass.start(0);
    pass.pair(most, {}, 0, 0, 150);
    pass.pair(most, {}, Real(3.9), 0, 200);
    pass.pair(most, {}, Real(4.1), 0, 1000);  // farther than its kernel reaches
    pass.pair(most, {}, 0, 0, 10);
    pass.finish(0, most);
    EXPECT_NEAR(K_rot[0] / K[0], 7.0 / 5, 1e-6);
    return double(K[0]) / 5;
  };
  EXPECT_NEAR(weakened(0.01, false), 0.5, 1e-6);  // dt L / m = 2
  EXPECT_NEAR(stiffness[0], 2, 1e-5);
  EXPECT_NEAR(weakened(0.01, true), 1.0 / 6, 1e-6);
  EXPECT_NEAR(stiffness[0], 6, 1e-5);
  EXPECT_EQ(weakened(0.001, true), 1);
}

/// How fast drag stops a fluid particle of 2 kg at r from a grain, with the levers of its couple or without.
template <bool kCouple>
double stopped(double r) {
  std::vector<Real> K{4}, still{3}, at_centre{Real(1.5)}, off_centre{10}, mass{2}, rate{0};
  std::vector<VelocityDensity<>> v_rho{{{}, 1000}};
  std::vector<EosState<>> eos_state{{.mass_over_eps = 5, .rho = 1000, .eps = 1}};
  const auto all = [](auto& of) { return Span(of.data(), Index(of.size())); };
  const DragRatePass<WendlandC2, false, kCouple> pass{.w = WendlandC2(0.1),
                                                      .weights = {all(still), {}},
                                                      .levers = {all(at_centre), all(off_centre), {}},
                                                      .drag_coefficient = all(K),
                                                      .mass = all(mass),
                                                      .v_rho = all(v_rho),
                                                      .eos_state = all(eos_state),
                                                      .rate = all(rate)};
  auto sum = pass.start(0);
  const Real3 apart{0, Real(r), 0};
  if constexpr (kCouple)
    pass.pair(sum, apart, norm2(apart), Real(0), K[0], still[0], at_centre[0], off_centre[0], Unread{},
              Unread{});
  else
    pass.pair(sum, apart, norm2(apart), Real(0), K[0], still[0], Unread{}, Unread{}, Unread{}, Unread{});
  pass.finish(0, sum);
  return rate[0];
}

TEST(DragLevers, MakeAParticleStopTheFasterTheFartherFromTheGrain) {
  const double W = WendlandC2(0.1).W(Real(0.08)), plain = 4 * 3 * (5.0 / 1000) * W / 2;
  EXPECT_NEAR(stopped<false>(0.08) / plain, 1, 1e-5);
  EXPECT_NEAR(stopped<true>(0.08) / plain, 1.5 + 10 * 0.08, 1e-5);
}

TEST(SymmetricMatrix, InverseUndoesTheProduct) {
  SymmetricMatrix<Real> m;
  m.add_outer(2, {1, 2, -1});
  m.add_outer(1, {0, 1, 3});
  m.add_outer(Real(0.5), {-2, 1, 1});
  const Real3 v{Real(0.3), Real(-1.2), Real(0.7)};
  const Real3 back = m.inverse() * (m * v);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], v[k], 10 * kInvariant);
  EXPECT_NEAR(m.inertia().trace(), 2 * m.trace(), kInvariant * m.trace());
}

}  // namespace
}  // namespace BL_SOLVER
