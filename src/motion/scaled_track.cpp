#include "src/motion/scaled_track.hpp"

#include <algorithm>
#include <cmath>

namespace bedload {
namespace {

double gauss(const SmoothFormula& f, double from, double to) {
  constexpr double at[2] = {0.33998104358485626, 0.86113631159405258};
  constexpr double weight[2] = {0.65214515486254614, 0.34785484513745386};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (const int k : {0, 1}) sum += weight[k] * (f(middle - half * at[k]) + f(middle + half * at[k]));
  return half * sum;
}

constexpr int kIntervals = 256;    // over the span, at least
constexpr int kMostHalvings = 24;  // of one of them, where the formula jumps or bends
constexpr std::size_t kMostNodes = 1000000;
constexpr double kAccuracy = 1e-13;

}  // namespace

Integral::Integral(const SmoothFormula& formula, double span) : formula_(formula) {
  double largest = 0;
  for (int i = 0; i <= kIntervals; ++i) largest = std::max(largest, std::abs(formula(span * i / kIntervals)));
  for (int i = 0; i < kIntervals; ++i) {
    const double from = span * i / kIntervals, to = span * (i + 1) / kIntervals;
    add(from, to, gauss(formula, from, to), kAccuracy * largest * span, kMostHalvings);
  }
}

void Integral::add(double from, double to, double whole, double allowed, int deeper) {
  const double middle = 0.5 * (from + to);
  const double first = gauss(formula_, from, middle), second = gauss(formula_, middle, to);
  if (deeper > 0 && nodes_.size() < kMostNodes && std::abs(first + second - whole) > allowed) {
    add(from, middle, first, allowed, deeper - 1);
    add(middle, to, second, allowed, deeper - 1);
    return;
  }
  nodes_.push_back({middle, nodes_.back().sum + first});
  nodes_.push_back({to, nodes_.back().sum + second});
}

double Integral::operator()(double s) const {
  const auto after = std::upper_bound(nodes_.begin() + 1, nodes_.end(), s,
                                      [](double t, const Node& n) { return t < n.time; });
  const Node& before = *(after - 1);
  return before.sum + gauss(formula_, before.time, s);
}

ScaledTrack::ScaledTrack(const Vec3d& velocity, const Vec3d& omega, const std::string& factor, double span)
    : velocity_(velocity),
      omega_(omega),
      turns_(norm(omega) > 0),
      factor_(factor, 1, span),
      integral_(factor_, span) {}

TrackPoint ScaledTrack::at(double s) const {
  const SmoothFormula::Value f = factor_.at(s);
  const double way = integral_(s);
  const auto along = [&](const Vec3d& v) { return Jet{v * way, v * f.y, v * f.rate}; };
  return {.shift = along(velocity_), .turn = along(omega_)};
}

std::vector<double> ScaledTrack::breaks() const {
  std::vector<double> times;
  for (const Break& b : factor_.breaks()) times.push_back(b.time);
  return times;
}

}  // namespace bedload
