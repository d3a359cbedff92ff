#pragma once
// Places in cells, to find what is near to one.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "bedload/case/config/domain.hpp"

namespace bedload {

/// Places (m) in cells of a domain, by nearest images where it is periodic. `reach` of a search is at most
/// the cells' least width.
class PlaceCells {
 public:
  PlaceCells(const DomainConfig& domain, double width, const std::vector<Vec3d>& places)
      : domain_(domain), places_(places), next_(places.size()) {
    for (int k = 0; k < 3; ++k) {
      const double length = domain_.max[k] - domain_.min[k];
      count_[k] = std::clamp<std::int64_t>(std::int64_t(length / width), 1, 1 << 20);
      width_[k] = length / double(count_[k]);
    }
    first_.reserve(places.size() / 4);
    for (std::size_t a = places.size(); a-- > 0;) {
      std::size_t& first = first_.try_emplace(key(cell(places[a])), places.size()).first->second;
      next_[a] = first, first = a;
    }
  }

  /// Calls f(place, squared distance) for those within reach of x, until it returns true; whether it did.
  template <class F>
  bool any(const Vec3d& x, double reach, const F& f) const {
    const auto centre = cell(x);
    for (int n = 0; n < 27; ++n) {
      const int m = (n + 13) % 27;  // its own cell first
      const std::array<std::int64_t, 3> side{m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1};
      if (repeats(side)) continue;
      const auto here = first_.find(key({wrapped(0, centre[0] + side[0]), wrapped(1, centre[1] + side[1]),
                                         wrapped(2, centre[2] + side[2])}));
      if (here == first_.end()) continue;
      for (std::size_t a = here->second; a < places_.size(); a = next_[a])
        if (const double r2 = norm2(apart(places_[a], x)); r2 <= reach * reach && f(a, r2)) return true;
    }
    return false;
  }

 private:
  /// A neighbour that is another one's image: of one or two cells along a period.
  bool repeats(const std::array<std::int64_t, 3>& side) const {
    for (int k = 0; k < 3; ++k)
      if (domain_.periodic[k] && (count_[k] == 1 ? side[k] != 0 : count_[k] == 2 && side[k] > 0)) return true;
    return false;
  }
  Vec3d apart(const Vec3d& x, const Vec3d& y) const {
    Vec3d r = x - y;
    for (int k = 0; k < 3; ++k)
      if (const double period = domain_.max[k] - domain_.min[k]; domain_.periodic[k])
        r[k] -= period * std::round(r[k] / period);
    return r;
  }
  std::int64_t wrapped(int k, std::int64_t at) const {
    return domain_.periodic[k] ? (at % count_[k] + count_[k]) % count_[k] : at;
  }
  std::array<std::int64_t, 3> cell(const Vec3d& x) const {
    std::array<std::int64_t, 3> at;
    for (int k = 0; k < 3; ++k)
      at[k] = wrapped(k, std::int64_t(std::floor((x[k] - domain_.min[k]) / width_[k])));
    return at;
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& at) {
    std::uint64_t out = 0;
    for (const std::int64_t k : at) out = out << 21 | (std::uint64_t(k) & ((1u << 21) - 1));
    return out;
  }

  const DomainConfig& domain_;
  const std::vector<Vec3d>& places_;
  std::array<std::int64_t, 3> count_;
  Vec3d width_;
  std::vector<std::size_t> next_;  ///< in the same cell; their number after the last
  std::unordered_map<std::uint64_t, std::size_t> first_;
};

}  // namespace bedload
