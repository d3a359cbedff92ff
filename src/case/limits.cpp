#include "bedload/case/limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bedload/case/materials.hpp"
#include "bedload/case/normal_laws.hpp"

namespace bedload {

using std::numbers::pi;
constexpr double kNone = std::numeric_limits<double>::infinity();

double rolling_limit(double stiffness, double mu_r, double R_star, double inertia) {
  const double k_r = 2.25 * stiffness * mu_r * mu_r * R_star * R_star;
  return k_r > 0 ? 0.2 * std::sqrt(inertia / k_r) : std::numeric_limits<double>::infinity();
}

namespace {

/// The smallest grain of one material.
struct SmallestGrain {
  const GrainMaterial material;
  double mass, inertia;  // kg; about a contact, kg m2
  ElasticCompliance compliance;

  SmallestGrain(const GrainMaterial& m, double R)
      : material(m),
        mass(4.0 / 3 * pi * R * R * R * m.rho),
        inertia(1.4 * mass * R * R),
        compliance(m.E, m.nu) {}
};

/// Of the materials that grains of the case are made of.
std::vector<SmallestGrain> smallest_grains(const Config& c) {
  const GrainConfig& g = c.grain;
  std::vector<std::string> inlet_materials;
  for (const GrainInletConfig& inlet : c.grain_inlets) inlet_materials.push_back(inlet.material);
  const auto all = g.all_materials();
  std::vector<bool> used(all.size(), false);
  for (const GrainFill& fill : g.fills) used[g.material(fill.material)] = true;
  for (const std::string& name : inlet_materials) used[g.material(name)] = true;
  if (g.fills.empty() && inlet_materials.empty()) used[0] = true;
  std::vector<SmallestGrain> grains;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (used[k]) grains.emplace_back(all[k], g.d_min / 2);
  return grains;
}

/// In series: of two masses, the mass that swings between them.
double reduced(double a, double b) { return a * b / (a + b); }

}  // namespace

std::vector<StepLimit> substep_limits(const Config& c, double speed) {
  const GrainConfig& g = c.grain;
  const double R = g.d_min / 2,
               v = std::max(speed, std::sqrt((norm(c.gravity) + c.frame.acceleration) * g.d_max));
  double rayleigh = kNone, contact = kNone, rolling = kNone, film = kNone;
  const auto rolls = [&](double stiffness, double mu_r, double R_star, double inertia) {
    if (c.contact.rolling == RollingLaw::epsd)
      rolling = std::min(rolling, rolling_limit(stiffness, mu_r, R_star, inertia));
  };
  const std::vector<SmallestGrain> grains = smallest_grains(c);
  for (const SmallestGrain& a : grains) {
    const GrainMaterial& m = a.material;
    const double G = m.E / (2 * (1 + m.nu));
    rayleigh = std::min(rayleigh, c.time.rayleigh * pi * R * std::sqrt(m.rho / G) / (0.1631 * m.nu + 0.8766));
    if (c.lubrication.acts())
      film = std::min(film, 0.2 * (a.mass / 2) * c.lubrication.least_gap / (6 * pi * c.fluid.mu * R / 2));
    for (const SmallestGrain& b : grains) {
      const double E_star = 1 / (a.compliance.normal + b.compliance.normal);
      const Impact hit = impact(c.contact, reduced(a.mass, b.mass), R / 2, E_star, v, g.e);
      contact = std::min(contact, hit.duration);
      rolls(hit.stiffness, g.mu_r, R / 2, reduced(a.inertia, b.inertia));
    }
    for (const WallBody& body : c.wall.bodies) {
      if ((body.E == 0 && !std::isfinite(body.nu)) || !takes_moduli(c.contact.normal)) continue;
      const double E_star = 1 / (a.compliance.normal + wall_compliance(c, body).normal);
      const Impact hit = impact(c.contact, a.mass, R, E_star, v);
      contact = std::min(contact, hit.duration);
      rolls(hit.stiffness, std::isfinite(body.mu_r) ? body.mu_r : g.mu_r, R, a.inertia);
    }
  }
  std::vector<StepLimit> limits{{"rayleigh", rayleigh}};
  if (std::isfinite(contact)) limits.push_back({"contact", c.time.contact * contact});
  if (std::isfinite(rolling)) limits.push_back({"rolling", rolling});
  if (std::isfinite(film)) limits.push_back({"lubrication", film});
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
