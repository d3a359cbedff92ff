#include "src/motion/smooth_formula.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bedload {
namespace {

constexpr int kReach = 4, kNodes = 2 * kReach + 1;

/// Weights of the values at -4..4 in the first and second derivative at p.
struct Stencil {
  std::array<double, kNodes> weight[3] = {};

  explicit Stencil(double p) {  // [fornberg88]
    weight[0][0] = 1;
    double product = 1, distance = -kReach - p;
    for (int i = 1; i < kNodes; ++i) {
      const int top = std::min(i, 2);
      const double before = distance;
      double next = 1;
      distance = i - kReach - p;
      for (int j = 0; j < i; ++j) {
        next *= i - j;
        if (j == i - 1) {
          for (int k = top; k > 0; --k)
            weight[k][i] = product * (k * weight[k - 1][i - 1] - before * weight[k][i - 1]) / next;
          weight[0][i] = -product * before * weight[0][i - 1] / next;
        }
        for (int k = top; k > 0; --k)
          weight[k][j] = (distance * weight[k][j] - k * weight[k - 1][j]) / (i - j);
        weight[0][j] *= distance / (i - j);
      }
      product = next;
    }
  }
};

/// A step so long that rounding moves the second derivative by 4e-8 of the fastest rate over the span:
/// 4e-16 F / h^2 = 4e-8 V / span. Sines are then resolved as long as there are fewer than 1e5 of them.
double step_for(const Formula& formula, double span) {
  constexpr int samples = 4096;
  const double apart = 1e-3 * span / samples;
  double largest = 0, fastest = 0;
  for (int i = 0; i <= samples; ++i) {
    const double s = span * i / samples, f = formula(s), next = formula(s + apart);
    if (!std::isfinite(f)) continue;
    largest = std::max(largest, std::abs(f));
    if (std::isfinite(next)) fastest = std::max(fastest, std::abs(next - f) / apart);
  }
  const double longest = 1e-4 * span;
  return fastest > 0 ? std::min(longest, 1e-4 * std::sqrt(span * largest / fastest)) : longest;
}

}  // namespace

SmoothFormula::SmoothFormula(const std::string& text, double factor, double span)
    : formula_(text, "t"),
      factor_(factor),
      step_(step_for(formula_, span)),
      breaks_(breaks_of(formula_, span)) {}

SmoothFormula::Piece SmoothFormula::piece_at(double s) const {
  const std::vector<Break>& all = breaks_;
  const auto next = std::partition_point(all.begin(), all.end(), [&](const Break& b) { return b.time <= s; });
  return {next == all.begin() ? 0 : (next - 1)->time + (next - 1)->within,  // no value before the start
          next == all.end() ? std::numeric_limits<double>::infinity() : next->time - next->within};
}

SmoothFormula::Value SmoothFormula::at(double s) const {
  Value all{.y = (*this)(s)};
  const Piece piece = piece_at(s);
  const double h = std::min(step_, (piece.end - piece.begin) / (kNodes - 1));
  const double middle = std::max(std::min(s, piece.end - kReach * h), piece.begin + kReach * h);
  const Stencil stencil((s - middle) / h);
  for (int i = 0; i < kNodes; ++i) {
    const double f = (*this)(middle + (i - kReach) * h);
    all.rate += stencil.weight[1][i] * f / h;
    all.rate2 += stencil.weight[2][i] * f / (h * h);
  }
  return all;
}

}  // namespace bedload
