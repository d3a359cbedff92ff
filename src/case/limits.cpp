#include "bedload/case/limits.hpp"

#include <cmath>
#include <numbers>

namespace bedload {

std::vector<StepLimit> grain_limits(const Config& c) {
  const GrainConfig& g = c.grain;
  if (!g.present || g.fixed || c.contact.normal == "none") return {};
  using std::numbers::pi;
  const double R = g.d_min / 2, G = g.E / (2 * (1 + g.nu));
  const double m = 4.0 / 3 * pi * R * R * R * g.rho / 2;  // reduced mass of equal grains
  const double E = g.E / (2 * (1 - g.nu * g.nu));
  std::vector<StepLimit> limits{
      {"rayleigh", c.time.rayleigh * pi * R * std::sqrt(g.rho / G) / (0.1631 * g.nu + 0.8766)}};
  const double v = std::sqrt(2 * (norm(c.gravity) + c.frame.acceleration) * R);
  if (c.contact.normal == "linear")
    limits.push_back({"contact", c.time.contact * pi * std::sqrt(m / c.contact.k)});
  else if (v > 0)
    limits.push_back({"contact", c.time.contact * 2.8683 * std::pow(m * m / (R / 2 * E * E * v), 0.2)});
  StepLimit* least = &limits.front();
  for (StepLimit& limit : limits)
    if (limit.seconds < least->seconds) least = &limit;
  least->binds = true;
  return limits;
}

}  // namespace bedload
