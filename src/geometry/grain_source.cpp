#include "bedload/geometry/grain_source.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bedload/case/config.hpp"
#include "bedload/case/grain_sizes.hpp"
#include "bedload/core/random.hpp"
#include "bedload/geometry/clump.hpp"

namespace bedload {
namespace {

constexpr int kPlaces = 16;               // a round
constexpr std::size_t kQuantiles = 4096;  // of a distribution
constexpr std::uint64_t kPlaceStream = std::uint64_t(1) << 62, kTurnStream = std::uint64_t(1) << 61;

}  // namespace

GrainSource::GrainSource(const Config& config, std::size_t index)
    : inlet_(config.grain_inlets[index]),
      material_(inlet_.number),
      rho_(config.grain.density(inlet_.clump, inlet_.material)),
      seed_(config.grain.seed),
      stream_((std::uint64_t(index) + 1) << 40) {
  if (const ClumpConfig* clump = config.grain.clump_named(inlet_.clump)) shape_ = clump->shape;
  for (const SizeClass& size : inlet_.sizes)
    sizes_.push_back(quantiles(size, size.kind == SizeKind::one_size ? 1 : kQuantiles));
  radius_ = next_radius();
}

double GrainSource::mass_of(double radius) const {
  return 4.0 / 3 * std::numbers::pi * radius * radius * radius * rho_;
}

double GrainSource::next_radius() const {
  CounterRandom random(seed_, stream_ + std::uint64_t(state.count));
  double total = 0;
  for (const SizeClass& size : inlet_.sizes) total += size.number_fraction;
  double at = random.uniform() * total;
  std::size_t k = 0;
  while (k + 1 < sizes_.size() && at >= inlet_.sizes[k].number_fraction)
    at -= inlet_.sizes[k++].number_fraction;
  return 0.5 * sizes_[k][random.below(sizes_[k].size())];
}

Quat<double> GrainSource::rotation() const {
  return clump_rotation(inlet_.orientation,
                        CounterRandom(seed_, kTurnStream + stream_ + std::uint64_t(state.count)));
}

std::vector<std::pair<Vec3d, double>> GrainSource::spheres() const {
  if (!shape_) return {{{}, radius_}};
  return turned_spheres(*shape_, 2 * radius_, rotation());
}

double GrainSource::pending(double t) const {
  const double elapsed = (std::min(t, inlet_.stop) - inlet_.start) * (1 + 1e-12);
  if (elapsed <= 0) return 0;
  if (inlet_.rate > 0) return std::max(0.0, std::floor(inlet_.rate * elapsed) - state.count);
  return std::max(0.0, std::floor((inlet_.mass_rate * elapsed - state.mass) / mass_of(radius_)));
}

std::vector<Vec3d> GrainSource::places() {
  CounterRandom random(seed_, kPlaceStream + stream_ + std::uint64_t(state.rounds));
  ++state.rounds;
  Vec3d a, b;  // in the plane of the disc
  if (inlet_.shape == GrainInletShape::disc) {
    const Vec3d& n = inlet_.direction;
    a = std::abs(n.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    a -= dot(a, n) * n;
    a = a / norm(a);
    b = cross(n, a);
  }
  const double reach = this->reach();
  std::vector<Vec3d> all;
  for (int k = 0; k < kPlaces; ++k) {
    const double u = random.uniform(), v = random.uniform(), w = random.uniform();
    if (inlet_.shape == GrainInletShape::disc) {
      const double r = (inlet_.radius - reach) * std::sqrt(u), angle = 2 * std::numbers::pi * v;
      all.push_back(inlet_.centre + r * std::cos(angle) * a + r * std::sin(angle) * b);
    } else {
      const Vec3d margin{reach, reach, reach}, lo = inlet_.min + margin, space = inlet_.max - margin - lo;
      all.push_back(lo + Vec3d{u * space.x, v * space.y, w * space.z});
    }
  }
  return all;
}

void GrainSource::dropped() {
  ++state.count;
  state.mass += mass_of(radius_);
  radius_ = next_radius();
}

}  // namespace bedload
