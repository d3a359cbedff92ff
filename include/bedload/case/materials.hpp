#pragma once
// What materials have with each other where bodies touch: compliance, friction, restitution.

#include <cmath>

#include "bedload/case/config/contact.hpp"
#include "bedload/case/config/grains.hpp"
#include "bedload/case/config/walls.hpp"

namespace bedload {

/// What one side adds to the moduli of a contact: 1/E* and 1/G* are the sums of both sides'.
struct ElasticCompliance {
  double normal = 0;      ///< (1 - nu^2) / E, 1/Pa
  double tangential = 0;  ///< (2 - nu) / G, 1/Pa

  ElasticCompliance() = default;
  /// E: Young's modulus, Pa; nu: Poisson's ratio.
  ElasticCompliance(double E, double nu)
      : normal((1 - nu * nu) / E), tangential(2 * (1 + nu) * (2 - nu) / E) {}
};

struct Elasticity {
  double E, nu;  ///< Pa, -
};
/// Of a wall body: its own, else that of its material, else that of grain.*.
inline Elasticity wall_elasticity(const WallBody& body, const GrainConfig& grain) {
  const GrainMaterial of = grain.all_materials()[grain.material(body.material)];
  return {body.E > 0 ? body.E : of.E, std::isfinite(body.nu) ? body.nu : of.nu};
}
inline ElasticCompliance wall_compliance(const WallBody& body, const GrainConfig& grain) {
  const Elasticity own = wall_elasticity(body, grain);
  return {own.E, own.nu};
}

/// How two surfaces slide, roll and rebound.
struct SurfacePair {
  double mu, mu_r, e;
  /// With what the case's pair of these two names sets.
  SurfacePair in(const ContactConfig& contact, const std::string& a, const std::string& b) const {
    SurfacePair out = *this;
    for (const ContactPair& pair : contact.pairs) {
      if (!pair.joins(a, b)) continue;
      if (std::isfinite(pair.mu)) out.mu = pair.mu;
      if (std::isfinite(pair.mu_r)) out.mu_r = pair.mu_r;
      if (pair.e > 0) out.e = pair.e;
    }
    return out;
  }
};
inline std::string name_in_pairs(const GrainMaterial& m) { return m.name.empty() ? kMainMaterial : m.name; }
/// Of both, the mean.
inline SurfacePair mean(const GrainMaterial& a, const GrainMaterial& b) {
  return {0.5 * (a.mu + b.mu), 0.5 * (a.mu_r + b.mu_r), 0.5 * (a.e + b.e)};
}
/// Two grains: of their pair, else the mean of both.
inline SurfacePair surfaces(const GrainMaterial& a, const GrainMaterial& b, const ContactConfig& contact) {
  return mean(a, b).in(contact, name_in_pairs(a), name_in_pairs(b));
}
/// A grain and a wall body: of their pair, or the pair of the grain and the body's material; else the body's;
/// else the mean with its material, or the grain's if it has none.
inline SurfacePair surfaces(const GrainMaterial& a, const WallBody& body, const GrainConfig& grain,
                            const ContactConfig& contact) {
  SurfacePair own{a.mu, a.mu_r, a.e};
  if (!body.material.empty()) own = mean(a, grain.all_materials()[grain.material(body.material)]);
  if (std::isfinite(body.mu)) own.mu = body.mu;
  if (std::isfinite(body.mu_r)) own.mu_r = body.mu_r;
  if (body.e > 0) own.e = body.e;
  if (!body.material.empty()) own = own.in(contact, name_in_pairs(a), body.material);
  return own.in(contact, name_in_pairs(a), body.name);
}

}  // namespace bedload
