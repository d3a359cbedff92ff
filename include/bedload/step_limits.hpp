#pragma once
// What may bound a step of a run, and the substeps of its grains and free bodies.

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace bedload {

enum class Limit {
  cfl,
  viscous,
  friction,
  body,
  drag,
  travel,
  contact,
  rayleigh,
  rolling,
  lubrication,
  grain_drag,
  body_contact,
  body_rolling,
  body_turn,
  flow_speed,
  relaxation,
  body_force,
  static_head,
  fixed_relaxation,
  growth,
  fixed
};

struct NamedLimit {
  Limit limit;
  std::string_view name;
  std::string_view key;  ///< of the case, to turn where it binds; empty: it follows from speeds alone
};

/// In the order of the enumerators.
inline constexpr auto kLimits = std::to_array<NamedLimit>({
    {Limit::cfl, "cfl", "time.cfl"},                               // sound
    {Limit::viscous, "viscous", "time.visc"},                      // viscosity of WCSPH
    {Limit::friction, "friction", "time.friction"},                // of SDPD
    {Limit::body, "body", "time.body"},                            // acceleration
    {Limit::drag, "drag", "time.drag"},                            // on the fluid
    {Limit::travel, "travel", ""},                                 // of grains and walls in a step
    {Limit::contact, "contact", "time.contact"},                   // of grains
    {Limit::rayleigh, "rayleigh", "time.rayleigh"},                // waves in a grain
    {Limit::rolling, "rolling", "grain.mu_r"},                     // its spring
    {Limit::lubrication, "lubrication", "lubrication.least_gap"},  // films between grains
    {Limit::grain_drag, "grain drag", "drag.integrator"},          // explicit, in substeps
    {Limit::body_contact, "body contact", "time.contact"},         // of free bodies
    {Limit::body_rolling, "body rolling", "wall.body.free.mu_r"},  // its spring
    {Limit::body_turn, "body turn", ""},                           // of free bodies in a substep
    {Limit::flow_speed, "flow speed", "lattice.velocity"},         // on the lattice, as those that follow
    {Limit::relaxation, "relaxation", "lattice.tau_max"},          //
    {Limit::body_force, "body force", ""},                         // travel by it in a step
    {Limit::static_head, "static head", ""},                       // density by the fluid's weight
    {Limit::fixed_relaxation, "relaxation time", "lattice.tau"},   // as given
    {Limit::growth, "growth", ""},                                 // a step grows by at most 5 %
    {Limit::fixed, "fixed", "time.dt"},
});
static_assert([] {
  for (std::size_t k = 0; k < kLimits.size(); ++k)
    if (kLimits[k].limit != Limit(k)) return false;
  return kLimits.size() == std::size_t(Limit::fixed) + 1;
}());

constexpr std::string_view name_of(Limit limit) { return kLimits[std::size_t(limit)].name; }
constexpr std::string_view key_of(Limit limit) { return kLimits[std::size_t(limit)].key; }

/// Name and key: "lubrication (lubrication.least_gap)".
inline std::string with_key(Limit limit) {
  const std::string key(key_of(limit));
  return std::string(name_of(limit)) + (key.empty() ? "" : " (" + key + ")");
}

/// How long a step one of them allows.
struct StepLimit {
  Limit limit = Limit::fixed;
  double seconds = std::numeric_limits<double>::infinity();
  bool binds = false;  ///< the least of those that are listed together
  int body = -1;       ///< place in wall.body of the free body that sets it; -1: none
};

/// The least; without limits one that is infinite.
inline StepLimit least_of(const std::vector<StepLimit>& limits) {
  StepLimit least;
  for (const StepLimit& l : limits)
    if (l.seconds < least.seconds) least = l;
  return least;
}

/// Marks the least as the one that binds.
inline std::vector<StepLimit> with_binding(std::vector<StepLimit> limits) {
  const auto shorter = [](const StepLimit& a, const StepLimit& b) { return a.seconds < b.seconds; };
  for (StepLimit& l : limits) l.binds = false;
  if (const auto least = std::min_element(limits.begin(), limits.end(), shorter); least != limits.end())
    least->binds = true;
  return limits;
}

}  // namespace bedload
