#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "kernels/integrate/fluid_kicks.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

/// Rates a + b t + c t2 at the ends of steps h2, h1 before a step dt; its exact integral from 0 to dt.
struct Parabola {
  double a, b, c, dt, h1, h2;
  double rate(double t) const { return a + b * t + c * t * t; }
  double exact() const { return dt * (a + dt * (b / 2 + dt * c / 3)); }
  double advanced(bool one = true, bool two = true) const {
    std::vector<Real> r{Real(rate(0)), Real(rate(-h1)), Real(rate(-h1 - h2))};
    const auto span = [&](int k) { return Span<const Real>{&r[k], 1}; };
    return DensityHistory(span(0), span(1), span(2), dt, one ? h1 : 0, one && two ? h2 : 0)(0);
  }
};

TEST(DensityHistory, IsExactToItsOrderForStepsThatVary) {
  for (const auto& [dt, h1, h2] :
       {std::array{1.0, 1.0, 1.0}, {1.05, 1.0, 0.7}, {0.3, 1.0, 1.2}, {1.2, 0.4, 1.0}}) {
    const Parabola third{0.7, -0.3, 0.4, dt, h1, h2}, second{0.7, -0.3, 0, dt, h1, h2},
        first{0.7, 0, 0, dt, h1, h2};
    EXPECT_NEAR(third.advanced(), third.exact(), tolerance(1e-14, 2e-6, 2e-6));
    EXPECT_NEAR(second.advanced(true, false), second.exact(), tolerance(1e-14, 2e-6, 2e-6));
    EXPECT_NEAR(first.advanced(false, false), first.exact(), tolerance(1e-14, 2e-6, 2e-6));
  }
}

TEST(DensityHistory, WithoutRatesNothingChanges) { EXPECT_EQ(DensityHistory()(0), 0); }

}  // namespace
}  // namespace BL_SOLVER
