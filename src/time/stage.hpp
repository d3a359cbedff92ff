#pragma once
// The stages of which a step is made up.

#include <string_view>
#include <vector>

#include "bedload/particles/store.hpp"
#include "bedload/particles/walls.hpp"
#include "bedload/step_limits.hpp"

namespace bedload::inline BL_VARIANT {

class Stepper;

/// What of a step is timed as one.
enum class Part { lists, fluid, grains, coupling, checks };
constexpr std::string_view name_of(Part part) {
  constexpr std::string_view names[] = {"lists", "fluid", "grains", "coupling", "checks"};
  return names[int(part)];
}

/// One step, as its stages see it.
struct Step {
  double start = 0, dt = 0, end = 0;  ///< s
  double last_kick = 0;               ///< s, of the second half-kick, with the fluid's forces at the end
  int substeps = 0;
  bool held = false;           ///< grains keep place and velocity
  Limit limit = Limit::fixed;  ///< what bound dt
  Limit substep_limit = Limit::fixed;
  Span<const BodyPose> poses{};  ///< of the walls at the end, once move_walls() has been
};

using Fields = std::vector<const FieldBase*>;

struct Stage {
  std::string_view name;
  Part part;
  /// What it takes from stages before it. Values that it may leave in a field are among those: where a field
  /// is written and not read, no value that it had matters.
  Fields reads;
  Fields writes;
  void (Stepper::*run)(Step&);
};

}  // namespace bedload::inline BL_VARIANT
