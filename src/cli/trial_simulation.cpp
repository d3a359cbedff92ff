#include "trial_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "bedload/output/output.hpp"
#include "settle.hpp"

namespace bedload {
namespace {

/// Approximates a settled bed, for its memory: columns along gravity are shortened towards their lowest
/// grain, all by the factor that gives the solid fraction of a settled bed. Grains then overlap, but have
/// about as many neighbours and as much fluid around them.
void compact(const Config& config, Setup::Grains& grains) {
  constexpr double settled = 0.6;  // solid fraction of a settled bed
  constexpr double column = 4;     // least width of a column, in diameters
  struct Column {
    double lowest = INFINITY, highest = -INFINITY, volume = 0;
  };
  const double g = norm(config.gravity);
  if (g == 0 || grains.x.empty()) return;
  const Vec3d up = config.gravity * (-1 / g);
  Vec3d side{1, 0, 0};
  if (std::abs(up.x) > 0.6) side = {0, 1, 0};
  side -= up * dot(side, up);
  side = side * (1 / norm(side));
  const Vec3d across[2] = {side, cross(up, side)};

  int n[2];
  double from[2], width[2];
  for (int k = 0; k < 2; ++k) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = 0; i < grains.x.size(); ++i) {
      low = std::min(low, dot(grains.x[i], across[k]) - grains.radius[i]);
      high = std::max(high, dot(grains.x[i], across[k]) + grains.radius[i]);
    }
    n[k] = std::clamp(int((high - low) / (column * config.grain.d_max)), 1, 1 << 12);
    from[k] = low, width[k] = (high - low) / n[k];
  }
  std::vector<Column> columns(std::size_t(n[0]) * n[1]);
  const auto column_of = [&](const Vec3d& x) -> Column& {
    int at[2];
    for (int k = 0; k < 2; ++k)
      at[k] = std::clamp(int((dot(x, across[k]) - from[k]) / width[k]), 0, n[k] - 1);
    return columns[std::size_t(at[0]) * n[1] + at[1]];
  };
  for (std::size_t i = 0; i < grains.x.size(); ++i) {
    Column& c = column_of(grains.x[i]);
    const double height = dot(grains.x[i], up), d = 2 * grains.radius[i];
    c.lowest = std::min(c.lowest, height), c.highest = std::max(c.highest, height);
    c.volume += M_PI / 6 * d * d * d;
  }
  std::vector<double> fractions;  // solid fraction of each column with grains
  for (const Column& c : columns)
    if (c.volume > 0)
      fractions.push_back(c.volume / (width[0] * width[1] * (c.highest - c.lowest + config.grain.d_max)));
  const auto median = fractions.begin() + fractions.size() / 2;
  std::nth_element(fractions.begin(), median, fractions.end());  // columns at the sides may be cut
  const double factor = std::min(1.0, *median / settled);
  for (std::size_t i = 0; i < grains.x.size(); ++i) {
    Vec3d& x = grains.x[i];
    const Vec3d fall = up * ((1 - factor) * (dot(x, up) - column_of(x).lowest));
    x -= fall;
    const std::uint32_t clump = i < grains.clump.size() ? grains.clump[i] : 0;
    if (clump > 0 && (i == 0 || grains.clump[i - 1] != clump)) grains.clumps[clump - 1].x -= fall;
  }
}

/// Starts the case, with a settled bed if there is one.
std::unique_ptr<Simulation> start(const Prepared& p, const SavedState* bed) {
  auto simulation = make_simulation(p.config, p.setup, p.device);
  if (bed) simulation->load_grains(*bed);
  simulation->start();
  return simulation;
}

}  // namespace

TrialSimulation::TrialSimulation(const Prepared& p) : config_(p.config) {
  if (!config_.grain.present || !config_.grain.settle) {
    simulation_ = start(p, nullptr);
  } else if (const auto bed = cached_bed(config_, p.setup, p.device)) {
    simulation_ = start(p, &*bed);
  } else {
    Setup::Grains settled_grains = p.setup.grains;
    compact(config_, settled_grains);
    // the second simulation reuses the shared scratch of the first, so the difference is that of the lists
    const SavedState settled = bed_of(config_, settled_grains, p.device),
                     placed = bed_of(config_, p.setup.grains, p.device);
    settling_bytes_ = std::ptrdiff_t(start(p, &settled)->bytes());
    simulation_ = start(p, &placed);
    settling_bytes_ -= std::ptrdiff_t(simulation_->bytes());
  }
}

MemoryNeed TrialSimulation::memory() {
  simulation_->diagnostics();
  check_fields(*simulation_, config_);
  for (const ProbeConfig& probe : config_.out.probes) simulation_->measure(probe);
  const std::size_t fast_flow = simulation_->growth();
  return {.all = std::size_t(std::ptrdiff_t(simulation_->bytes() + fast_flow) + settling_bytes_),
          .fast_flow_bytes = fast_flow};
}

}  // namespace bedload
