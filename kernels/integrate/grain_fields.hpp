#pragma once
#include "bedload/particles/grains.hpp"

namespace BL_SOLVER {

/// Of grains, m/s and rad/s.
template <class Vector>
struct Velocities {
  Span<Vector> v, omega;
};

/// What drag gives grains in a step, N s and N m s.
struct DragImpulses {
  Span<Real3> linear, angular;
};

/// Drag on grains, which is constant over a step of the fluid.
template <class Vector, class Number>
struct DragOf {
  Span<Vector> velocity, rotation;  ///< of the fluid around a grain, m/s, rad/s
  Span<Number> coefficient,
      rot_coefficient;  ///< force per slip velocity, kg/s; torque per relative spin, N m s
};
using DragFields = DragOf<Real3, Real>;
using DragView = DragOf<const Real3, const Real>;

inline DragFields drag_of(GrainStore& g) {
  return {g.fluid_velocity, g.fluid_angular_velocity, g.drag_coefficient, g.rot_drag_coefficient};
}
inline DragView drag_of(const GrainStore& g) {
  return {g.fluid_velocity, g.fluid_angular_velocity, g.drag_coefficient, g.rot_drag_coefficient};
}

}  // namespace BL_SOLVER
