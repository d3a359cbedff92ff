#include "random_spheres.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "bedload/core/error.hpp"
#include "bedload/core/random.hpp"

namespace bedload {
namespace {

constexpr double kApart = 1 + 1e-4;  // least distance of centres
constexpr int kPushes = 20000;       // of all pairs, at most
constexpr int kSweeps = 300;         // random steps of each sphere
constexpr double kReach = 0.3;       // of a random step, in gaps of a lattice of as many spheres

class Spheres {
 public:
  Spheres(int count, double side, int seed)
      : side_(side), random_(std::uint64_t(seed), 0), x_(std::size_t(count)) {
    for (Vec3d& x : x_) x = somewhere(side_);
  }

  /// Moves the spheres of each pair that overlaps; whether there is none.
  bool push_apart() {
    bool apart = true;
    for (std::size_t i = 0; i < x_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Vec3d d = nearest(x_[i] - x_[j]);
        const double r = norm(d);
        if (r >= kApart) continue;
        apart = false;
        const Vec3d way = (0.5 * (kApart - r) + 1e-6) / r * d;
        x_[i] += way, x_[j] -= way;
      }
    return apart;
  }
  void sweep() {
    const double reach = kReach * (side_ / std::cbrt(double(x_.size()) / std::numbers::sqrt2) - 1) + 0.01;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const Vec3d to = x_[i] + somewhere(2 * reach) - Vec3d{reach, reach, reach};
      if (free(i, to)) x_[i] = to;
    }
  }
  /// Within the cube.
  std::vector<Vec3d> places() const {
    std::vector<Vec3d> out = x_;
    for (Vec3d& x : out)
      for (int k = 0; k < 3; ++k) x[k] -= side_ * std::floor(x[k] / side_);
    return out;
  }

 private:
  Vec3d somewhere(double range) {
    const double x = random_.uniform(), y = random_.uniform(), z = random_.uniform();
    return range * Vec3d{x, y, z};
  }
  Vec3d nearest(Vec3d d) const {
    for (int k = 0; k < 3; ++k) d[k] -= side_ * std::rint(d[k] / side_);
    return d;
  }
  bool free(std::size_t i, const Vec3d& to) const {
    for (std::size_t j = 0; j < x_.size(); ++j)
      if (j != i && norm2(nearest(to - x_[j])) < kApart * kApart) return false;
    return true;
  }

  double side_;
  CounterRandom random_;
  std::vector<Vec3d> x_;
};

}  // namespace

std::vector<Vec3d> random_spheres(int count, double side, int seed) {
  Spheres spheres(count, side, seed);
  for (int k = 0; !spheres.push_apart(); ++k)
    if (k == kPushes)
      throw CaseError(
          fmt::format("--fractions: found no random places for {} grains at a solid fraction of {:.3g}",
                      count, count * std::numbers::pi / 6 / (side * side * side)));
  for (int k = 0; k < kSweeps; ++k) spheres.sweep();
  return spheres.places();
}

}  // namespace bedload
