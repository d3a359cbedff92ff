#pragma once
// The stages of a step, and what each uses.

#include <functional>
#include <string_view>
#include <vector>

#include "bedload/parallel/stopwatch.hpp"
#include "bedload/particles/store.hpp"
#include "bedload/particles/walls.hpp"
#include "bedload/step_limits.hpp"

namespace BL_SOLVER {

/// What of a step is timed as one.
enum class Part { lists, fluid, grains, coupling, checks };
constexpr std::string_view name_of(Part part) {
  constexpr std::string_view names[] = {"lists", "fluid", "grains", "coupling", "checks"};
  return names[int(part)];
}

using Fields = std::vector<const FieldBase*>;

/// Fields that a stage uses. Values that it may leave in a field are read: where a field is written and not
/// read, its former value does not matter.
struct Access {
  Fields near;   ///< read of other particles as well
  Fields reads;  ///< read of the particle itself alone
  Fields writes;
};

struct Stage {
  std::string_view name;
  Part part;
  Access fields;  ///< those that the case has, each once
};

/// Called before each stage of a step, and after the last with null.
using Observer = std::function<void(const Stage* next)>;

/// One step, as its stages see it.
struct Step {
  double start = 0, dt = 0, end = 0;  ///< s
  double last_kick = 0;               ///< s, of the second half-kick, with the fluid's forces at the end
  int substeps = 0;
  bool held = false;           ///< grains keep place and velocity
  Limit limit = Limit::fixed;  ///< what bound dt
  Limit substep_limit = Limit::fixed;
  Span<const BodyPose> poses{};  ///< of the walls at the end, once move_walls() has been

  Stopwatch* watch = nullptr;  ///< times the parts; null: nothing is timed
  Part timed = Part::lists;    ///< the part that runs
  const Observer* observer = nullptr;
};

}  // namespace BL_SOLVER
