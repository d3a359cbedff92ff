#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bedload/parallel/loops.hpp"
#include "kernels/smoothing/registry.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

template <class Kernel>
struct EvaluatePass {
  Kernel w;
  Span<const Real> r;
  Span<Real> W, F;
  BL_HD void operator()(Index i) const {
    W[i] = w.W(r[i]);
    F[i] = w.F(r[i]);
  }
};

struct Values {
  std::vector<Real> W, F;
};

/// Kernel `name` of smoothing length h at distances r, where the solver computes it.
Values evaluate(const std::string& name, double h, const std::vector<double>& r, double thickness = 0) {
  Buffer<Real> at, W(r.size()), F(r.size());
  at.assign({r.begin(), r.end()});
  with_kernel(
      name, h,
      [&](auto w) {
        for_each({0, Index(r.size())}, EvaluatePass<decltype(w)>{w, at, W, F});
      },
      thickness);
  return {W.to_host(), F.to_host()};
}

class KernelFunctions : public testing::TestWithParam<const char*> {
 protected:
  const double h = 0.003;
  const double kappa = kernel_kappa(GetParam());
};

TEST_P(KernelFunctions, IntegralsInAPlaneFlowAreOneAndTwo) {
  const double thickness = 0.02;
  const int rings = 2000;
  std::vector<double> r;
  for (int k = 0; k < rings; ++k) r.push_back((k + 0.5) * kappa * h / rings);
  const Values v = evaluate(GetParam(), h, r, thickness);
  double W = 0, F = 0;
  for (int k = 0; k < rings; ++k) {
    const double ring = 2 * M_PI * r[k] * kappa * h / rings * thickness;
    W += v.W[k] * ring;
    F += v.F[k] * ring * r[k] * r[k];
  }
  EXPECT_NEAR(W, 1, 1e-5);
  EXPECT_NEAR(F, 2, 2e-5);
}

TEST_P(KernelFunctions, IntegralsAreOneAndThree) {
  // Five-point Gauss rule on twenty intervals: exact for these piecewise polynomials.
  const double x[] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640, -0.9061798459386640};
  const double weight[] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891,
                           0.2369268850561891};
  const int intervals = 20;
  const double half = 0.5 * kappa * h / intervals;
  std::vector<double> r;
  for (int k = 0; k < intervals; ++k)
    for (double at : x) r.push_back((2 * k + 1 + at) * half);
  const Values v = evaluate(GetParam(), h, r);
  double W = 0, F = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double shell = 4 * M_PI * r[i] * r[i] * half * weight[i % 5];
    W += v.W[i] * shell;
    F += v.F[i] * shell * r[i] * r[i];
  }
  EXPECT_NEAR(W, 1, tolerance(1e-10, 1e-6, 1e-6));
  EXPECT_NEAR(F, 3, 3 * tolerance(1e-10, 1e-6, 1e-6));
}

TEST_P(KernelFunctions, FIsTheSlopeOfW) {
  // Seven-point differences, exact for polynomials of sixth degree: pieces must not be straddled.
  const double step = 0.14 * h;
  std::vector<double> at, r;
  for (double middle :
       kappa == 2 ? std::vector<double>{0.45, 0.55, 1.45, 1.55} : std::vector<double>{0.45, 0.55}) {
    at.push_back(middle * h);
    for (int k = -3; k <= 3; ++k) r.push_back(middle * h + k * step);
  }
  const Values v = evaluate(GetParam(), h, r);
  const double largest = evaluate(GetParam(), h, {0}).W[0] / h;
  const double weight[] = {-1.0 / 60, 9.0 / 60, -45.0 / 60, 0, 45.0 / 60, -9.0 / 60, 1.0 / 60};
  for (std::size_t i = 0; i < at.size(); ++i) {
    double slope = 0;
    for (int k = 0; k < 7; ++k) slope += weight[k] * v.W[7 * i + k] / step;
    EXPECT_NEAR(-v.F[7 * i + 3] * at[i], slope, tolerance(1e-10, 1e-6, 1e-6) * largest) << at[i] / h;
  }
}

TEST_P(KernelFunctions, NothingAtAndBeyondTheSupport) {
  const Values v = evaluate(GetParam(), h, {0.999 * kappa * h, 1.0001 * kappa * h, 3 * kappa * h});
  EXPECT_GT(v.W[0], 0);
  EXPECT_GT(v.F[0], 0);
  for (int i : {1, 2}) {
    EXPECT_EQ(v.W[i], 0);
    EXPECT_EQ(v.F[i], 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Small, KernelFunctions, testing::Values("wendland_c2", "cubic", "lucy"),
                         [](const auto& info) { return std::string(info.param); });

TEST(SmallKernelNames, AnUnknownNameIsAnError) {
  EXPECT_THROW(with_kernel("quintic", 1.0, [](auto) {}), CaseError);
}

}  // namespace
}  // namespace BL_SOLVER
