#pragma once
// Load on a wall body, and its time integral with the weights of the time integration.

#include "kernels/bodies/rigid_body.hpp"

namespace BL_SOLVER {

/// Force 3 (N), torque about a fixed point 3 (N m), power (W); or these times s.
struct BodyAction {
  static constexpr int kSize = 7;
  double v[kSize];

  /// load: about the body's centre, which is at `from` (m) from the point of the torque; the body moves with
  /// v (m/s) and omega (rad/s).
  BL_HD static BodyAction of(const LoadSum& load, const Vec3d& from, const Vec3d& v, const Vec3d& omega) {
    const Vec3d force = load.force(), torque = load.torque() + cross(from, force);
    return {
        {force.x, force.y, force.z, torque.x, torque.y, torque.z, dot(force, v) + dot(load.torque(), omega)}};
  }
  BL_HD Vec3d force() const { return {v[0], v[1], v[2]}; }
  BL_HD Vec3d torque() const { return {v[3], v[4], v[5]}; }
  BL_HD double power() const { return v[6]; }
  BL_HD void add(double factor, const BodyAction& other) {
    for (int k = 0; k < kSize; ++k) v[k] += factor * other.v[k];
  }
};

/// Sources of the load on a body.
enum ActionPart { kByPressure, kByFriction, kByGrains, kByBodies, kActionParts };

/// A body whose load is summed, with the point of its torque.
struct MeteredBody {
  std::uint32_t body;
  std::uint32_t free;  ///< 1 + place among the free bodies; 0: motion prescribed
  Vec3d about;         ///< m
};

struct AddLoadsPass {
  Span<const LoadSum> more;
  Span<LoadSum> sum;
  BL_HD void operator()(Index m) const { LoadSum::combine(sum[m], more[m]); }
};

/// Adds one step to the sums: the fluid acts in the kicks at both ends of the step, contacts for half a
/// substep at both ends of each substep.
struct SumActionsPass {
  Frame frame;
  Span<const MeteredBody> bodies;
  const BodyPose* now;           ///< [row_size], at the end of the step
  const BodyPose* rows;          ///< [substeps + 1][row_size], at the start and after each substep
  int row_size, substeps;        ///< substeps: 0 without substeps
  double substep;                ///< s
  double first_kick, last_kick;  ///< of the fluid's force, s
  Span<const LoadSum> by_pressure, by_friction;  ///< [bodies], now; about the centres
  Span<const LoadSum> by_grains, by_bodies;      ///< [substeps][bodies]; empty where there are none
  Span<const Vec3d> free_force, free_torque;     ///< total fluid load by which free bodies move
  Span<const LoadSum> corrections;               ///< of the pressure on others, by wall body; may be empty
  Span<BodyAction> action;  ///< [bodies][kActionParts], at the end of the previous step; then of this one
  Span<BodyAction> sum;     ///< [bodies][kActionParts]

  BL_HD void operator()(Index m) const {
    const MeteredBody& body = bodies[m];
    const BodyPose& pose = now[body.body];
    const LoadSum friction = by_friction[m];
    LoadSum pressure = by_pressure[m];
    if (body.free && free_force) {
      pressure = LoadSum::zero();
      pressure.add(free_force[body.free - 1] - friction.force(),
                   free_torque[body.free - 1] - friction.torque());
    } else if (corrections) {
      LoadSum::combine(pressure, corrections[body.body]);
    }
    advance(m, kByPressure, first_kick, last_kick, at(body, pose, pressure));
    advance(m, kByFriction, first_kick, last_kick, at(body, pose, friction));
    contacts(m, kByGrains, by_grains);
    contacts(m, kByBodies, by_bodies);
  }

 private:
  BL_HD BodyAction at(const MeteredBody& body, const BodyPose& pose, const LoadSum& load) const {
    return BodyAction::of(load, frame.nearest_image(pose.origin() - body.about), pose.v, pose.omega);
  }
  BL_HD void advance(Index m, ActionPart part, double before, double after, const BodyAction& next) const {
    const Index k = m * kActionParts + part;
    sum[k].add(before, action[k]);
    sum[k].add(after, next);
    action[k] = next;
  }
  BL_HD void contacts(Index m, ActionPart part, Span<const LoadSum> loads) const {
    if (substeps == 0 || loads.size == 0) return;
    const MeteredBody& body = bodies[m];
    for (int s = 1; s < substeps; ++s) {
      // rows of free bodies have their velocity in the middle of the substep before
      const BodyPose &here = rows[s * row_size + body.body], &next = rows[(s + 1) * row_size + body.body];
      BodyPose pose = here;
      if (body.free) pose.v = 0.5 * (here.v + next.v), pose.omega = 0.5 * (here.omega + next.omega);
      sum[m * kActionParts + part].add(substep, at(body, pose, loads[(s - 1) * bodies.size + m]));
    }
    advance(m, part, 0.5 * substep, 0.5 * substep,
            at(body, now[body.body], loads[(substeps - 1) * bodies.size + m]));
  }
};

}  // namespace BL_SOLVER
