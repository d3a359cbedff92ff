// Each layer of a body is the set of places equally deep below its surface. The volume between two such sets
// gives the number of particles in the layer; those are placed where lattice cells lie in it and then pushed
// apart along it until they lie evenly. Number and depth are thus exact by construction, and what relaxation
// leaves to chance is only the pattern within a layer. Free packings (all particles pushed in all directions)
// were tried: their first layer keeps no depth and their density sags behind the surface by some per cent.

#include "bedload/geometry/shape_sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "bedload/core/error.hpp"
#include "bedload/geometry/slice.hpp"
#include "bedload/parallel/host_loop.hpp"

namespace bedload {
namespace {

// Lengths in spacings.
constexpr double kReach = 2;         // of the repulsion
constexpr double kSkin = 0.3;        // by which cells are wider than that
constexpr double kStiffness = 0.08;  // step per force; larger ones ring
constexpr double kMemory = 0.8;      // fraction of the last step kept in the next
constexpr double kLongestStep = 0.2;
constexpr int kSteps = 60;
constexpr double kStray = 0.05;  // way after which a particle is brought back to its layer
constexpr double kTie = 1e-6;    // below it only rounding decides

struct Particle {
  Vec3d x, step;
  Vec3d normal;                        // of its layer, as last projected
  double strayed = Bounds::kInfinity;  // way since then, spacings
  int layer = 0;
};

/// Part of a layer in one lattice cell.
struct LayerPart {
  Vec3d centroid;
  double volume;  // spacing^3
  int layer;
};

/// Cuts the body into cubes of one spacing and finds how much of each layer they hold.
class LayerVolumes {
 public:
  LayerVolumes(const Shape& shape, double spacing, int layers)
      : shape_(shape), spacing_(spacing), layers_(layers) {
    const Bounds b = shape.bounds();
    Index3 count;
    for (int k = 0; k < 3; ++k) {
      count[k] = std::int64_t(std::floor((b.max[k] - b.min[k]) / spacing + 0.5 + kTie)) + 2;
      origin_[k] = 0.5 * (b.min[k] + b.max[k]) - 0.5 * double(count[k]) * spacing;
    }
    constexpr std::int64_t kBlock = 8;  // cubes along the sides of a piece of work
    std::vector<Block> blocks;
    split({{0, 0, 0}, count}, kBlock, blocks);
    parts_.resize(blocks.size());
    host_for_each(blocks.size(), [&](std::size_t n) {
      std::vector<Block> cubes;
      split(blocks[n], 1, cubes);
      for (const Block& cube : cubes) add_parts(cube.begin, parts_[n]);
    });
  }

  /// One particle for each full spacing^3 of a layer, met on a way through the body that stays in one
  /// neighbourhood as long as it can.
  std::vector<Particle> place() const {
    std::vector<double> owed(layers_, 0);
    std::vector<Particle> particles;
    for (const auto& block : parts_)
      for (const LayerPart& part : block) {
        owed[part.layer] += part.volume;
        if (owed[part.layer] < 0.5 - kTie) continue;
        owed[part.layer] -= 1;
        Particle p;
        p.x = off_ridge(part.centroid), p.layer = part.layer;
        particles.push_back(p);
      }
    return particles;
  }

 private:
  /// In the middle of a body, as near to one side as to another, round-off would decide which way is out: the
  /// same body elsewhere would have another layout. From a place like that a small step, always the same.
  Vec3d off_ridge(const Vec3d& x) const {
    const Vec3d aside = spacing_ * Vec3d{0.51, 0.59, 0.63};
    const SurfacePoint one = shape_.nearest(x + kTie * aside), other = shape_.nearest(x - kTie * aside);
    return dot(one.normal, other.normal) < 0.9 ? x + 1e-3 * aside : x;
  }

  using Index3 = std::array<std::int64_t, 3>;
  struct Block {
    Index3 begin, end;
  };

  /// Halves a block until no side is longer than `size` cubes; drops what holds no part of a layer.
  void split(const Block& block, std::int64_t size, std::vector<Block>& pieces) const {
    int longest = 0;
    Index3 n;
    Vec3d half, centre;
    for (int k = 0; k < 3; ++k) {
      n[k] = block.end[k] - block.begin[k];
      if (n[k] > n[longest]) longest = k;
      half[k] = 0.5 * double(n[k]) * spacing_;
      centre[k] = origin_[k] + double(block.begin[k]) * spacing_ + half[k];
    }
    const double d = shape_.distance(centre), radius = norm(half);
    if (d > radius || d < -(layers_ * spacing_ + radius)) return;
    if (n[longest] <= size) return pieces.push_back(block);
    Block lower = block, upper = block;
    lower.end[longest] = upper.begin[longest] = block.begin[longest] + n[longest] / 2;
    split(lower, size, pieces);
    split(upper, size, pieces);
  }

  void add_parts(const Index3& cube, std::vector<LayerPart>& parts) const {
    const std::size_t begin = parts.size();
    for (int part = 0; part < 8; ++part) {  // each eighth as if its layers ran across one of its sides
      Vec3d x;
      for (int k = 0; k < 3; ++k)
        x[k] = origin_[k] + (double(cube[k]) + (part >> k & 1 ? 0.75 : 0.25)) * spacing_;
      const double depth = -shape_.distance(x) / spacing_;
      const int first = std::max(0, int(std::floor(depth - 0.25)));
      for (int layer = first; layer < layers_ && layer < depth + 0.25; ++layer) {
        const double volume =
            0.25 * (std::min(depth + 0.25, layer + 1.0) - std::max(depth - 0.25, double(layer)));
        if (!(volume > 0)) continue;
        auto part = std::find_if(parts.begin() + begin, parts.end(),
                                 [&](const LayerPart& s) { return s.layer == layer; });
        if (part == parts.end()) part = parts.insert(part, {{}, 0, layer});
        part->centroid += volume * x;
        part->volume += volume;
      }
    }
    for (std::size_t n = begin; n < parts.size(); ++n) parts[n].centroid *= 1 / parts[n].volume;
  }

  const Shape& shape_;
  double spacing_;
  int layers_;
  Vec3d origin_;
  std::vector<std::vector<LayerPart>> parts_;
};

/// Particles sorted by cells, so that the neighbours of a cell stand in nine runs.
class Cells {
 public:
  using Run = std::pair<std::uint32_t, std::uint32_t>;

  void sort(std::vector<Particle>& particles, const Vec3d& origin, double width) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(particles.size());
    host_for_each(particles.size(), [&](std::size_t i) {
      std::uint64_t key = 0;
      for (int k = 2; k >= 0; --k)
        key = key << kBits | std::uint64_t(std::floor((particles[i].x[k] - origin[k]) / width));
      order[i] = {key, std::uint32_t(i)};
    });
    std::sort(order.begin(), order.end());

    std::vector<Particle> sorted(particles.size());
    keys_.clear(), start_.clear();
    for (std::size_t i = 0; i < order.size(); ++i) {
      sorted[i] = particles[order[i].second];
      if (i == 0 || order[i].first != keys_.back())
        keys_.push_back(order[i].first), start_.push_back(std::uint32_t(i));
    }
    start_.push_back(std::uint32_t(order.size()));
    particles.swap(sorted);

    runs_.resize(keys_.size());
    host_for_each(keys_.size(), [&](std::size_t c) {
      for (int n = 0; n < 9; ++n) {
        const std::uint64_t row = keys_[c] + (std::uint64_t(n % 3) << kBits) +
                                  (std::uint64_t(n / 3) << 2 * kBits) - (std::uint64_t(1) << kBits) -
                                  (std::uint64_t(1) << 2 * kBits);
        const auto begin = std::lower_bound(keys_.begin(), keys_.end(), row - 1);
        const auto end = std::upper_bound(begin, keys_.end(), row + 1);
        runs_[c][n] = {start_[begin - keys_.begin()], start_[end - keys_.begin()]};
      }
    });
  }

  std::size_t size() const { return keys_.size(); }
  Run particles(std::size_t cell) const { return {start_[cell], start_[cell + 1]}; }
  const std::array<Run, 9>& neighbours(std::size_t cell) const { return runs_[cell]; }

  static constexpr int kBits = 21;

 private:
  std::vector<std::uint64_t> keys_;  // of cells that hold particles
  std::vector<std::uint32_t> start_;
  std::vector<std::array<Run, 9>> runs_;
};

/// Pushes the particles of all layers apart, each along its own.
class Relaxation {
 public:
  Relaxation(const Shape& shape, double spacing, std::vector<Particle>& particles)
      : shape_(shape), spacing_(spacing), particles_(particles) {
    const double width = (kReach + kSkin) * spacing;
    origin_ = shape.bounds().grown(3 * width).min;
    settle();
    double moved = Bounds::kInfinity;  // since cells were made, at most, in spacings
    for (int step = 0; step < kSteps; ++step) {
      if (moved > 0.5 * kSkin) cells_.sort(particles_, origin_, width), moved = 0;
      moved += push();
      host_for_each(cells_.size(), [&](std::size_t c) {
        const auto [begin, end] = cells_.particles(c);
        for (std::uint32_t i = begin; i < end; ++i)
          if (particles_[i].strayed > kStray) project(particles_[i]);
      });
    }
    settle();
  }

 private:
  /// One step; returns the longest, in spacings.
  double push() {
    force_.resize(particles_.size());
    places_.resize(particles_.size());
    for (std::size_t i = 0; i < particles_.size(); ++i) places_[i] = particles_[i].x;
    host_for_each(cells_.size(), [&](std::size_t c) {
      const auto [begin, end] = cells_.particles(c);
      for (std::uint32_t i = begin; i < end; ++i)
        force_[i] = repulsion(particles_[i].x, cells_.neighbours(c));
    });
    std::vector<double> longest(cells_.size(), 0);
    host_for_each(cells_.size(), [&](std::size_t c) {
      const auto [begin, end] = cells_.particles(c);
      for (std::uint32_t i = begin; i < end; ++i) {
        Particle& p = particles_[i];
        p.step = kMemory * p.step + kStiffness * force_[i];
        p.step -= dot(p.step, p.normal) * p.normal;
        double length = norm(p.step) / spacing_;
        if (length > kLongestStep) p.step *= kLongestStep / length, length = kLongestStep;
        p.x += p.step;
        p.strayed += length;
        longest[c] = std::max(longest[c], length);
      }
    });
    return *std::max_element(longest.begin(), longest.end());
  }

  /// Sum of (1 - r2 / reach2)^2 / r2 along r, m: steep where near, smooth at its end.
  Vec3d repulsion(const Vec3d& x, const std::array<Cells::Run, 9>& runs) const {
    const double reach2 = kReach * kReach * spacing_ * spacing_, near2 = 0.01 * spacing_ * spacing_;
    Vec3d sum;
    for (const auto& [begin, end] : runs)
      for (std::uint32_t j = begin; j < end; ++j) {
        const Vec3d apart = x - places_[j];
        const double r2 = norm2(apart), t = 1 - r2 / reach2;
        if (t > 0) sum += (t * t / (r2 + near2)) * apart;
      }
    return spacing_ * spacing_ * sum;
  }

  /// All particles to the depth of their layers; near edges one projection may not suffice.
  void settle() {
    constexpr int kMost = 8;
    host_for_each(particles_.size(), [&](std::size_t i) {
      for (int n = 0; n < kMost && project(particles_[i]) > 1e-9 * spacing_; ++n) continue;
    });
  }

  /// Moves p along the normal to the depth of its layer; returns how far, m.
  double project(Particle& p) const {
    const SurfacePoint surface = shape_.nearest(p.x);
    double inward = (p.layer + 0.5) * spacing_ + surface.distance;
    if (inward > 0.05 * spacing_) {
      const SurfacePoint beyond = shape_.nearest(p.x - inward * surface.normal);
      const bool past_middle = dot(beyond.normal, surface.normal) < -0.5;  // of a body too thin: stay there
      if (past_middle) inward = 0.5 * (inward + surface.distance - beyond.distance);
    }
    p.x -= inward * surface.normal;
    p.normal = surface.normal;
    p.strayed = 0;
    return std::abs(inward);
  }

  const Shape& shape_;
  double spacing_;
  std::vector<Particle>& particles_;
  Vec3d origin_;
  Cells cells_;
  std::vector<Vec3d> places_, force_;  // where each is, packed for the search; m
};

}  // namespace

std::vector<Vec3d> sample_shape(const Shape& shape, double spacing, double depth) {
  for (const auto& [what, length] : {std::pair{"spacing", spacing}, std::pair{"depth", depth}})
    if (!(length > 0 && std::isfinite(length)))
      throw CaseError(fmt::format("wall particles: {} = {:g} m must be above 0", what, length));
  const Bounds bounds = shape.bounds();
  const double size = norm(bounds.max - bounds.min);
  if (!(size / spacing < 1 << (Cells::kBits - 1)))
    throw CaseError(
        fmt::format("wall particles: spacing = {:g} m is too small for a body of {:g} m", spacing, size));

  const int layers = int(std::ceil(std::min(depth, size) / spacing - 1e-6));
  // Relaxation makes another pattern of the last digit of any number, so those must not depend on the place.
  const Vec3d middle = bounds.middle();
  const ShapePtr own = shape.in_frame(middle, spacing);
  std::vector<Particle> particles = LayerVolumes(*own, spacing, layers).place();
  if (!particles.empty()) Relaxation(*own, spacing, particles);
  std::vector<Vec3d> x;
  for (const Particle& p : particles) x.push_back(middle + p.x);
  return x;
}

std::vector<Vec3d> sample_solid(const ShapePtr& shape, double spacing, double depth,
                                const DomainConfig& domain) {
  if (!domain.two_d) return sample_shape(*shape, spacing, depth);
  return sample_shape(Slice(shape, domain.middle(), spacing), spacing, depth);
}

}  // namespace bedload
