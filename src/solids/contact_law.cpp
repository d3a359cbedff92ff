#include "kernels/contact/contact_law.hpp"

#include <cmath>

#include "bedload/case/materials.hpp"
#include "bedload/core/error.hpp"

namespace bedload::inline BL_VARIANT {

ContactLaw make_contact_law(const Config& config) {
  const GrainConfig& g = config.grain;
  const ContactConfig& c = config.contact;
  ContactLaw law;
  law.normal = c.normal == "none"     ? NormalLaw::none
               : c.normal == "linear" ? NormalLaw::linear
                                      : NormalLaw::hertz;
  law.sliding = c.tangential == "none"                  ? SlidingLaw::none
                : c.tangential == "linear"              ? SlidingLaw::linear
                : c.tangential == "mindlin_deresiewicz" ? SlidingLaw::mindlin_deresiewicz
                                                        : SlidingLaw::mindlin;
  law.rolling = c.rolling == "none"  ? RollingLaw::none
                : c.rolling == "cdt" ? RollingLaw::cdt
                                     : RollingLaw::epsd;
  law.clip_tension = c.clip_tension;
  law.mu = Real(g.mu);

  const ElasticCompliance compliance(g.E, g.nu);
  law.hertz.E_star = Real(1 / (2 * compliance.normal));
  law.mindlin.G_star = Real(1 / (2 * compliance.tangential));
  law.sliding_damping = Real(c.tangential_damping);
  const double ratio = damping_ratio(g.e);
  law.hertz.alpha = Real(c.he_damping ? std::sqrt(6.0) * ratio : hertz_damping(g.e, c.clip_tension));
  law.spring.k = Real(c.k);
  if (law.normal == NormalLaw::linear) {
    if (!(c.k > 0))
      throw KeyError("contact.k",
                     "contact.k = " + std::to_string(c.k) + ": must be > 0 N/m for a linear spring");
    if (c.clip_tension && g.e < std::exp(-2.0))
      throw KeyError("grain.e", "grain.e = " + std::to_string(g.e) +
                                    ": must be at least 0.136 for a linear spring that never pulls; "
                                    "set contact.clip_tension = false");
    law.spring.beta = Real(c.clip_tension ? damping_ratio_clipped(g.e) : ratio);
  }
  law.linear_sliding.ratio = Real(c.kt_ratio);
  law.deresiewicz = {Real(g.mu), Real(g.mu * compliance.tangential / (4 * compliance.normal)), Real(ratio)};
  law.epsd = {Real(g.mu_r), Real(c.eta_r)};
  law.cdt = {Real(g.mu_r), c.cap_rolling};
  return law;
}

ContactLaw make_wall_law(const Config& config, const WallBody& body) {
  Config on_wall = config;
  if (std::isfinite(body.mu)) on_wall.grain.mu = body.mu;
  if (std::isfinite(body.mu_r)) on_wall.grain.mu_r = body.mu_r;
  if (body.e > 0) on_wall.grain.e = body.e;
  ContactLaw law = make_contact_law(on_wall);
  const ElasticCompliance grain(config.grain.E, config.grain.nu), wall = wall_compliance(config, body);
  law.hertz.E_star = Real(1 / (grain.normal + wall.normal));
  law.mindlin.G_star = Real(1 / (grain.tangential + wall.tangential));
  law.deresiewicz.slip =
      Real(on_wall.grain.mu * (grain.tangential + wall.tangential) / (4 * (grain.normal + wall.normal)));
  return law;
}

}  // namespace bedload::inline BL_VARIANT
