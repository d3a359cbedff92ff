#include "bedload/case/limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bedload/case/config.hpp"
#include "bedload/case/contact_laws.hpp"
#include "bedload/case/materials.hpp"
#include "resolve.hpp"

namespace bedload {

using std::numbers::pi;
constexpr double kNone = std::numeric_limits<double>::infinity();

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
  const auto all = g.all_materials();
  std::vector<bool> used(all.size(), false);
  for (std::size_t k = 0; k < g.fills.size(); ++k) used[g.material_of(k)] = true;
  for (const GrainInletConfig& inlet : c.grain_inlets) used[inlet.number] = true;
  if (g.fills.empty() && c.grain_inlets.empty()) used[0] = true;
  std::vector<SmallestGrain> grains;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (used[k]) grains.emplace_back(all[k], g.smallest() / 2);
  return grains;
}

/// In series: of two masses, the mass that swings between them.
double reduced(double a, double b) { return a * b / (a + b); }

}  // namespace

SubstepLimits::SubstepLimits(const Config& c)
    : contact_(c.contact),
      fraction_(c.time.contact),
      least_speed_(std::sqrt((norm(c.gravity) + c.frame.acceleration) * c.grain.largest())),
      rayleigh_(kNone),
      film_(kNone) {
  const GrainConfig& g = c.grain;
  const double R = g.smallest() / 2;
  const std::vector<SmallestGrain> grains = smallest_grains(c);
  for (const SmallestGrain& a : grains) {
    const GrainMaterial& m = a.material;
    const double G = m.E / (2 * (1 + m.nu));
    rayleigh_ =
        std::min(rayleigh_, c.time.rayleigh * pi * R * std::sqrt(m.rho / G) / (0.1631 * m.nu + 0.8766));
    if (c.lubrication.acts())
      film_ = std::min(film_, 0.2 * (a.mass / 2) * c.lubrication.least_gap / (6 * pi * c.fluid.mu * R / 2));
    for (const SmallestGrain& b : grains) {
      const SurfacePair both = surfaces(m, b.material, c.contact);
      pairs_.push_back({.mass = reduced(a.mass, b.mass),
                        .R = R / 2,
                        .E_star = 1 / (a.compliance.normal + b.compliance.normal),
                        .e = both.e,
                        .mu_r = both.mu_r,
                        .inertia = reduced(a.inertia, b.inertia)});
    }
    for (const WallBody& body : c.wall.bodies) {
      const bool as_grains = body.E == 0 && !std::isfinite(body.nu) && body.material.empty();
      if (as_grains || !takes_moduli(c.contact.normal)) continue;
      pairs_.push_back({.mass = a.mass,
                        .R = R,
                        .E_star = 1 / (a.compliance.normal + wall_compliance(body, g).normal),
                        .e = 1,
                        .mu_r = surfaces(m, body, g, c.contact).mu_r,
                        .inertia = a.inertia});
    }
  }
}

std::vector<StepLimit> SubstepLimits::at(double speed) const {
  double contact = kNone, rolling = kNone;
  for (const Pair& pair : pairs_) {
    const Impact hit =
        impact(contact_, pair.mass, pair.R, pair.E_star, std::max(speed, least_speed_), pair.e);
    contact = std::min(contact, hit.duration);
    rolling = std::min(rolling, rolling_limit(contact_, hit.stiffness, pair.mu_r, pair.R, pair.inertia));
  }
  std::vector<StepLimit> limits{{Limit::rayleigh, rayleigh_}};
  if (std::isfinite(contact)) limits.push_back({Limit::contact, fraction_ * contact});
  if (std::isfinite(rolling)) limits.push_back({Limit::rolling, rolling});
  if (std::isfinite(film_)) limits.push_back({Limit::lubrication, film_});
  return limits;
}

std::vector<StepLimit> grain_limits(const Config& c) {
  if (!c.grain.present || c.grain.fixed || c.contact.normal == NormalLaw::none) return {};
  return with_binding(SubstepLimits(c).at(0));
}

double bed_overlap(const Config& c) {
  const GrainConfig& g = c.grain;
  const double R = g.d_max / 2, layers = std::max(1.0, height(g.fills, c.gravity) / g.d_max);
  const double weight = 4.18879 * R * R * R * g.rho * norm(c.gravity) * layers;
  return overlap_under(c.contact, weight, R / 2, 0.5 / ElasticCompliance(g.E, g.nu).normal) / R;
}

}  // namespace bedload
