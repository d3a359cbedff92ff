#pragma once
// Forces between grains, and between grains and walls.

#include <limits>
#include <string>
#include <vector>

#include "bedload/case/choices.hpp"

namespace bedload {

/// What two materials of grains, or one and a wall body, have with each other; infinity and 0: what follows
/// from each.
struct ContactPair {
  std::vector<std::string> of;                 ///< their names, two; kMainMaterial: that of grain.*
  double mu = std::numeric_limits<double>::infinity();
  double mu_r = std::numeric_limits<double>::infinity();
  double e = 0;
  bool joins(const std::string& a, const std::string& b) const {
    return of.size() == 2 && ((of[0] == a && of[1] == b) || (of[0] == b && of[1] == a));
  }
  bool operator==(const ContactPair&) const = default;
};
/// Name of the material of grain.* in a pair.
inline constexpr const char* kMainMaterial = "grain";

struct ContactConfig {
  Chosen<NormalLaw> normal = NormalLaw::hertz;
  Chosen<SlidingLaw> tangential = SlidingLaw::mindlin;
  Chosen<RollingLaw> rolling = RollingLaw::epsd;
  double k = 0;                                ///< N/m, linear only
  double kt_ratio = 2.0 / 7.0;
  double tangential_damping = 1;               ///< fraction of c_n sqrt(S_t/S_n) that damps friction's spring
  double eta_r = 0.3;
  bool clip_tension = true;
  bool he_damping = false;                     ///< paper.he_damping: sqrt(6) prefactor of He et al. (20b)
  bool cap_rolling = true;                     ///< the stabilising cap on cdt; off only for tests
  std::vector<ContactPair> pairs{};
  bool operator==(const ContactConfig&) const = default;
};

/// Forces of the fluid that grains squeeze out from between them.
struct LubricationConfig {
  Chosen<LubricationForces> forces = LubricationForces::none;
  double cut_off = 1;                          ///< gap beyond which they do not act / R*
  double least_gap = 0.01;                     ///< gap below which it grows no further / R*
  bool acts() const { return forces != LubricationForces::none; }
  bool operator==(const LubricationConfig&) const = default;
};

}  // namespace bedload
