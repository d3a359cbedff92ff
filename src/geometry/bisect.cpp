#include "bedload/geometry/bisect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace bedload {
namespace {

/// What a particle next to a cut costs in addition, as a copy, of what it costs by itself; and the part of a
/// block that is next to it.
constexpr double kGhost = 0.12, kBeside = 1.0 / 8;

class Bisection {
 public:
  Bisection(const std::vector<std::array<int, 3>>& places, const std::vector<double>& load)
      : places_(places), load_(load), rank_(places.size(), 0) {}

  void divide(std::vector<std::uint32_t> blocks, int first, int ranks) {
    if (ranks == 1 || blocks.empty()) {
      for (const std::uint32_t b : blocks) rank_[b] = std::uint16_t(first);
      return;
    }
    Cut best;
    for (int axis = 0; axis < 3; ++axis)
      if (Cut cut = cut_across(blocks, axis, ranks / 2, ranks); cut.cost < best.cost) best = std::move(cut);
    const auto middle = best.order.begin() + std::ptrdiff_t(best.lower);
    divide({best.order.begin(), middle}, first, ranks / 2);
    divide({middle, best.order.end()}, first + ranks / 2, ranks - ranks / 2);
  }
  std::vector<std::uint16_t> take() { return std::move(rank_); }

 private:
  struct Cut {
    double cost = std::numeric_limits<double>::infinity();
    std::vector<std::uint32_t> order;
    std::size_t lower = 0;  ///< so many of them are below
  };

  Cut cut_across(std::vector<std::uint32_t> blocks, int axis, int below, int ranks) const {
    const auto key = [&](std::uint32_t b) {
      const auto& at = places_[b];
      return std::tuple(at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]);
    };
    std::sort(blocks.begin(), blocks.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    double all = 0;
    for (const std::uint32_t b : blocks) all += load_[b];
    // where nothing has load, by numbers
    const double of_none = all > 0 ? 0 : 1;
    if (!(all > 0)) all = double(blocks.size());
    const double wanted = all * below / ranks;
    double sum = 0, least = std::numeric_limits<double>::infinity(), lower = 0;
    Cut cut;
    for (std::size_t k = 0; k <= blocks.size(); ++k) {
      if (const double off = std::abs(sum - wanted); off < least) least = off, cut.lower = k, lower = sum;
      if (k < blocks.size()) sum += load_[blocks[k]] + of_none;
    }
    double beside = 0;  // load of the layers that meet at the cut
    if (cut.lower > 0 && cut.lower < blocks.size()) {
      const int above = places_[blocks[cut.lower]][axis], under = places_[blocks[cut.lower - 1]][axis];
      for (const std::uint32_t b : blocks) {
        const int at = places_[b][axis];
        if (at == above || at == under || at == under - (above == under ? 1 : 0)) beside += load_[b];
      }
    }
    cut.cost = std::max(lower / below, (all - lower) / (ranks - below)) + kGhost * kBeside * beside / ranks;
    cut.order = std::move(blocks);
    return cut;
  }

  const std::vector<std::array<int, 3>>& places_;
  const std::vector<double>& load_;
  std::vector<std::uint16_t> rank_;
};

}  // namespace

std::vector<std::uint16_t> bisect(const std::vector<std::array<int, 3>>& places, const std::vector<double>& load,
                                  int ranks) {
  Bisection bisection(places, load);
  std::vector<std::uint32_t> all(places.size());
  std::iota(all.begin(), all.end(), 0u);
  bisection.divide(std::move(all), 0, ranks);
  return bisection.take();
}

}  // namespace bedload
