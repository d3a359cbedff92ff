#pragma once
// What a simulation is at a moment: particles, bodies, walls and the clock.

#include "bedload/case/config.hpp"
#include "bedload/motion/law.hpp"
#include "bedload/particles/fluid.hpp"
#include "bedload/particles/grains.hpp"
#include "bedload/particles/walls.hpp"
#include "src/boundaries/open_boundaries.hpp"
#include "src/solids/grain_matter.hpp"
#include "src/time/clock.hpp"
#include "src/time/host_particles.hpp"
#include "src/walls/free_bodies.hpp"
#include "src/walls/wall_geometry.hpp"
#include "src/walls/wall_motion.hpp"

namespace BL_SOLVER {

/// The store of that name; FileError without it.
const HostStore& store_of(const SavedState& saved, const std::string& name);
/// And the number of that name.
double scalar_of(const SavedState& saved, const std::string& name);

/// What checkpoints hold and users read; a Stepper takes it from one step to the next. Solvers add fields of
/// their own to its stores.
struct State {
  explicit State(const Config& config);
  State(const State&) = delete;

  /// The particles with which a case begins. To be taken once, when solvers have added their fields.
  HostState particles_of(const Config& config, const Setup& setup);
  /// Those of a checkpoint. Throws FileError.
  HostState particles_of(const Config& config, const SavedState& saved);

  void save(SavedState& out) const;
  /// Whatever else save() wrote. Throws FileError.
  void load(const SavedState& saved);

  /// Of all walls, now: two rows.
  Span<const BodyPose> poses_now() { return motion.poses_at(clock.time); }

  const bool has_fluid, has_grains;
  const bool coupled, two_way;  ///< fluid acts on grains; grains act on fluid, too

  const Frame frame;
  Clock clock;
  FluidStore fluid;
  WallStore walls;
  GrainStore grains;
  const WallGeometry geometry, grain_geometry;  ///< surfaces that fluid and that grains meet
  const WallGeometry shells;                    ///< with fluid on both sides: single layers
  FreeBodies bodies;
  WallMotion motion;
  OpenBoundaries open;
  const EffectiveGravity gravity;
  const GrainMatter matter;
};

}  // namespace BL_SOLVER
