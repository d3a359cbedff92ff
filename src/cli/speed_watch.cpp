#include "speed_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bedload {
namespace {

constexpr double kFast = 1.5, kVeryFast = 2;     // of vmax
constexpr double kMany = 0.01, kEnough = 0.001;  // fractions of the particles
constexpr std::int64_t kLongest = 1000;          // steps between checks
constexpr std::size_t kLeast = 4;                // particles; matters in small cases

double component(const HostArray& array, std::size_t i) {
  return array.type == Scalar::f64 ? array.as<double>()[i] : double(array.as<float>()[i]);
}

Vec3d vector_at(const HostArray& array, std::size_t a) {
  return {component(array, 3 * a), component(array, 3 * a + 1), component(array, 3 * a + 2)};
}

}  // namespace

/// Not with thermal noise or Lees-Edwards shear: there the speed of single particles means nothing.
SpeedWatch::SpeedWatch(const Config& c)
    : vmax_(c.fluid.vmax),
      sound_(c.fluid.c),
      factor_(c.fluid.c / c.fluid.vmax),
      active_(c.fluid.present && !c.domain.sheared() && !(c.fluid.model->thermal && c.sdpd.kT > 0)) {}

std::optional<std::string> SpeedWatch::check(Simulation& simulation, const StepInfo& info) {
  if (!active_ || info.vmax <= kFast * vmax_ || info.step < next_) return {};
  next_ = info.step + gap_;
  gap_ = std::min(2 * gap_, kLongest);  // a check costs as much as a frame

  const HostStore fluid = simulation.snapshot("fluid");
  const HostArray &x = *fluid.find("position"), &v = *fluid.find("velocity");
  std::size_t fast = 0, very_fast = 0, fastest = 0;
  double most = 0;
  for (std::size_t a = 0; a < fluid.count; ++a) {
    const double speed = norm(vector_at(v, a));
    fast += speed > kFast * vmax_, very_fast += speed > kVeryFast * vmax_;
    if (speed > most) most = speed, fastest = a;
  }
  const auto all = double(fluid.count);
  const bool many = fast >= kLeast && double(fast) >= kMany * all,
             enough = very_fast >= kLeast && double(very_fast) >= kEnough * all;
  if (!many && !enough) return {};
  active_ = false;
  const Vec3d at = vector_at(x, fastest);
  return fmt::format(
      "fluid flows at up to {:.3g} m/s at ({:.4g}, {:.4g}, {:.4g}) m, t = {:.4g} s, {:.2g} times fluid.vmax "
      "= "
      "{:.3g} m/s (Mach {:.2g}, {:.2g} % of the particles above {:g} vmax); its density varies by about "
      "{:.2g} "
      "% instead of {:.2g} %; increase fluid.vmax to {:.2g} m/s and run again",
      most, at.x, at.y, at.z, info.time, most / vmax_, vmax_, most / sound_, 100 * double(fast) / all, kFast,
      100 * most * most / (sound_ * sound_), 100 / (factor_ * factor_), most);
}

}  // namespace bedload
