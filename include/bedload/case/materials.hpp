#pragma once
// How far elastic materials give way where bodies touch.

#include <cmath>

#include "bedload/case/config.hpp"

namespace bedload {

/// What one side gives to the moduli of a contact: 1/E* and 1/G* are the sums of both sides'.
struct ElasticGive {
  double normal = 0;    ///< (1 - nu^2) / E, 1/Pa
  double sideways = 0;  ///< (2 - nu) / G, 1/Pa

  ElasticGive() = default;
  /// E: Young's modulus, Pa; nu: Poisson's ratio.
  ElasticGive(double E, double nu) : normal((1 - nu * nu) / E), sideways(2 * (1 + nu) * (2 - nu) / E) {}
};

/// Of a wall body: its own material, or that of the grains where it names none.
inline ElasticGive wall_give(const Config& config, const WallBody& body) {
  return {body.E > 0 ? body.E : config.grain.E, std::isfinite(body.nu) ? body.nu : config.grain.nu};
}

}  // namespace bedload
