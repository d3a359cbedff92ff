#pragma once
// Velocity Verlet for free bodies, in step with the grains' substeps.

#include "kernels/bodies/rigid_body.hpp"

namespace BL_SOLVER {

/// The fields of BodyStore as kernels see them.
struct BodyFields {
  Span<Vec3d> x, v, angular_momentum, a, alpha;
  Span<Vec4<double>> rotation;
  Span<Vec3d> grain_force, grain_torque, contact_force, contact_torque, fluid_force, fluid_torque;
  Span<Vec3d> x_before, v_before, omega_before;
  Span<Vec4<double>> rotation_before;

  BL_HD RigidMotion motion(const RigidBody& k, Index b, bool held) const {
    RigidMotion m;
    m.centre = k.centre;
    m.translation = x[b] - k.centre;
    m.rotation = to_quat(rotation[b]);
    if (held) return m;
    m.v = v[b];
    m.omega = k.omega(m.rotation, angular_momentum[b]);
    m.a = a[b];
    m.alpha = alpha[b];
    return m;
  }
};

/// Loads on a body, kicks, and a drift to the next row of poses. Contacts act in every substep, the fluid at
/// both ends of its step.
struct BodyPass {
  const RigidBody* bodies;
  BodyFields s;
  const LoadSum* by_grains;        ///< new loads; null: unchanged
  const LoadSum* by_contacts;      ///< new loads; null: unchanged
  Vec3d gravity;                   ///< m/s2
  double kick, fluid_kick, drift;  ///< s
  double time;                     ///< s; bodies with a later release time are held
  std::uint32_t begins;            ///< 1: first kick of a step
  BodyPose* row;                   ///< [bodies] where the new poses are written; may be null

  BL_HD void operator()(Index b) const {
    const RigidBody& k = bodies[b];
    if (begins) {
      s.x_before[b] = s.x[b], s.rotation_before[b] = s.rotation[b], s.v_before[b] = s.v[b];
      s.omega_before[b] = k.omega(to_quat(s.rotation[b]), s.angular_momentum[b]);
    }
    if (by_grains) s.grain_force[b] = by_grains[b].force(), s.grain_torque[b] = by_grains[b].torque();
    if (by_contacts)
      s.contact_force[b] = by_contacts[b].force(), s.contact_torque[b] = by_contacts[b].torque();
    const bool held = time < k.release;
    if (!held) {
      advance(k, b);
    }
    if (row) static_cast<RigidMotion&>(row[k.body]) = s.motion(k, b, held);
  }

 private:
  BL_HD void advance(const RigidBody& k, Index b) const {
    const double fluid = k.fluid ? fluid_kick : 0;
    const Vec3d touch = s.grain_force[b] + s.contact_force[b];
    s.v[b] += k.movable((kick / k.mass) * touch + kick * gravity + (fluid / k.mass) * s.fluid_force[b]);
    const Vec3d weight = cross(to_quat(s.rotation[b]).rotate(k.arm), k.mass * gravity);
    s.angular_momentum[b] +=
        k.turnable(kick * (s.grain_torque[b] + s.contact_torque[b] + weight) + fluid * s.fluid_torque[b]);
    if (drift == 0) return;
    s.x[b] += drift * s.v[b];
    s.rotation[b] = to_vec4(k.turned(to_quat(s.rotation[b]), s.angular_momentum[b], drift));
  }
};

/// Poses as the bodies are now.
struct BodyPosePass {
  const RigidBody* bodies;
  BodyFields s;
  double time;
  std::uint32_t settling;  ///< 1: all are held
  int rows, row_size;
  BodyPose* poses;
  BL_HD void operator()(Index b) const {
    const RigidBody& k = bodies[b];
    const RigidMotion m = s.motion(k, b, settling || time < k.release);
    for (int r = 0; r < rows; ++r) static_cast<RigidMotion&>(poses[std::size_t(r) * row_size + k.body]) = m;
  }
};

/// Poses in the middle of the last step, with the mean velocities over it.
struct MidPosePass {
  const RigidBody* bodies;
  BodyFields s;
  double dt;  ///< s
  BodyPose* row;
  BL_HD void operator()(Index b) const {
    const RigidBody& k = bodies[b];
    const Quat<double> before = to_quat(s.rotation_before[b]);
    const Vec3d way = s.x[b] - s.x_before[b],
                angle = rotation_vector(to_quat(s.rotation[b]) * before.conjugate());
    RigidMotion m;
    m.centre = k.centre;
    m.translation = s.x_before[b] + 0.5 * way - k.centre;
    m.rotation = normalised(Quat<double>::from_rotation(0.5 * angle) * before);
    m.v = way * (1 / dt);
    m.omega = angle * (1 / dt);
    static_cast<RigidMotion&>(row[k.body]) = m;
  }
};

/// Acceleration of a body as the fluid next to it reads it, averaged over a few sound travel times across the
/// kernel. Wall pressure responds to it as an added mass. With the value of the last step alone, a body
/// lighter than its added mass would oscillate with growing amplitude at any step size. With the weight s of
/// the new value the response is stable while the added mass is below 2/s - 1 times the body's mass, about
/// 60.
struct BodyAccelerationPass {
  const RigidBody* bodies;
  BodyFields s;
  double dt, weight;  ///< step, s; weight of the new value
  BL_HD void operator()(Index b) const {
    const Vec3d omega = bodies[b].omega(to_quat(s.rotation[b]), s.angular_momentum[b]);
    s.a[b] += weight * ((s.v[b] - s.v_before[b]) * (1 / dt) - s.a[b]);
    s.alpha[b] += weight * ((omega - s.omega_before[b]) * (1 / dt) - s.alpha[b]);
  }
};

/// Place and motion for the host.
struct BodyReportPass {
  const RigidBody* bodies;
  BodyFields s;
  double time;  ///< s
  Span<RigidMotion> out;
  BL_HD void operator()(Index b) const { out[b] = s.motion(bodies[b], b, time < bodies[b].release); }
};

/// The solid that a wall body encloses.
struct EnclosedSolid {
  std::uint32_t body;  ///< among the wall bodies
  double volume;       ///< m3; 0 where its shape is not closed
  Vec3d middle;        ///< from the body's reference point to that of the volume at t = 0, m
};

/// The wall particles of one body, for sums over them.
struct BodyParticles {
  std::uint32_t body;
  Span<const std::uint32_t> of;
  Span<const Vec3d> x0;
  const BodyPose* poses;
  BL_HD bool has(Index w) const { return of[w] == body; }
  /// From the body's reference point to one of them, m.
  BL_HD Vec3d arm(Index w) const { return poses[body].place(x0[w]) - poses[body].origin(); }
};
inline BodyParticles particles_of(std::uint32_t body, const WallStore& walls, Span<const BodyPose> poses) {
  return {body, walls.body, walls.x0, poses.data};
}

/// Force of the fluid on the wall particles of one body.
struct WallLoadReduction {
  using Value = LoadSum;
  BodyParticles particles;
  Span<const Vec3d> force;
  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index w) const {
    Value sum = Value::zero();
    if (particles.has(w)) sum.add(force[w], cross(particles.arm(w), force[w]));
    return sum;
  }
  BL_HD void combine(Value& into, const Value& from) const { Value::combine(into, from); }
};

}  // namespace BL_SOLVER
