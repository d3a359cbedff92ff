#include "bedload/neighbours/size_levels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "bedload/parallel/ranks.hpp"

namespace BL_SOLVER {
namespace {

constexpr double kLeastRatio = 2;     // of the largest radii of two levels that follow each other
constexpr double kCellCost = 0.2;     // of a cell looked up, in tests of a pair
constexpr double kCellsLookedUp = 8;  // on each level of larger particles
constexpr double kSolidFraction = 0.6;
constexpr double kBinsPerOctave = 4;
constexpr double kMostCells = 32;  // per particle of the level: fewer, wider ones in a vast domain

/// Particles of about one size.
struct Bin {
  double largest = 0;  ///< radius, m
  double count = 0;
};

/// From the largest to the smallest, of all ranks.
std::vector<Bin> bins_of(const std::vector<Real>& radius, double largest) {
  const auto place = [&](Real r) {
    return std::size_t(std::max(0.0, kBinsPerOctave * std::log2(largest / double(r))));
  };
  std::size_t count = 0;
  for (const Real r : radius) count = std::max(count, place(r) + 1);
  std::vector<Bin> bins(all_reduce(count, [](auto& into, auto more) { into = std::max(into, more); }));
  const auto add = [](Bin& into, const Bin& more) {
    into.largest = std::max(into.largest, more.largest);
    into.count += more.count;
  };
  for (const Real r : radius) add(bins[place(r)], {double(r), 1});
  all_reduce(bins, add);
  std::erase_if(bins, [](const Bin& bin) { return bin.count == 0; });
  return bins;
}

/// Which bins each level begins with: those for which lists cost least.
class Division {
 public:
  Division(const std::vector<Bin>& bins, double gap) : bins_(bins), gap_(gap) {
    for (const Bin& bin : bins) solid_ += 4.0 / 3 * std::numbers::pi * std::pow(bin.largest, 3) * bin.count;
  }

  std::vector<std::size_t> best() const {
    constexpr double never = std::numeric_limits<double>::infinity();
    const std::size_t n = bins_.size();
    struct Start {
      double cost = never;  ///< of all levels before this one
      std::vector<std::size_t> begins;
    };
    std::vector<Start> starts(n);
    starts[0] = {0, {0}};
    double least = never;
    std::vector<std::size_t> chosen;
    for (int level = 0; level < SizeLevels::kMost; ++level) {
      std::vector<Start> next(n);
      for (std::size_t b = 0; b < n; ++b) {
        if (starts[b].cost == never) continue;
        const double all = starts[b].cost + cost(b, n, level);
        if (all < least) least = all, chosen = starts[b].begins;
        for (std::size_t e = b + 1; e < n; ++e) {
          const double before = starts[b].cost + cost(b, e, level);
          if (bins_[b].largest < kLeastRatio * bins_[e].largest || !(before < next[e].cost)) continue;
          next[e] = {before, starts[b].begins};
          next[e].begins.push_back(e);
        }
      }
      starts = std::move(next);
    }
    return chosen;
  }

  /// Width of the cells of a level up to that radius, m.
  double cell(double largest) const { return 2 * largest + gap_; }
  double count(std::size_t begin, std::size_t end) const {
    double n = 0;
    for (std::size_t k = begin; k < end; ++k) n += bins_[k].count;
    return n;
  }

 private:
  /// Of a level of these bins under so many others, in tests of a pair.
  double cost(std::size_t begin, std::size_t end, int above) const {
    const double n = count(begin, end), cell = this->cell(bins_[begin].largest);
    const double in_cell = n * std::pow(cell, 3) * kSolidFraction / solid_;
    return n * (27 * in_cell + kCellCost * kCellsLookedUp * above);
  }

  const std::vector<Bin>& bins_;
  double gap_;
  double solid_ = 0;  ///< volume of all, m3
};

struct Borders {
  double largest[SizeLevels::kMost];
  int count;
  BL_HD std::uint32_t level_of(double radius) const {
    int level = 0;
    while (level + 1 < count && radius <= largest[level + 1]) ++level;
    return std::uint32_t(level);
  }
};

struct LevelPass {
  Borders borders;
  Span<const Real> radius;
  Span<const Index> order;  ///< empty: as they are
  Span<std::uint32_t> level;
  BL_HD void operator()(Index i) const { level[i] = borders.level_of(radius[order ? order[i] : i]); }
};

/// Numbers of the cells of a level.
struct CellPass {
  CellGridView grid;
  std::uint32_t of;
  Span<const Vec3d> x;
  Span<const std::uint32_t> level;
  Span<std::uint32_t> cell;
  BL_HD void operator()(Index i) const {
    if (level[i] != of) return;
    cell[i] = grid.number(grid.coordinate(x[i].x, 0), grid.coordinate(x[i].y, 1), grid.coordinate(x[i].z, 2));
  }
};

/// The first particle of each level.
struct BeginPass {
  Span<const std::uint32_t> level;
  Span<Index> begin;
  BL_HD void operator()(Index l) const { begin[l] = first_not_below(level, l); }
};

struct TakePass {
  Span<const Index> order;
  Span<const Vec3d> x;
  Span<Vec3d> taken;
  BL_HD void operator()(Index i) const { taken[i] = x[order[i]]; }
};

struct ComposePass {
  Span<const Index> by_level, in_level;
  Span<Index> order;
  BL_HD void operator()(Index k) const { order[k] = by_level[in_level[k]]; }
};

}  // namespace

void SizeLevels::choose(const std::vector<Real>& radius, double largest, double gap) {
  const std::vector<Bin> bins = bins_of(radius, largest);
  if (bins.size() < 2) return unite();
  const Division division(bins, gap);
  const std::vector<std::size_t> begins = division.best();
  if (begins.size() < 2) return unite();
  const double volume = frame_.length.x * frame_.length.y * frame_.length.z;
  std::vector<Level> levels;
  for (std::size_t l = 0; l < begins.size(); ++l) {
    const std::size_t end = l + 1 < begins.size() ? begins[l + 1] : bins.size();
    const double R = bins[begins[l]].largest;
    // in powers of two, so that cells stay as they are while a few particles come and go
    const double most = kMostCells * double(std::bit_ceil(std::uint64_t(division.count(begins[l], end))));
    levels.push_back({R, std::max(division.cell(R), std::cbrt(volume / most))});
  }
  if (levels == levels_) return;
  levels_ = levels;
  largest_.clear(), grids_.clear();
  for (const Level& level : levels) {
    largest_.push_back(level.largest);
    grids_.emplace_back(frame_, frame_.origin, frame_.origin + frame_.length, level.cell);
  }
}

void SizeLevels::unite() {
  levels_.clear(), grids_.clear();
  largest_.assign(1, 0);
}

namespace {

Borders borders_of(const SizeLevels& levels) {
  Borders borders{{}, levels.count()};
  for (int l = 0; l < levels.count(); ++l) borders.largest[l] = levels.largest(l);
  return borders;
}

}  // namespace

void SizeLevels::sort(Span<const Vec3d> x, Span<const Real> radius, Buffer<Index>& order, Span<const Id> id) {
  arrange(x, radius, order, id);
  with_ghosts_.resize(0);
  own_ = x.size, larger_ = begin_[count() - 1];
}

void SizeLevels::add_ghosts(Span<const Vec3d> x, Span<const Real> radius, Span<const Id> id) {
  arrange(x, radius, with_ghosts_, id);
}

void SizeLevels::places(Span<const Vec3d> x, Span<const Real> radius, Buffer<std::uint32_t>& level,
                        Buffer<std::uint32_t>& cell) const {
  level.resize(x.size), cell.resize(x.size);
  for_each({0, x.size}, LevelPass{borders_of(*this), radius, {}, level});
  for (int l = 0; l < count(); ++l)
    for_each({0, x.size}, CellPass{grid(l).view(), std::uint32_t(l), x, level, cell});
}

void SizeLevels::arrange(Span<const Vec3d> x, Span<const Real> radius, Buffer<Index>& order,
                         Span<const Id> id) {
  Buffer<std::uint32_t>& level = Context::current().scratch<std::uint32_t>();
  level.reserve_and_resize(x.size);
  Buffer<Index>& by_id = Context::current().scratch<Index>(3);
  if (id) {
    copy_on_device(level.data(), id.data, x.size * sizeof(Id));
    sort_keys(level, by_id, 32);
  }
  for_each({0, x.size}, LevelPass{borders_of(*this), radius, id ? by_id.span() : Span<const Index>(), level});
  sort_keys(level, by_level_, 3);
  if (id) {
    in_level_.resize(x.size);
    for_each({0, x.size}, ComposePass{by_id, by_level_, in_level_});
    by_level_.swap(in_level_);
  }
  begins_.resize(std::size_t(count()) + 1);
  for_each({0, Index(count()) + 1}, BeginPass{level, begins_});
  begin_ = begins_.to_host();

  Buffer<Vec3d>& taken = Context::current().scratch<Vec3d>();
  taken.reserve_and_resize(x.size);
  for_each({0, x.size}, TakePass{by_level_, x, taken});
  order.resize(x.size);
  for (int l = 0; l < count(); ++l) {
    const auto [begin, end] = particles(l);
    const Index n = end - begin;
    grids_[l].sort<Vec3d>(frame_, {taken.data() + begin, n}, in_level_);
    for_each({0, n}, ComposePass{{by_level_.data() + begin, n}, in_level_, {order.data() + begin, n}});
  }
}

}  // namespace BL_SOLVER
