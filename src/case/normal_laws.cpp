#include "bedload/case/normal_laws.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bedload {

using std::numbers::pi;

double least_restitution(const ContactConfig& contact) {
  if (!contact.clip_tension) return 0.01;
  switch (contact.normal) {
    case NormalLaw::linear:
      return 0.136;
    case NormalLaw::hertz:
    case NormalLaw::democritus:
    case NormalLaw::none:
      break;
  }
  return 0.05;
}

bool takes_moduli(NormalLaw law) {
  switch (law) {
    case NormalLaw::hertz:
    case NormalLaw::democritus:
      return true;
    case NormalLaw::linear:
    case NormalLaw::none:
      break;
  }
  return false;
}

Impact impact(const ContactConfig& contact, double m, double R, double E, double v, double e) {
  switch (contact.normal) {
    case NormalLaw::hertz:
    case NormalLaw::democritus:
      if (v > 0) return hertz_impact(m, R, E, v);
      break;
    case NormalLaw::linear: {
      const double damping = std::log(e) / std::hypot(pi, std::log(e));
      return {pi * std::sqrt(m / contact.k) / std::sqrt(1 - damping * damping), contact.k};
    }
    case NormalLaw::none:
      break;
  }
  return {};
}

Impact hertz_impact(double m, double R, double E, double v) {
  const double overlap = std::pow(15 * m * v * v / (16 * E * std::sqrt(R)), 0.4);
  return {2.8683 * std::pow(m * m / (R * E * E * v), 0.2), 2 * E * std::sqrt(R * overlap)};
}

double overlap_under(const ContactConfig& contact, double force, double R, double E) {
  switch (contact.normal) {
    case NormalLaw::hertz:
    case NormalLaw::democritus:
      return std::pow(force / (4.0 / 3 * E * std::sqrt(R)), 2.0 / 3);
    case NormalLaw::linear:
      return force / std::max(contact.k, 1e-300);
    case NormalLaw::none:
      break;
  }
  return 0;
}

}  // namespace bedload
