#include "bedload/case/limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bedload/case/materials.hpp"

namespace bedload {

using std::numbers::pi;

HertzImpact hertz_impact(double m, double R, double E, double v) {
  const double overlap = std::pow(15 * m * v * v / (16 * E * std::sqrt(R)), 0.4);
  return {2.8683 * std::pow(m * m / (R * E * E * v), 0.2), 2 * E * std::sqrt(R * overlap)};
}

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
  double contact = std::numeric_limits<double>::infinity(), stiffness = 0;
  if (c.contact.normal == "linear") {
    const double damping = std::log(g.e) / std::hypot(pi, std::log(g.e));
    contact = pi * std::sqrt(m / c.contact.k) / std::sqrt(1 - damping * damping);
    stiffness = c.contact.k;
  } else if (c.contact.normal == "hertz" && v > 0) {
    const HertzImpact impact = hertz_impact(m, R / 2, 0.5 / ElasticCompliance(g.E, g.nu).normal, v);
    contact = impact.duration, stiffness = impact.stiffness;
  }
  double rolling = std::numeric_limits<double>::infinity();
  const auto rolls = [&](double stiffness, double mu_r, double R_star, double inertia) {
    if (c.contact.rolling == "epsd")
      rolling = std::min(rolling, rolling_limit(stiffness, mu_r, R_star, inertia));
  };
  const double inertia = 1.4 * mass * R * R;
  double mu_r = g.mu_r;
  for (const WallBody& body : c.wall.bodies) {
    if (std::isfinite(body.mu_r)) mu_r = std::max(mu_r, body.mu_r);
    if ((body.E == 0 && !std::isfinite(body.nu)) || c.contact.normal != "hertz" || v == 0) continue;
    const double E_star = 1 / (ElasticCompliance(g.E, g.nu).normal + wall_compliance(c, body).normal);
    const HertzImpact impact = hertz_impact(mass, R, E_star, v);
    contact = std::min(contact, impact.duration);
    rolls(impact.stiffness, std::isfinite(body.mu_r) ? body.mu_r : g.mu_r, R, inertia);
  }
  rolls(stiffness, mu_r, R / 2, 0.5 * inertia);
  if (std::isfinite(contact)) limits.push_back({"contact", c.time.contact * contact});
  if (std::isfinite(rolling)) limits.push_back({"rolling", rolling});
  return limits;
}

std::vector<StepLimit> grain_limits(const Config& c) {
  if (!c.grain.present || c.grain.fixed || c.contact.normal == "none") return {};
  std::vector<StepLimit> limits = substep_limits(c, 0);
  const auto shorter = [](const StepLimit& a, const StepLimit& b) { return a.seconds < b.seconds; };
  std::min_element(limits.begin(), limits.end(), shorter)->binds = true;
  return limits;
}

}  // namespace bedload
