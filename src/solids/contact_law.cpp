#include "kernels/contact/registry.hpp"

#include <cmath>

namespace bedload::inline BL_VARIANT {
namespace {

ContactLaw law_between(const ContactMaterials& m) {
  const ContactConfig& c = m.contact;
  return {.normal = NormalLaws::of(NormalLaw(c.normal), m),
          .sliding = SlidingLaws::of(SlidingLaw(c.tangential), m),
          .rolling = RollingLaws::of(m.mu_r == 0 ? RollingLaw::none : RollingLaw(c.rolling), m),
          .clip_tension = c.clip_tension,
          .mu = Real(m.mu),
          .sliding_damping = Real(c.tangential_damping)};
}

}  // namespace

ContactLaw make_contact_law(const Config& config) {
  const GrainMaterial all = config.grain.all_materials()[0];
  return make_contact_law(config, all, all);
}

ContactLaw make_contact_law(const Config& config, const GrainMaterial& a, const GrainMaterial& b) {
  const ElasticCompliance i(a.E, a.nu), j(b.E, b.nu);
  return law_between({.normal = i.normal + j.normal,
                      .tangential = i.tangential + j.tangential,
                      .nu = 0.5 * (a.nu + b.nu),
                      .mu = 0.5 * (a.mu + b.mu),
                      .mu_r = config.grain.mu_r,
                      .e = config.grain.e,
                      .contact = config.contact});
}

ContactLaw make_wall_law(const Config& config, const GrainMaterial& material, const WallBody& body) {
  const GrainConfig& g = config.grain;
  const ElasticCompliance grain(material.E, material.nu), wall = wall_compliance(config, body);
  return law_between({.normal = grain.normal + wall.normal,
                      .tangential = grain.tangential + wall.tangential,
                      .nu = 0.5 * (material.nu + (std::isfinite(body.nu) ? body.nu : g.nu)),
                      .mu = std::isfinite(body.mu) ? body.mu : material.mu,
                      .mu_r = std::isfinite(body.mu_r) ? body.mu_r : g.mu_r,
                      .e = body.e > 0 ? body.e : g.e,
                      .contact = config.contact});
}

}  // namespace bedload::inline BL_VARIANT
