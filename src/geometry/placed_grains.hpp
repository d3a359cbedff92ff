#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bedload/case/config/domain.hpp"

namespace bedload {

/// The grains placed so far, those of each octave of radii in cells as wide as its largest diameter.
class PlacedGrains {
 public:
  explicit PlacedGrains(const DomainConfig& domain) : domain_(domain) {}

  void add(const Vec3d& x, double radius) {
    const int octave = std::ilogb(radius);
    const auto [at, fresh] = octaves_.try_emplace(octave, domain_, std::scalbn(4.0, octave));
    at->second.add(x, radius);
  }
  /// Whether a grain at `x` touches none of those placed; the nearest periodic image counts.
  bool is_free(const Vec3d& x, double radius) const {
    return std::all_of(octaves_.begin(), octaves_.end(),
                       [&](const auto& octave) { return octave.second.is_free(x, radius); });
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  class Octave {
   public:
    Octave(const DomainConfig& domain, double width) : domain_(domain) {
      for (int k = 0; k < 3; ++k) {
        const double length = domain.max[k] - domain.min[k];
        count_[k] = std::max<std::int64_t>(1, std::int64_t(std::floor(length / width)));
        width_[k] = length / double(count_[k]);
      }
    }
    void add(const Vec3d& x, double radius) {
      cells_[key(cell(x))].push_back({x, radius});
      largest_ = std::max(largest_, radius);
      ++grains_;
    }
    bool is_free(const Vec3d& x, double radius) const {
      const double range = radius + largest_;
      const Vec3d reach{range, range, range};
      const Cell from = cell(x - reach), to = cell(x + reach);
      double cells = 1;
      for (int k = 0; k < 3; ++k) cells *= double(to[k] - from[k] + 1);
      if (cells > double(grains_))
        return std::all_of(cells_.begin(), cells_.end(),
                           [&](const auto& all) { return clear_of(all.second, x, radius); });
      for (std::int64_t iz = from[2]; iz <= to[2]; ++iz)
        for (std::int64_t iy = from[1]; iy <= to[1]; ++iy)
          for (std::int64_t ix = from[0]; ix <= to[0]; ++ix) {
            const auto found = cells_.find(key({ix, iy, iz}));
            if (found != cells_.end() && !clear_of(found->second, x, radius)) return false;
          }
      return true;
    }

   private:
    using Grains = std::vector<std::pair<Vec3d, double>>;

    bool clear_of(const Grains& others, const Vec3d& x, double radius) const {
      for (const auto& [y, other] : others) {
        Vec3d apart = x - y;
        for (int k = 0; k < 3; ++k)
          if (domain_.periodic[k]) {
            const double period = domain_.max[k] - domain_.min[k];
            apart[k] -= period * std::round(apart[k] / period);
          }
        if (norm2(apart) < (radius + other) * (radius + other)) return false;
      }
      return true;
    }
    Cell cell(const Vec3d& x) const {
      Cell c;
      for (int k = 0; k < 3; ++k) c[k] = std::int64_t(std::floor((x[k] - domain_.min[k]) / width_[k]));
      return c;
    }
    std::uint64_t key(Cell c) const {
      for (int k = 0; k < 3; ++k)
        if (domain_.periodic[k]) c[k] = (c[k] % count_[k] + count_[k]) % count_[k];
      constexpr std::uint64_t mask = (1u << 21) - 1;
      return (std::uint64_t(c[0]) & mask) << 42 | (std::uint64_t(c[1]) & mask) << 21 |
             (std::uint64_t(c[2]) & mask);
    }

    DomainConfig domain_;
    double largest_ = 0;  ///< radius, m
    std::array<std::int64_t, 3> count_;
    std::array<double, 3> width_;
    std::size_t grains_ = 0;
    std::unordered_map<std::uint64_t, Grains> cells_;
  };

  DomainConfig domain_;
  std::map<int, Octave> octaves_;
};

}  // namespace bedload
