#pragma once
// Step limits of grains and of contacts, from the keys of a case.

#include <vector>

#include "bedload/case/config/contact.hpp"
#include "bedload/step_limits.hpp"

namespace bedload {

struct Config;

/// What bounds a substep of the grains of a case: Rayleigh time, contact duration, rolling and films of the
/// smallest of each material, each times its fraction (time.rayleigh, time.contact).
class SubstepLimits {
 public:
  explicit SubstepLimits(const Config& config);
  /// With impacts at `speed` (m/s), or at what gravity gives over a diameter if that is more.
  std::vector<StepLimit> at(double speed) const;

 private:
  /// Two that may touch.
  struct Pair {
    double mass, R, E_star;  ///< reduced, kg; m; Pa
    double e;                ///< restitution
    double mu_r, inertia;    ///< of rolling; reduced, about the contact, kg m2
  };
  std::vector<Pair> pairs_;
  ContactConfig contact_;
  double fraction_;         ///< of a contact's duration
  double least_speed_;      ///< m/s
  double rayleigh_, film_;  ///< s
};

/// The same of grains at rest, known before anything moves; the least binds. Empty without grains or
/// contacts.
std::vector<StepLimit> grain_limits(const Config& config);

/// Overlap at the bottom of the bed by its own weight, over the radius; beyond kSoftBed results suffer.
double bed_overlap(const Config& config);
inline constexpr double kSoftBed = 0.01;

/// Diameter of a grain over fluid.dx up to which drag laws hold, up to which they are taken with a warning,
/// and from which the flow around it is resolved.
inline constexpr double kAveraged = 2, kDragged = 4, kResolved = 8;

}  // namespace bedload
