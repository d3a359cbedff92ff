// Fluid whose particles are given one by one.

#include <fmt/format.h>

#include <cmath>
#include <unordered_map>

#include "bedload/case/particle_file.hpp"
#include "bedload/core/error.hpp"
#include "bedload/geometry/depth.hpp"
#include "bedload/geometry/lattice.hpp"
#include "bedload/geometry/sampling.hpp"
#include "geometry/fill_region.hpp"
#include "geometry/fill_velocity.hpp"

namespace bedload {
namespace {

constexpr double kTwins = 0.1;   // spacings; particles closer than that were given twice
constexpr double kInWall = 0.1;  // spacings that moving fluid may have come into a wall

/// Finds whether a particle lies on another.
class Places {
 public:
  explicit Places(double reach) : reach_(reach) {}

  void add(const Vec3d& x) { cells_[key(x)].push_back(x); }

  bool taken(const Vec3d& x) const {
    for (int corner = 0; corner < 8; ++corner) {  // cells are twice as wide as the reach
      const double h = reach_;
      const Vec3d at = x + Vec3d{corner & 1 ? h : -h, corner & 2 ? h : -h, corner & 4 ? h : -h};
      const auto found = cells_.find(key(at));
      if (found == cells_.end()) continue;
      for (const Vec3d& y : found->second)
        if (norm2(x - y) < reach_ * reach_) return true;
    }
    return false;
  }

 private:
  std::uint64_t key(const Vec3d& x) const {
    std::uint64_t sum = 0;  // of 21 bits an axis; those that wrap share a cell
    for (int k = 0; k < 3; ++k)
      sum = sum << 21 | (std::uint64_t(std::int64_t(std::floor(x[k] / (2 * reach_)))) & ((1u << 21) - 1));
    return sum;
  }

  double reach_;
  std::unordered_map<std::uint64_t, std::vector<Vec3d>> cells_;
};

class ListedFluid {
 public:
  ListedFluid(const Config& config, Setup::Fluid& fluid, std::vector<std::string>& warnings)
      : config_(config), fluid_(fluid), warnings_(warnings), places_(kTwins * config.fluid.dx) {
    for (const Vec3d& x : fluid.x) places_.add(x);
  }

  void add_fill(std::size_t index) {
    const FluidFill& fill = config_.fluid.fills[index];
    ParticleList list = read_particles(fill.file, fill.step, "fluid");
    const FillVelocity velocity(fill, index);
    const double dx = config_.fluid.dx;
    double fastest = 0;
    for (std::size_t n = 0; n < list.x.size(); ++n) {
      check(list, n, index);
      fluid_.x.push_back(list.x[n]);
      fluid_.v.push_back(list.v.empty() ? velocity(list.x[n]) : list.v[n]);
      const double volume = list.volume.empty() ? config_.domain.cell_volume(dx) : list.volume[n];
      fluid_.mass.push_back(config_.fluid.rho0 * volume);
      fluid_.fill.push_back(std::uint32_t(index));
      places_.add(list.x[n]);
      fastest = std::max(fastest, norm(fluid_.v.back()));
    }
    if (fastest > config_.fluid.vmax * (1 + 1e-9))
      warnings_.push_back(fmt::format(
          "fluid.fill {}: its particles move at up to {:.3g} m/s, above fluid.vmax = {:.3g}, from "
          "which the sound speed follows",
          index + 1, fastest, config_.fluid.vmax));
  }

 private:
  void check(ParticleList& list, std::size_t n, std::size_t index) const {
    Vec3d& x = list.x[n];
    const double dx = config_.fluid.dx;
    const auto fail = [&](const std::string& why) {
      throw CaseError(fmt::format("{}: fluid particle {} at ({:g}, {:g}, {:g}) m {}", list.place(n), n + 1,
                                  x.x, x.y, x.z, why));
    };
    if (!lies_inside(config_.domain, x)) fail("lies outside the domain");
    for (const WallBody& body : config_.wall.bodies) {
      const double reach = config_.fluid.reach();
      if (body.stops_fluid() && wall_distance(body, x, reach, config_.domain) < -kInWall * dx)
        fail(fmt::format("lies inside wall.body \"{}\"", body.name));
    }
    for (std::size_t other = 0; other < config_.fluid.fills.size(); ++other)
      if (other != index && depth_in(config_.fluid.fills[other], upwards(config_.gravity), x) > 1e-6 * dx)
        fail(fmt::format("lies inside fluid.fill {}", other + 1));
    if (places_.taken(x)) fail("lies on another fluid particle");
  }

  const Config& config_;
  Setup::Fluid& fluid_;
  std::vector<std::string>& warnings_;
  Places places_;
};

}  // namespace

void add_listed_fluid(const Config& config, Setup::Fluid& fluid, std::vector<std::string>& warnings) {
  bool listed = false;
  for (const FluidFill& fill : config.fluid.fills) listed = listed || !fill.file.empty();
  if (!listed) return;
  ListedFluid all(config, fluid, warnings);
  for (std::size_t index = 0; index < config.fluid.fills.size(); ++index)
    if (!config.fluid.fills[index].file.empty()) all.add_fill(index);
}

}  // namespace bedload
