#include "bedload/case/limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bedload/case/materials.hpp"
#include "bedload/case/normal_laws.hpp"

namespace bedload {

using std::numbers::pi;

double rolling_limit(double stiffness, double mu_r, double R_star, double inertia) {
  const double k_r = 2.25 * stiffness * mu_r * mu_r * R_star * R_star;
  return k_r > 0 ? 0.2 * std::sqrt(inertia / k_r) : std::numeric_limits<double>::infinity();
}

std::vector<StepLimit> substep_limits(const Config& c, double speed) {
  const GrainConfig& g = c.grain;
  const double R = g.d_min / 2, G = g.E / (2 * (1 + g.nu));
  const double mass = 4.0 / 3 * pi * R * R * R * g.rho, m = mass / 2;  // m: of a pair
  std::vector<StepLimit> limits{
      {"rayleigh", c.time.rayleigh * pi * R * std::sqrt(g.rho / G) / (0.1631 * g.nu + 0.8766)}};
  const double v = std::max(speed, std::sqrt((norm(c.gravity) + c.frame.acceleration) * g.d_max));
  const double grain = ElasticCompliance(g.E, g.nu).normal;
  const auto [duration, stiffness] = impact(c.contact, m, R / 2, 0.5 / grain, v, g.e);
  double contact = duration;
  double rolling = std::numeric_limits<double>::infinity();
  const auto rolls = [&](double stiffness, double mu_r, double R_star, double inertia) {
    if (c.contact.rolling == RollingLaw::epsd)
      rolling = std::min(rolling, rolling_limit(stiffness, mu_r, R_star, inertia));
  };
  const double inertia = 1.4 * mass * R * R;
  double mu_r = g.mu_r;
  for (const WallBody& body : c.wall.bodies) {
    if (std::isfinite(body.mu_r)) mu_r = std::max(mu_r, body.mu_r);
    if ((body.E == 0 && !std::isfinite(body.nu)) || !takes_moduli(c.contact.normal)) continue;
    const Impact hit = impact(c.contact, mass, R, 1 / (grain + wall_compliance(c, body).normal), v);
    contact = std::min(contact, hit.duration);
    rolls(hit.stiffness, std::isfinite(body.mu_r) ? body.mu_r : g.mu_r, R, inertia);
  }
  rolls(stiffness, mu_r, R / 2, 0.5 * inertia);
  if (std::isfinite(contact)) limits.push_back({"contact", c.time.contact * contact});
  if (std::isfinite(rolling)) limits.push_back({"rolling", rolling});
  return limits;
}

std::vector<StepLimit> grain_limits(const Config& c) {
  if (!c.grain.present || c.grain.fixed || c.contact.normal == NormalLaw::none) return {};
  std::vector<StepLimit> limits = substep_limits(c, 0);
  const auto shorter = [](const StepLimit& a, const StepLimit& b) { return a.seconds < b.seconds; };
  std::min_element(limits.begin(), limits.end(), shorter)->binds = true;
  return limits;
}

}  // namespace bedload
