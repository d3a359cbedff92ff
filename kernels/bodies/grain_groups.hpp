#pragma once
// Grains that move as one rigid body. Each grain is kicked on its own; the sum of the gained momenta moves
// the group, and the grains then follow it.

#include "kernels/bodies/body_kicks.hpp"
#include "kernels/integrate/grain_substep.hpp"

namespace BL_SOLVER {

/// State of the groups, and which grains belong to them.
struct GrainGroups {
  const RigidBody* groups;             ///< about their centres of mass
  Span<Vec3d> x, v, angular_momentum;  ///< of and about those centres: m, m/s, kg m2/s
  Span<Vec4<double>> rotation;
  Span<const std::uint32_t> group;  ///< of each grain: 1 + its group, 0 without one
  Span<const Vec3d> arm;            ///< of each grain from the centre of its group, unturned, m

  BL_HD Vec3d omega(Index g) const { return groups[g].omega(to_quat(rotation[g]), angular_momentum[g]); }
  BL_HD Vec3d lever(Index i) const { return to_quat(rotation[group[i] - 1]).rotate(arm[i]); }
  BL_HD Vec3d velocity(Index i) const {
    const Index g = group[i] - 1;
    return v[g] + cross(omega(g), lever(i));
  }
};

/// Momentum and angular momentum about its centre that a group has gained since its grains last followed it,
/// stored as force and torque; N s and N m s.
struct GainReduction {
  using Value = LoadSum;
  GrainGroups all;
  Index of;
  MassPerR3 mass_per_r3;
  Span<const Real> radius;
  Velocities<const Real3> now, rest;  ///< rest may be empty
  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index i) const {
    Value sum = Value::zero();
    if (all.group[i] != of + 1) return sum;
    const double R = radius[i], m = mass_per_r3(i) * R * R * R;
    const Vec3d v_rest = rest.v ? Vec3d(rest.v[i]) : Vec3d{},
                omega_rest = rest.v ? Vec3d(rest.omega[i]) : Vec3d{};
    const Vec3d gained = m * (Vec3d(now.v[i]) - Vec3d(Real3(all.velocity(i))) + v_rest);
    const Vec3d turned = 0.4 * m * R * R * (Vec3d(now.omega[i]) - Vec3d(Real3(all.omega(of))) + omega_rest);
    sum.add(gained, cross(all.lever(i), gained) + turned);
    return sum;
  }
  BL_HD void combine(Value& into, const Value& from) const { Value::combine(into, from); }
};

/// Applies the momenta gained by the grains to a group, within its constraints, then drifts it.
struct GroupPass {
  GrainGroups all;
  const LoadSum* gained;
  double drift;  ///< s
  BL_HD void operator()(Index g) const {
    const RigidBody& k = all.groups[g];
    all.v[g] += k.movable((1 / k.mass) * gained[g].force());
    all.angular_momentum[g] += k.turnable(gained[g].torque());
    if (drift == 0) return;
    all.x[g] += drift * all.v[g];
    all.rotation[g] = to_vec4(k.turned(to_quat(all.rotation[g]), all.angular_momentum[g], drift));
  }
};

/// Sets position and motion of grains from their group.
struct FollowPass {
  GrainGroups all;
  Frame frame;
  Span<Vec3d> x;
  Velocities<Real3> now, rest;  ///< rest may be empty
  BL_HD void operator()(Index i) const {
    if (all.group[i] == 0) return;
    const Index g = all.group[i] - 1;
    x[i] = frame.wrap(all.x[g] + all.lever(i));
    now.v[i] = Real3(all.velocity(i));
    now.omega[i] = Real3(all.omega(g));
    if (rest.v) rest.v[i] = {}, rest.omega[i] = {};
  }
};

/// Force and torque about its centre on one group, of forces and torques on its grains.
struct GroupLoadReduction {
  using Value = LoadSum;
  GrainGroups all;
  Index of;
  Span<const Real3> force, torque, more;  ///< N, any unit, N; `more`: another force, may be empty
  double per_torque;                      ///< converts the torque to N m
  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index i) const {
    Value sum = Value::zero();
    if (all.group[i] != of + 1) return sum;
    Vec3d f = Vec3d(force[i]);
    if (more) f += Vec3d(more[i]);
    sum.add(f, cross(all.lever(i), f) + per_torque * Vec3d(torque[i]));
    return sum;
  }
  BL_HD void combine(Value& into, const Value& from) const { Value::combine(into, from); }
};

}  // namespace BL_SOLVER
