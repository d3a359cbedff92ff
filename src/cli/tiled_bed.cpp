#include "tiled_bed.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bedload/case/particle_file.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/sampling.hpp"
#include "src/geometry/placed_grains.hpp"

namespace bedload {
namespace {

constexpr double kAllowed = 0.1;  // overlap of grains at rest, in radii, at most

const HostStore& store_of(const SavedState& state, const char* name) {
  for (const HostStore& store : state.stores)
    if (store.name == name) return store;
  throw FileError(std::string("settled bed: no ") + name);
}

/// The places where a store has the particles, by id.
std::vector<std::size_t> by_id(const HostStore& store) {
  const auto* id = store.find("id")->as<std::uint32_t>();
  std::vector<std::size_t> places(store.count);
  for (std::size_t k = 0; k < store.count; ++k) places[k] = k;
  std::sort(places.begin(), places.end(), [&](auto a, auto b) { return id[a] < id[b]; });
  return places;
}

/// The tile where it came to rest; clumps are whole and have their centres in it.
Setup::Grains at_rest(const Config& tile, Setup::Grains grains, const SavedState& settled) {
  const Vec3d side = tile.domain.max - tile.domain.min;
  const auto next_to = [&](const Vec3d& x, const Vec3d& centre) {
    Vec3d near = x;
    for (int k = 0; k < 2; ++k) near[k] += side[k] * std::round((centre[k] - x[k]) / side[k]);
    return near;
  };
  const HostStore& store = store_of(settled, "grains");
  const auto* x = store.find("x")->as<Vec3d>();
  const auto places = by_id(store);
  for (std::size_t n = 0; n < places.size(); ++n) grains.x[n] = x[places[n]], grains.v[n] = {};
  grains.omega.clear();
  if (grains.clumps.empty()) return grains;
  const HostStore& clumps = store_of(settled, "clumps");
  const auto* centre = clumps.find("x")->as<Vec3d>();
  const auto* q = clumps.find("rotation")->as<double>();
  const auto of_clump = by_id(clumps);
  const std::size_t rigid = of_clump.size() - grains.clumps.size();  // fills that are one body come first
  for (std::size_t c = 0; c < grains.clumps.size(); ++c) {
    Setup::Grains::Clump& clump = grains.clumps[c];
    const std::size_t k = of_clump[rigid + c];
    clump.x = next_to(centre[k], 0.5 * (tile.domain.min + tile.domain.max));
    clump.v = clump.omega = {};
    clump.rotation = {q[4 * k + 3], q[4 * k], q[4 * k + 1], q[4 * k + 2]};
  }
  for (std::size_t n = 0; n < grains.x.size(); ++n)
    if (grains.clump[n] > 0) grains.x[n] = next_to(grains.x[n], grains.clumps[grains.clump[n] - 1].x);
  return grains;
}

class Bed {
 public:
  Bed(const Config& whole, Setup::Grains grains)
      : config_(whole), grains_(std::move(grains)), others_(whole.domain) {
    for (std::size_t n = 0; n < grains_.x.size(); ++n) others_.add(grains_.x[n], grains_.radius[n]);
    any_others_ = !grains_.x.empty();
    grains_.omega.clear(), grains_.clumps.clear();
    grains_.clump.assign(grains_.x.size(), 0);
  }

  /// fill: of the whole, at which those of the tile begin.
  void add(const Setup::Grains& tile, const Vec3d& shift, std::uint32_t fill) {
    for (std::size_t n = 0, end; n < tile.x.size(); n = end) {
      const std::uint32_t clump = tile.clump[n];
      end = n + 1;
      while (clump > 0 && end < tile.x.size() && tile.clump[end] == clump) ++end;
      if (!fits(tile, shift, n, end)) continue;
      if (clump > 0) {
        grains_.clumps.push_back(tile.clumps[clump - 1]);
        grains_.clumps.back().fill += fill, grains_.clumps.back().x += shift;
      }
      for (std::size_t k = n; k < end; ++k) {
        grains_.x.push_back(wrapped(tile.x[k] + shift));
        grains_.v.push_back({});
        grains_.radius.push_back(tile.radius[k]);
        grains_.fill.push_back(tile.fill[k] + fill);
        grains_.clump.push_back(clump > 0 ? std::uint32_t(grains_.clumps.size()) : 0);
      }
    }
  }
  Setup::Grains take() { return std::move(grains_); }

 private:
  Vec3d wrapped(Vec3d x) const {
    const DomainConfig& of = config_.domain;
    for (int k = 0; k < 3; ++k) {
      const double period = of.max[k] - of.min[k];
      if (of.periodic[k]) x[k] -= period * std::floor((x[k] - of.min[k]) / period);
    }
    return x;
  }
  bool fits(const Setup::Grains& tile, const Vec3d& shift, std::size_t begin, std::size_t end) const {
    for (std::size_t n = begin; n < end; ++n) {
      Vec3d x = wrapped(tile.x[n] + shift);
      const double r = (1 - kAllowed) * tile.radius[n];
      if (!lies_inside(config_.domain, x) || (any_others_ && !others_.is_free(x, r))) return false;
      for (const WallBody& body : config_.wall.bodies)
        if (body.stops_grains() && wall_clearance(body, x, 10 * config_.grain.d_max, config_.domain) < r)
          return false;
    }
    return true;
  }

  const Config& config_;
  Setup::Grains grains_;
  PlacedGrains others_;
  bool any_others_ = false;
};

}  // namespace

Setup::Grains tiled_bed(const Config& tile, const Setup::Grains& placed, const SavedState& settled,
                        const Config& whole, const Setup::Grains& others, int times) {
  const std::uint32_t fill = std::uint32_t(whole.grain.fills.size() - tile.grain.fills.size());
  Setup::Grains kept;
  for (std::size_t n = 0; n < others.x.size(); ++n) {
    if (others.fill[n] >= fill) continue;
    kept.x.push_back(others.x[n]), kept.v.push_back({});
    kept.radius.push_back(others.radius[n]), kept.fill.push_back(others.fill[n]);
  }
  Bed bed(whole, std::move(kept));
  const Setup::Grains rest = at_rest(tile, placed, settled);
  const Vec3d side = tile.domain.max - tile.domain.min;
  for (int j = 0; j < times; ++j)
    for (int i = 0; i < times; ++i) bed.add(rest, {i * side.x, j * side.y, 0}, fill);
  return bed.take();
}

}  // namespace bedload
