#include "src/motion/formula_breaks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace bedload {
namespace {

constexpr int kSamples = 4096;
constexpr std::size_t kMost = 128;

class Search {
 public:
  Search(const Formula& f, double span) : f_(f), step_(span / kSamples) {
    double lowest = INFINITY, highest = -INFINITY, largest = 0;
    for (int i = 0; i <= kSamples; ++i) {
      const double now = f(i * step_);
      if (!std::isfinite(now)) continue;
      lowest = std::min(lowest, now);
      highest = std::max(highest, now);
      largest = std::max(largest, std::abs(now));
      const double rate = std::abs(f((i + 0.01) * step_) - now) / (0.01 * step_);
      if (i < kSamples && std::isfinite(rate)) fastest_ = std::max(fastest_, rate);
    }
    covered_ = highest - lowest;
    fastest_ = std::max(fastest_, covered_ / span);
    // rounding bends a formula by some 1e-16 of its value
    least_step_ = std::max(1e-9 * span, 1e-13 * largest / (0.01 * fastest_));
  }

  bool constant() const { return !(covered_ > 0); }

  /// The break within a step of sample `i`, if there is one.
  std::optional<Break> near(int i) const {
    double at = i * step_, h = step_;
    while (h > least_step_) {  // into the half where the formula bends most
      h /= 2;
      double f[5], most = -1, there = at;
      for (int k = 0; k < 5; ++k) f[k] = f_(at + (k - 2) * h);
      for (int k = 1; k < 4; ++k)
        if (const double bend = std::abs(f[k - 1] - 2 * f[k] + f[k + 1]); bend > most)
          most = bend, there = at + (k - 2) * h;
      // a kink bends by at least half of its jump in slope times h, as it lies in the middle half of x - h ..
      // x + h
      if (!(most >= 0.5 * 0.01 * fastest_ * h) || !std::isfinite(most)) return {};
      at = there;
    }
    const double apart = 50 * h, low = at - h, high = at + h;
    if (low - apart < 0) return {};
    const double before = (f_(low) - f_(low - apart)) / apart, after = (f_(high + apart) - f_(high)) / apart;
    const double jump = f_(high) - f_(low), smooth = 2 * h * std::max(std::abs(before), std::abs(after));
    const Break found{at, h, std::abs(jump) > 2 * smooth + 1e-6 * covered_ ? jump : 0, after - before};
    if (!std::isfinite(found.jump + found.rate_jump)) return {};
    if (found.jump == 0 && std::abs(found.rate_jump) < 0.01 * fastest_) return {};
    return found;
  }

  double resolution() const { return 4 * least_step_; }

 private:
  const Formula& f_;
  double step_, covered_ = 0, fastest_ = 0, least_step_ = 0;
};

}  // namespace

std::vector<Break> breaks_of(const Formula& formula, double span) {
  const Search search(formula, span);
  std::vector<Break> breaks;
  if (search.constant()) return breaks;
  for (int i = 1; i < kSamples && breaks.size() < kMost; ++i) {
    const auto found = search.near(i);
    if (found && (breaks.empty() || found->time > breaks.back().time + search.resolution()))
      breaks.push_back(*found);
  }
  return breaks;
}

}  // namespace bedload
