#include <gtest/gtest.h>

#include <cmath>

#include "kernels/coupling/drag_pass.hpp"
#include "kernels/coupling/limit_pass.hpp"
#include "kernels/smoothing/wendland_c2.hpp"
#include "tests/support/tolerance.hpp"

namespace bedload::inline BL_VARIANT {
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
  EXPECT_EQ(OwnWake{}.porosity(Real(0.7), Real(V)), Real(0.7));
}

TEST(AllowedFraction, IsWholeUpToOneStepAndNeverMoreThanTheFluidHolds) {
  for (double x : {0.0, 1e-9, 0.5, 1.0}) EXPECT_EQ(allowed_fraction(Real(x)), Real(1));
  for (double x : {1.001, 50.0, 1e8}) EXPECT_NEAR(double(allowed_fraction(Real(x))) * x, 1, 2e-7);
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
}  // namespace bedload::inline BL_VARIANT
