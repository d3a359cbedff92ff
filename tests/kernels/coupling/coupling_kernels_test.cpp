#include <gtest/gtest.h>

#include <cmath>

#include "kernels/coupling/drag_pass.hpp"
#include "kernels/coupling/limit_pass.hpp"
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
