#include "src/motion/wave_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bedload {
namespace {

using std::numbers::pi;

/// From 0 to 1 with continuous velocity.
std::string risen(double ramp, const std::string& formula) {
  if (ramp <= 0) return formula;
  return fmt::format("0.5*(1 - cos(pi*min(1, t/{:.15g})))*({})", ramp, formula);
}

}  // namespace

double WaterWave::number() const {
  const double w = 2 * pi / period, deep = w * w / gravity * depth;  // k d in deep water
  double kd = std::max(deep, std::sqrt(deep));
  for (int n = 0; n < 50; ++n) {  // Newton's method converges from above
    const double t = std::tanh(kd), step = (kd * t - deep) / (t + kd * (1 - t * t));
    kd -= step;
    if (std::abs(step) < 1e-15 * kd) break;
  }
  return kd / depth;
}

double WaterWave::length() const { return 2 * pi / number(); }

double WaterWave::breaking_height() const {
  return std::min(0.142 * length() * std::tanh(number() * depth), 0.78 * depth);
}

double WaterWave::second_order_height() const {
  return 8 * pi * pi / 3 * depth * depth * depth / (length() * length());
}

std::string piston_stroke(const WaterWave& wave, int order, double ramp) {
  const double kd = wave.number() * wave.depth, sinh = std::sinh(kd), cosh = std::cosh(kd);
  const double per_stroke = 2 * sinh * sinh / (sinh * cosh + kd);  // wave height over stroke
  std::string text = fmt::format("{:.15g}*sin(2*pi*t/{:.15g})", 0.5 * wave.height / per_stroke, wave.period);
  if (order == 2) {
    const double second =
        wave.height * wave.height / (32 * wave.depth) * (3 * cosh / (sinh * sinh * sinh) - 2 / per_stroke);
    text += fmt::format(" + {:.15g}*sin(4*pi*t/{:.15g})", second, wave.period);
  }
  return risen(ramp, text);
}

std::string flap_angle(const WaterWave& wave, double ramp) {
  const double kd = wave.number() * wave.depth, sinh = std::sinh(kd), cosh = std::cosh(kd);
  const double per_stroke = 4 * sinh / kd * (kd * sinh - cosh + 1) / (std::sinh(2 * kd) + 2 * kd);
  const double stroke = 0.5 * wave.height / per_stroke;  // amplitude at the still water level
  return fmt::format("180/pi*atan({})", risen(ramp, fmt::format("{:.15g}*sin(2*pi*t/{:.15g})",
                                                                stroke / wave.depth, wave.period)));
}

}  // namespace bedload
