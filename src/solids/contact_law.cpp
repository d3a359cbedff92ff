#include "kernels/contact/contact_law.hpp"

#include <cmath>
#include <type_traits>

namespace bedload::inline BL_VARIANT {
namespace {

ContactLaw law_between(const ContactMaterials& m) {
  ContactLaw all;
  all.normal = m.contact.normal, all.sliding = m.contact.tangential, all.rolling = m.contact.rolling;
  if (m.mu_r == 0) all.rolling = RollingLaw::none;
  all.clip_tension = m.contact.clip_tension;
  all.mu = Real(m.mu);
  all.sliding_damping = Real(m.contact.tangential_damping);
  const auto set = [&](auto& law) { law = std::decay_t<decltype(law)>::of(m); };
  ContactLaw::normal_of(all, set);
  ContactLaw::sliding_of(all, set);
  ContactLaw::rolling_of(all, set);
  return all;
}

}  // namespace

ContactLaw make_contact_law(const Config& config) {
  const GrainConfig& g = config.grain;
  const ElasticCompliance grain(g.E, g.nu);
  return law_between({2 * grain.normal, 2 * grain.tangential, g.mu, g.mu_r, g.e, config.contact});
}

ContactLaw make_wall_law(const Config& config, const WallBody& body) {
  const GrainConfig& g = config.grain;
  const ElasticCompliance grain(g.E, g.nu), wall = wall_compliance(config, body);
  return law_between({grain.normal + wall.normal, grain.tangential + wall.tangential,
                      std::isfinite(body.mu) ? body.mu : g.mu, std::isfinite(body.mu_r) ? body.mu_r : g.mu_r,
                      body.e > 0 ? body.e : g.e, config.contact});
}

}  // namespace bedload::inline BL_VARIANT
