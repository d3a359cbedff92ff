#pragma once
// The units of a lattice: how long a step is, and what that means for the fluid.

#include <cstdint>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/step_limits.hpp"

namespace bedload {

/// Nodes of the domain along an axis, at the centres of cells of width fluid.dx.
std::int64_t cells_along(const Config& config, int axis);

/// Whether there is a layer of nodes beyond both sides along an axis, which are no fluid: where it is not
/// periodic, or sheared.
bool has_outer_nodes(const Config& config, int axis);

/// Gravity on the fluid of a lattice, m/s2. Where grains move there is none: each of them then has the weight
/// by which it is heavier than the fluid, and pressures are without that of the fluid at rest.
Vec3d gravity_on_fluid(const Config& config);

struct LatticeStep {
  double dt = 0;                  ///< s
  double tau = 0;                 ///< relaxation time of the viscosity, steps
  double vmax = 0;                ///< fluid.vmax in nodes a step
  double sound = 0;               ///< m/s
  std::vector<StepLimit> limits;  ///< on dt
};

/// The longest step that keeps all limits, or the one that lattice.tau sets.
LatticeStep lattice_step(const Config& config);

}  // namespace bedload
