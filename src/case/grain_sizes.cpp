#include "bedload/case/grain_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace bedload {
namespace {

constexpr double kSample = 1e5;  // beyond that many grains their mean no longer depends on the number

double sphere(double d) { return std::numbers::pi / 6 * d * d * d; }

double total_weight(const std::vector<SizeClass>& sizes) {
  double sum = 0;
  for (const SizeClass& size : sizes) sum += size.number_fraction;
  return sum;
}

/// The standard normal distribution and its density.
double normal(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }
double normal_density(double z) {
  return std::exp(-0.5 * z * z) / (std::numbers::sqrt2 * std::sqrt(std::numbers::pi));
}

/// Where the normal distribution reaches p. Newton's method from 0 never overshoots, since the distribution
/// bends towards the axis on either side.
double normal_quantile(double p) {
  double z = 0;
  for (int n = 0; n < 200; ++n) {
    const double step = (p - normal(z)) / normal_density(z);
    z += step;
    if (!(std::abs(step) > 1e-12)) break;
  }
  return z;
}

/// Log-normal by count, cut at d_min and d_max.
std::vector<double> log_normal(const SizeClass& s, std::size_t count) {
  const double from = normal(std::log(s.d_min / s.median) / s.sigma);
  const double to = normal(std::log(s.d_max / s.median) / s.sigma);
  std::vector<double> d;
  for (std::size_t k = 0; k < count; ++k) {
    const double p = from + (to - from) * (double(k) + 0.5) / double(count);
    d.push_back(std::clamp(s.median * std::exp(s.sigma * normal_quantile(p)), s.d_min, s.d_max));
  }
  return d;
}

/// Grains between two openings: their mass spreads evenly over ln d, so their number falls as d^-4.
struct Fraction {
  double lo, hi;  // m
  double number;  // relative
};

std::vector<Fraction> fractions(const SizeClass& s) {
  std::vector<Fraction> all;
  for (std::size_t i = 1; i < s.openings.size(); ++i) {
    const double lo = s.openings[i - 1], hi = s.openings[i], mass = s.passing[i] - s.passing[i - 1];
    if (mass > 0) all.push_back({lo, hi, mass * (std::pow(lo, -3) - std::pow(hi, -3)) / std::log(hi / lo)});
  }
  return all;
}

std::vector<double> sieve(const SizeClass& s, std::size_t count) {
  const auto all = fractions(s);
  double number = 0, finer = 0;
  for (const Fraction& f : all) number += f.number;
  std::vector<double> d;
  std::size_t at = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double wanted = number * (double(k) + 0.5) / double(count);
    while (at + 1 < all.size() && finer + all[at].number < wanted) finer += all[at++].number;
    const Fraction& f = all[at];
    const double fraction = std::clamp((wanted - finer) / f.number, 0.0, 1.0);
    const double lo = std::pow(f.lo, -3), hi = std::pow(f.hi, -3);
    d.push_back(std::clamp(1 / std::cbrt(lo + fraction * (hi - lo)), f.lo, f.hi));
  }
  return d;
}

}  // namespace

std::pair<double, double> size_range(const SizeClass& size) {
  if (size.kind == SizeKind::one_size) return {size.d, size.d};
  if (size.kind != SizeKind::sieve) return {size.d_min, size.d_max};
  const auto all = fractions(size);
  return {all.front().lo, all.back().hi};
}

std::vector<double> quantiles(const SizeClass& size, std::size_t count) {
  std::vector<double> d;
  switch (size.kind) {
    case SizeKind::one_size:
      return std::vector<double>(count, size.d);
    case SizeKind::log_normal:
      return log_normal(size, count);
    case SizeKind::sieve:
      return sieve(size, count);
    case SizeKind::uniform:
      break;
  }
  for (std::size_t k = 0; k < count; ++k)
    d.push_back(size.d_min + (size.d_max - size.d_min) * (double(k) + 0.5) / double(count));
  return d;
}

std::vector<double> diameters(const std::vector<SizeClass>& sizes, std::size_t count) {
  const double total = total_weight(sizes);
  double reached = 0;
  std::vector<double> all;
  for (const SizeClass& size : sizes) {
    reached += size.number_fraction / total;
    const auto upto = std::size_t(std::llround(reached * double(count)));
    const auto part = quantiles(size, upto - std::min(upto, all.size()));
    all.insert(all.end(), part.begin(), part.end());
  }
  all.resize(count, all.empty() ? sizes.back().d : all.back());
  return all;
}

double mean_volume(const std::vector<SizeClass>& sizes, std::size_t count) {
  const double total = total_weight(sizes);
  double mean = 0;
  for (const SizeClass& size : sizes) {
    double volume = 0;
    const auto part =
        std::size_t(std::clamp(std::round(size.number_fraction / total * double(count)), 1.0, kSample));
    if (size.kind == SizeKind::one_size) {
      volume = sphere(size.d);
    } else {
      for (const double d : quantiles(size, part)) volume += sphere(d) / double(part);
    }
    mean += size.number_fraction * volume;
  }
  return mean / total;
}

double count_for_volume(const std::vector<SizeClass>& sizes, double volume) {
  double n = volume / mean_volume(sizes, 1000);
  for (int pass = 0; pass < 8 && n >= 1; ++pass) {
    const double next = volume / mean_volume(sizes, std::size_t(std::round(std::min(n, 1e9))));
    if (std::round(next) == std::round(n)) return next;
    n = next;
  }
  return n;
}

double densest_packing(const std::vector<SizeClass>& sizes) {
  constexpr double kEqual = 0.64;  // of equal grains
  // volumes in classes of ln d, each some 5 % wide
  std::map<int, double> volumes;
  const double step = std::log(1.05);
  double total = 0;
  for (const SizeClass& size : sizes) {
    const auto part = quantiles(size, size.kind == SizeKind::one_size ? 1 : std::size_t(kSample));
    for (const double d : part) {
      const double volume = size.number_fraction * sphere(d) / double(part.size());
      volumes[int(std::lround(std::log(d) / step))] += volume;
      total += volume;
    }
  }
  // each class in turn fills what the others leave: larger ones are obstacles with walls, smaller ones loosen
  double densest = 1;
  for (const auto& [own, unused] : volumes) {
    double taken = 0;
    for (const auto& [other, volume] : volumes) {
      const double ratio = std::exp(-step * std::abs(own - other));  // of the smaller to the larger
      const double wall = 1 - std::pow(1 - ratio, 1.5), loosening = std::sqrt(1 - std::pow(1 - ratio, 1.02));
      if (other > own) taken += volume / total * (1 - kEqual) * (1 - wall);
      if (other < own) taken += volume / total * (1 - loosening);
    }
    densest = std::min(densest, kEqual / (1 - taken));
  }
  return densest;
}

}  // namespace bedload
