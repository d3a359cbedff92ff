#include "bedload/geometry/packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "bedload/case/grain_sizes.hpp"
#include "bedload/case/particle_file.hpp"
#include "bedload/core/error.hpp"
#include "bedload/core/random.hpp"
#include "bedload/geometry/build_shape.hpp"
#include "bedload/geometry/clump.hpp"
#include "bedload/geometry/lattice.hpp"
#include "bedload/geometry/sampling.hpp"
#include "bedload/parallel/host_loop.hpp"
#include "placed_grains.hpp"

namespace bedload {
namespace {

constexpr double kRandomLimit = 0.30;              // above it grains that fit a lattice go there
constexpr double kRandomMost = 0.38;               // where random sequential places run out
constexpr double kFits = 4;                        // ratio of sizes from which fine grains fill voids
constexpr std::uint64_t kOrientations = 1u << 20;  // stream of random numbers of the first clump
constexpr int kTries = 20000;                      // per grain, before the lattice takes over
constexpr std::size_t kAtOnce = 1u << 16;          // places tried at once, at most

template <class T>
void shuffle(std::vector<T>& items, CounterRandom& random) {
  for (std::size_t n = items.size(); n > 1; --n) std::swap(items[n - 1], items[random.below(n)]);
}

double sphere_volume(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }

/// Places the grains of one fill after the other.
class Packer {
 public:
  Packer(const Config& config, Setup::Grains& grains)
      : config_(config), grains_(grains), placed_(config.domain) {}

  void add_fill(std::size_t index) {
    const std::size_t begin = grains_.x.size();
    place_fill(index);
    grains_.clump.resize(grains_.x.size(), 0);
    if (!fill_->rigid.present) return;
    for (std::size_t n = begin; n < grains_.x.size(); ++n) count_as_placed(grains_.x[n], grains_.radius[n]);
  }

 private:
  using Spheres = std::vector<std::pair<Vec3d, double>>;  ///< centres, radii

  void place_fill(std::size_t index) {
    index_ = index;
    fill_ = &config_.grain.fills[index];
    clump_ = config_.grain.clump_of(*fill_);
    CounterRandom random(config_.grain.seed, index);
    if (!fill_->file.empty() || !fill_->positions.empty())
      return add_listed(listed_grains(*fill_, config_.domain), random);
    if (!fill_->every.empty()) return add_listed(lattice_sites(), random);
    const std::size_t count = wanted_count();
    std::vector<double> radii = radii_of(count);
    shuffle(radii, random);
    check_box();
    const double solid = std::transform_reduce(radii.begin(), radii.end(), 0.0, std::plus<>{}, sphere_volume);
    const bool dense = solid >= kRandomLimit * volume();
    const bool tries = !dense || (solid < most_at_random(radii) * volume() && !fit_lattice(radii));
    auto places = tries ? random_places(radii, random) : std::nullopt;
    if (!places) places = lattice_places(radii, random);
    for (std::size_t n = 0; n < count; ++n) add((*places)[n], radii[n]);
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw KeyError(fmt::format("grain.fill.{}", index_), fmt::format("grain.fill {}: {}", index_ + 1, why));
  }

  /// Radius of the sphere about its centre that holds a grain, over that of the sphere of its volume.
  double reach() const { return clump_ ? 2 * clump_->shape.reach : 1; }

  std::vector<SizeClass> sizes() const {
    return fill_->sizes.empty() ? std::vector<SizeClass>{{config_.grain.d, 1}} : fill_->sizes;
  }

  double box_volume() const {
    const Vec3d size = fill_->max - fill_->min;
    return size.x * size.y * size.z;
  }

  /// Of the space to fill, m3.
  double volume() const {
    if (!fill_->solid.shape) return box_volume();
    return volume_below(*fill_->solid.shape, {0, 0, 1}, Bounds::kInfinity, std::cbrt(box_volume() / 1e6));
  }
  /// Inside the shape to fill, by `allowed` short of it at most (m).
  bool inside_shape(const Vec3d& x, double radius, double allowed) const {
    return !fill_->solid.shape || fill_->solid.shape->distance(x) <= allowed - radius;
  }

  std::size_t wanted_count() const {
    double n = double(fill_->count);
    const double rho = config_.grain.density(*fill_);
    if (fill_->mass > 0) n = std::round(count_for_volume(sizes(), fill_->mass / rho));
    if (fill_->packing_fraction > 0)
      n = std::round(count_for_volume(sizes(), fill_->packing_fraction * volume()));
    if (n < 1) fail("holds no grain; raise its count, mass or packing_fraction");
    if (n >= 2147483648.0) fail(fmt::format("{:.3g} grains: must be fewer than 2^31", n));
    return std::size_t(n);
  }

  /// Entry after entry of the sizes, those of a distribution from small to large.
  std::vector<double> radii_of(std::size_t count) const {
    std::vector<double> radii = diameters(sizes(), count);
    for (double& r : radii) r /= 2;
    return radii;
  }

  /// Solid fraction that random places of unlike sizes may reach, one in the voids of another; that of one
  /// size is left to the lattice.
  double most_at_random(const std::vector<double>& radii) const {
    const auto [least, most] = std::minmax_element(radii.begin(), radii.end());
    if (clump_ || *most < 2 * *least) return 0;
    return 1 - std::pow(1 - kRandomMost, 1 + std::floor(std::log(*most / *least) / std::log(kFits)));
  }
  bool fit_lattice(const std::vector<double>& radii) const {
    const double d_max = 2 * reach() * *std::max_element(radii.begin(), radii.end());
    return double(radii.size()) * d_max * d_max * d_max <= volume();
  }

  bool spans_period(int k) const {
    const DomainConfig& domain = config_.domain;
    const double slack = 1e-6 * (domain.max[k] - domain.min[k]);
    return domain.periodic[k] && fill_->min[k] <= domain.min[k] + slack &&
           fill_->max[k] >= domain.max[k] - slack;
  }

  void check_box() const {
    double d = 0;
    for (const SizeClass& size : sizes()) d = std::max(d, reach() * size_range(size).second);
    const double slack = 1e-6 * d;
    for (int k = 0; k < 3; ++k) {
      const double length = fill_->max[k] - fill_->min[k];
      const bool outside =
          fill_->min[k] < config_.domain.min[k] - slack || fill_->max[k] > config_.domain.max[k] + slack;
      if (outside && !fill_->solid.shape)
        fail(fmt::format("its box runs from {} = {:g} to {:g} m, the domain only from {:g} to {:g} m",
                         "xyz"[k], fill_ -> min[k], fill_ -> max[k], config_.domain.min[k],
                         config_.domain.max[k]));
      if (length < d - slack)
        fail(fmt::format("a grain of {:g} m does not fit a box {:g} m wide along {}", d, length, "xyz"[k]));
    }
  }

  /// Clear of every wall, by `allowed` overlap at most (m).
  bool clear_of_walls(const Vec3d& x, double radius, double allowed) const {
    for (const WallBody& body : config_.wall.bodies)
      if (body.stops_grains() &&
          wall_clearance(body, x, 10 * config_.grain.d_max, config_.domain) < radius - allowed)
        return false;
    return true;
  }

  void add(const Vec3d& x, double radius) {
    for (int k = 0; k < 3; ++k)
      if (x[k] < config_.domain.min[k] || x[k] > config_.domain.max[k])
        fail(fmt::format("shape \"{}\" reaches to ({:g}, {:g}, {:g}) m, outside the domain", fill_->shape,
                         x.x, x.y, x.z));
    add(x, radius, fill_->velocity, fill_->spin);
  }
  /// Those of a rigid group may overlap each other, since it has no contacts within: add_fill counts them as
  /// placed for the fills after it.
  void add(const Vec3d& x, double radius, const Vec3d& v, const Vec3d& omega) {
    const std::size_t begin = grains_.x.size();
    const std::size_t clump = grains_.clumps.size();
    for (const auto& [arm, r] : spheres_of(clump, radius))
      add_sphere(x + arm, r, v + cross(omega, arm), omega);
    if (!clump_) return;
    grains_.clumps.push_back({std::uint32_t(index_), 2 * radius, x, v, omega, orientation(clump)});
    grains_.clump.resize(grains_.x.size(), std::uint32_t(grains_.clumps.size()));
    for (std::size_t n = begin; n < grains_.x.size(); ++n) count_as_placed(grains_.x[n], grains_.radius[n]);
  }
  /// For those that come after it, if any does that asks.
  void count_as_placed(const Vec3d& x, double radius) {
    const bool own_fill_asks = !fill_->file.empty() || !fill_->positions.empty() || !fill_->every.empty();
    if (own_fill_asks || index_ + 1 < config_.grain.fills.size()) placed_.add(x, radius);
  }
  /// Centres from that of a grain, and radii, of its spheres, m. `radius`: of the sphere of its
  /// volume.
  Spheres spheres_of(std::size_t clump, double radius) const {
    if (!clump_) return {{{}, radius}};
    return turned_spheres(clump_->shape, 2 * radius, orientation(clump));
  }
  Quat<double> orientation(std::size_t clump) const {
    return clump_rotation(fill_->orientation, CounterRandom(config_.grain.seed, kOrientations + clump));
  }
  void add_sphere(const Vec3d& x, double radius, const Vec3d& v, const Vec3d& omega) {
    grains_.x.push_back(x);
    grains_.v.push_back(v);
    grains_.omega.push_back(omega);
    grains_.radius.push_back(radius);
    if (!fill_->rigid.present && !clump_) count_as_placed(x, radius);
  }

  /// The radii of grains whose places are given: classes in their order, distributions mixed.
  std::vector<double> radii_of(const ParticleList& list, CounterRandom& random) const {
    std::vector<double> radii = list.d;
    for (double& r : radii) r /= 2;
    if (!radii.empty()) return radii;
    radii = radii_of(list.x.size());
    for (const SizeClass& size : sizes())
      if (size.kind != SizeKind::one_size) {
        shuffle(radii, random);
        break;
      }
    return radii;
  }

  void add_listed(ParticleList list, CounterRandom& random) {
    const std::vector<double> radii = radii_of(list, random);
    for (std::size_t n = 0; n < radii.size(); ++n) {
      Vec3d& x = list.x[n];
      const auto reject = [&](const char* why) {
        const auto what = fmt::format("grain {} at ({:g}, {:g}, {:g}) m {}", n + 1, x.x, x.y, x.z, why);
        if (list.file.empty()) fail(what);
        throw CaseError(list.place(n) + ": " + what);
      };
      if (!lies_inside(config_.domain, x)) reject("lies outside the domain");
      for (const auto& [arm, r] : spheres_of(grains_.clumps.size(), radii[n])) {
        const double allowed = 0.1 * r;  // grains may be given in contact
        if (!clear_of_walls(x + arm, r, allowed)) reject("lies inside a wall");
        if (!placed_.is_free(x + arm, r - allowed)) reject("lies inside another grain");
      }
      add(x, radii[n], list.v.empty() ? fill_->velocity : list.v[n],
          list.omega.empty() ? fill_->spin : list.omega[n]);
    }
  }

  /// Of the lattice on which fluid starts in a box, each so many along every axis, or of all, that lie in
  /// the space to fill.
  ParticleList lattice_sites() const {
    std::array<Cells, 3> cells;
    std::array<std::int64_t, 3> every{1, 1, 1};
    const bool by_axis = fill_->every.size() == 3;
    for (int k = 0; k < 3; ++k) {
      cells[k] = fit_cells(fill_->min[k], fill_->max[k], config_.fluid.dx);
      if (by_axis) every[k] = std::llround(fill_->every[k]);
    }
    const std::int64_t interval = by_axis ? 1 : std::llround(fill_->every[0]);
    std::int64_t count = 0;
    ParticleList sites;
    for (std::int64_t l = every[2] - 1; l < cells[2].count; l += every[2])
      for (std::int64_t j = every[1] - 1; j < cells[1].count; j += every[1])
        for (std::int64_t i = every[0] - 1; i < cells[0].count; i += every[0]) {
          const Vec3d x{cells[0].centre(i), cells[1].centre(j), cells[2].centre(l)};
          if (inside_shape(x, 0, 0) && ++count % interval == 0) sites.x.push_back(x);
        }
    if (sites.x.empty())
      fail(fmt::format("holds no grain: its lattice has {} x {} x {} sites", cells[0].count, cells[1].count,
                       cells[2].count));
    return sites;
  }

  /// One after the other, the largest first, each at the first of a sequence of random places that is free;
  /// nothing if space runs out. Grains of one size ask for the same places, so that many are tried at once.
  std::optional<std::vector<Vec3d>> random_places(const std::vector<double>& radii, CounterRandom& random) {
    const PlacedGrains before = placed_;
    std::vector<std::size_t> order(radii.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return radii[i] > radii[j]; });
    std::vector<Vec3d> places(radii.size()), tried;
    std::vector<char> clear;
    std::size_t placed = 0, alike = 0;  // those before it; those of the size of the next one
    int failed = 0;                     // attempts for the next one
    while (placed < order.size() && failed < kTries) {
      const double radius = radii[order[placed]];
      for (alike = std::max(alike, placed + 1); alike < order.size() && !clump_; ++alike)
        if (radii[order[alike]] != radius) break;
      tried.resize(std::min(kAtOnce, std::max(std::size_t(failed), alike - placed)));
      CounterRandom ahead = random;
      for (Vec3d& x : tried) x = random_place(radius, ahead);
      clear.resize(tried.size());
      host_for_each(tried.size(), [&](std::size_t n) { clear[n] = fits(tried[n], order[placed], radius); });
      for (std::size_t n = 0; n < tried.size() && placed < alike && failed < kTries; ++n) {
        for (int k = 0; k < 3; ++k) random.bits();  // of this place
        ++failed;
        const auto spheres = spheres_of(grains_.clumps.size() + order[placed], radius);
        if (!clear[n] || !free_of_grains(tried[n], spheres)) continue;
        for (const auto& [arm, r] : spheres) placed_.add(tried[n] + arm, r);
        places[order[placed++]] = tried[n];
        failed = 0;
      }
    }
    placed_ = before;
    if (placed < order.size()) return std::nullopt;
    return places;
  }

  Vec3d random_place(double radius, CounterRandom& random) const {
    Vec3d x;
    for (int k = 0; k < 3; ++k) {
      const double margin = spans_period(k) || clump_ ? 0 : radius;
      const double lo = fill_->min[k] + margin, hi = fill_->max[k] - margin;
      x[k] = lo + random.uniform() * std::max(0.0, hi - lo);
    }
    return x;
  }

  bool free_of_grains(const Vec3d& x, const Spheres& spheres) const {
    return std::all_of(spheres.begin(), spheres.end(),
                       [&](const auto& s) { return placed_.is_free(x + s.first, s.second); });
  }
  /// Whether grain `n` of the fill touches neither a grain placed so far nor what bounds the space.
  bool fits(const Vec3d& x, std::size_t n, double radius) const {
    const Spheres spheres = spheres_of(grains_.clumps.size() + n, radius);
    return free_of_grains(x, spheres) && std::all_of(spheres.begin(), spheres.end(), [&](const auto& s) {
             const Vec3d at = x + s.first;
             return inside_box(at, s.second) && inside_shape(at, s.second, 1e-6 * s.second) &&
                    clear_of_walls(at, s.second, 1e-6 * s.second);
           });
  }

  /// Of a box to fill, but for sides across which it is periodic.
  bool inside_box(const Vec3d& x, double radius) const {
    for (int k = 0; k < 3; ++k)
      if (clump_ && !spans_period(k) && (x[k] - radius < fill_->min[k] || x[k] + radius > fill_->max[k]))
        return false;
    return true;
  }

  /// Cells of a cubic lattice no narrower than the largest grain, taken at random, each
  /// grain shaken within its own; a clump as the sphere around it. The cells are as wide as the number of
  /// grains allows.
  std::vector<Vec3d> lattice_places(std::vector<double> radii, CounterRandom& random) const {
    for (double& r : radii) r *= reach();
    const double r_max = *std::max_element(radii.begin(), radii.end()), d_max = 2 * r_max;
    const double needed = double(radii.size());
    std::array<Cells, 3> cells;
    std::vector<Vec3d> centres;
    double width = std::max(d_max, std::cbrt(box_volume() / needed));
    while (true) {
      double held = 1;
      for (int k = 0; k < 3; ++k) {
        const double length = fill_->max[k] - fill_->min[k];
        const double n = std::max(1.0, std::floor(length / width + 1e-6));
        cells[k] = {fill_->min[k], length / n, std::int64_t(n)};
        held *= n;
      }
      if (held >= needed) {
        centres = free_centres(cells, r_max);
        held = double(centres.size());
      }
      if (held >= needed) break;
      if (width <= d_max) {
        const double d_min = 2 * *std::min_element(radii.begin(), radii.end());
        if (d_min < d_max)
          fail(
              fmt::format("{} grains of {:g} to {:g} m find no places at random in the space of {:.4g} m3; "
                          "enlarge it and let the grains settle",
                          radii.size(), d_min, d_max, volume()));
        fail(
            fmt::format("{} grains of {:g} m need at least {:.4g} m3, the space of {:.4g} m3 holds {:.0f} of "
                        "them; enlarge it and let the grains settle",
                        radii.size(), d_max, needed * d_max * d_max * d_max, volume(), held));
      }
      width = std::max(d_max, 0.99 * width);
    }
    shuffle(centres, random);
    centres.resize(radii.size());
    std::vector<Vec3d> shaken = centres;
    for (Vec3d& x : shaken)
      for (int k = 0; k < 3; ++k) x[k] += (random.uniform() - 0.5) * 0.98 * (cells[k].step - d_max);
    host_for_each(radii.size(), [&](std::size_t n) {
      const Vec3d& x = shaken[n];
      if (inside_shape(x, radii[n], 1e-6 * radii[n]) && placed_.is_free(x, radii[n]) &&
          clear_of_walls(x, radii[n], 1e-6 * radii[n]))
        centres[n] = x;
    });
    return centres;
  }

  /// Centres of the cells where the largest grain touches neither wall nor earlier grain.
  std::vector<Vec3d> free_centres(const std::array<Cells, 3>& cells, double r_max) const {
    const double slack = 1e-6 * r_max;
    std::vector<std::vector<Vec3d>> layers(std::size_t(cells[2].count));
    host_for_each(layers.size(), [&](std::size_t layer) {
      const auto l = std::int64_t(layer);
      for (std::int64_t j = 0; j < cells[1].count; ++j)
        for (std::int64_t i = 0; i < cells[0].count; ++i) {
          const Vec3d x{cells[0].centre(i), cells[1].centre(j), cells[2].centre(l)};
          const double outside =
              fill_->solid.shape ? fill_->solid.shape->distance(x) - (slack - r_max) : 0;  // m
          if (outside > 0) {  // as are all cells nearer to x than that
            const double cells_on = std::ceil(outside / cells[0].step * (1 - 1e-9));
            i += std::int64_t(std::min(cells_on, double(cells[0].count))) - 1;
          } else if (placed_.is_free(x, r_max - slack) && clear_of_walls(x, r_max, slack)) {
            layers[layer].push_back(x);
          }
        }
    });
    std::vector<Vec3d> centres;
    for (const auto& layer : layers) centres.insert(centres.end(), layer.begin(), layer.end());
    return centres;
  }

  const Config& config_;
  Setup::Grains& grains_;
  PlacedGrains placed_;
  std::size_t index_ = 0;
  const GrainFill* fill_ = nullptr;
  const ClumpConfig* clump_ = nullptr;  ///< of the fill; null: spheres
};

}  // namespace

void add_grains(const Config& config, Setup::Grains& grains) {
  Packer packer(config, grains);
  for (std::size_t index = 0; index < config.grain.fills.size(); ++index) {
    packer.add_fill(index);
    grains.fill.resize(grains.x.size(), std::uint32_t(index));
  }
}

}  // namespace bedload
