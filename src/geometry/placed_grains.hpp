#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
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
      if (2 * (grains_.size() + 1) > slots_.size()) grow();
      Slot& slot = slots_[slot_of(key(cell(x)))];
      grains_.push_back({x, radius, slot.first});
      slot = {key(cell(x)), std::uint32_t(grains_.size())};
      largest_ = std::max(largest_, radius);
    }
    bool is_free(const Vec3d& x, double radius) const {
      const double range = radius + largest_;
      const Vec3d reach{range, range, range};
      const Cell from = cell(x - reach), to = cell(x + reach);
      double cells = 1;
      for (int k = 0; k < 3; ++k) cells *= double(to[k] - from[k] + 1);
      if (cells > double(grains_.size()))
        return std::all_of(grains_.begin(), grains_.end(),
                           [&](const Grain& other) { return clear_of(other, x, radius); });
      for (std::int64_t iz = from[2]; iz <= to[2]; ++iz)
        for (std::int64_t iy = from[1]; iy <= to[1]; ++iy)
          for (std::int64_t ix = from[0]; ix <= to[0]; ++ix)
            for (std::uint32_t n = slots_[slot_of(key({ix, iy, iz}))].first; n > 0; n = grains_[n - 1].next)
              if (!clear_of(grains_[n - 1], x, radius)) return false;
      return true;
    }

   private:
    struct Grain {
      Vec3d x;
      double radius;
      std::uint32_t next;  ///< of its cell, counted from 1; 0: none
    };
    struct Slot {
      std::uint64_t cell = 0;
      std::uint32_t first = 0;  ///< grain of the cell; 0: the slot is free
    };

    bool clear_of(const Grain& other, const Vec3d& x, double radius) const {
      Vec3d apart = x - other.x;
      for (int k = 0; k < 3; ++k)
        if (domain_.periodic[k]) {
          const double period = domain_.max[k] - domain_.min[k];
          apart[k] -= period * std::round(apart[k] / period);
        }
      return norm2(apart) >= (radius + other.radius) * (radius + other.radius);
    }
    /// That of a cell, or the free one where it belongs.
    std::size_t slot_of(std::uint64_t cell) const {
      const std::size_t last = slots_.size() - 1;
      std::size_t at = (cell * 0x9e3779b97f4a7c15u >> 32) & last;
      while (slots_[at].first > 0 && slots_[at].cell != cell) at = (at + 1) & last;
      return at;
    }
    void grow() {
      std::vector<Slot> before(2 * slots_.size());
      before.swap(slots_);
      for (const Slot& slot : before)
        if (slot.first > 0) slots_[slot_of(slot.cell)] = slot;
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
    std::vector<Grain> grains_;
    std::vector<Slot> slots_ = std::vector<Slot>(16);  ///< hashed by cell; a power of two, half of them free
  };

  DomainConfig domain_;
  std::map<int, Octave> octaves_;
};

}  // namespace bedload
