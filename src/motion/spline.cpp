#include "src/motion/spline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bedload {
namespace {

/// Widths of the intervals and the slopes of their chords.
struct Chords {
  std::vector<double> h, slope;
  Chords(const std::vector<double>& t, const std::vector<double>& y) {
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
      h.push_back(t[i + 1] - t[i]);
      slope.push_back((y[i + 1] - y[i]) / h[i]);
    }
  }
};

/// Slopes of the parabola through three points.
std::vector<double> parabola(const Chords& c) {
  const double middle = (c.h[1] * c.slope[0] + c.h[0] * c.slope[1]) / (c.h[0] + c.h[1]);
  return {2 * c.slope[0] - middle, middle, 2 * c.slope[1] - middle};
}

/// Solves the tridiagonal system below, diagonal, above; b becomes the solution.
void solve(const std::vector<double>& below, std::vector<double>& diagonal, const std::vector<double>& above,
           std::vector<double>& b) {
  const std::size_t n = b.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    b[i] -= factor * b[i - 1];
  }
  b[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) b[i] = (b[i] - above[i] * b[i + 1]) / diagonal[i];
}

/// Slopes that make the second derivative continuous everywhere and the third one at the points next to
/// the ends ("not a knot").
std::vector<double> smooth_slopes(const Chords& c) {
  const auto& [h, s] = c;
  const std::size_t n = h.size() + 1;
  if (n == 2) return {s[0], s[0]};
  if (n == 3) return parabola(c);
  std::vector<double> below(n), diagonal(n), above(n), b(n);
  const double first = h[0] + h[1], last = h[n - 2] + h[n - 3];
  diagonal[0] = h[1], above[0] = first;
  b[0] = ((h[0] + 2 * first) * h[1] * s[0] + h[0] * h[0] * s[1]) / first;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    below[i] = h[i], diagonal[i] = 2 * (h[i - 1] + h[i]), above[i] = h[i - 1];
    b[i] = 3 * (h[i] * s[i - 1] + h[i - 1] * s[i]);
  }
  below[n - 1] = last, diagonal[n - 1] = h[n - 3];
  b[n - 1] = (h[n - 2] * h[n - 2] * s[n - 3] + (2 * last + h[n - 2]) * h[n - 3] * s[n - 2]) / last;
  solve(below, diagonal, above, b);
  return b;
}

/// Slope at the outer end of the interval h0, s0 with h1, s1 next to it, kept monotone.
double end_slope(double h0, double h1, double s0, double s1) {
  const double slope = ((2 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
  if (slope * s0 <= 0) return 0;
  return s0 * s1 <= 0 && std::abs(slope) > 3 * std::abs(s0) ? 3 * s0 : slope;
}

/// Weighted harmonic means of the chords' slopes, zero where these change sign [fritsch84].
std::vector<double> monotone_slopes(const Chords& c) {
  const auto& [h, s] = c;
  const std::size_t n = h.size() + 1;
  if (n == 2) return {s[0], s[0]};
  std::vector<double> slope(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (s[i - 1] * s[i] <= 0) continue;
    const double w0 = 2 * h[i] + h[i - 1], w1 = h[i] + 2 * h[i - 1];
    slope[i] = (w0 + w1) / (w0 / s[i - 1] + w1 / s[i]);
  }
  slope[0] = end_slope(h[0], h[1], s[0], s[1]);
  slope[n - 1] = end_slope(h[n - 2], h[n - 3], s[n - 2], s[n - 3]);
  return slope;
}

}  // namespace

Spline::Spline(std::vector<double> t, std::vector<double> y, bool monotone)
    : t_(std::move(t)), y_(std::move(y)) {
  const Chords chords(t_, y_);
  slope_ = monotone ? monotone_slopes(chords) : smooth_slopes(chords);
}

Spline::Value Spline::at(double t) const {
  const auto after = std::upper_bound(t_.begin() + 1, t_.end() - 1, t);
  const std::size_t i = after - t_.begin() - 1;
  const double h = t_[i + 1] - t_[i], s = t - t_[i], chord = (y_[i + 1] - y_[i]) / h;
  // y + s (slope + s (c2 + s c3)), a Hermite cubic
  const double c2 = (3 * chord - 2 * slope_[i] - slope_[i + 1]) / h;
  const double c3 = (slope_[i] + slope_[i + 1] - 2 * chord) / (h * h);
  return {y_[i] + s * (slope_[i] + s * (c2 + s * c3)), slope_[i] + s * (2 * c2 + s * 3 * c3),
          2 * c2 + 6 * s * c3};
}

}  // namespace bedload
