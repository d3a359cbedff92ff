#pragma once
// How compliant elastic materials are where bodies touch.

#include <cmath>

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

/// Of a wall body: its own material, or that of the grains where it names none.
inline ElasticCompliance wall_compliance(const WallBody& body, const GrainConfig& grain) {
  return {body.E > 0 ? body.E : grain.E, std::isfinite(body.nu) ? body.nu : grain.nu};
}

}  // namespace bedload
