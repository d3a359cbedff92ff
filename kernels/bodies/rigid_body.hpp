#pragma once
// Free rigid bodies: Newton and Euler with constraints. The state is place, rotation, velocity and angular
// momentum of a reference point, which is the centre of mass, or the pivot of a body that only turns.

#include <array>

#include "bedload/case/setup_choices.hpp"
#include "bedload/particles/walls.hpp"

namespace BL_SOLVER {

BL_HD Quat<double> normalised(const Quat<double>& q) {
  const double s = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}
BL_HD Vec4<double> to_vec4(const Quat<double>& q) { return {q.x, q.y, q.z, q.w}; }
BL_HD Quat<double> to_quat(const Vec4<double>& q) { return {q.w, q.x, q.y, q.z}; }
/// Axis times angle (rad) of a rotation by less than half a turn.
BL_HD Vec3d rotation_vector(const Quat<double>& q) {
  const Vec3d u{q.x, q.y, q.z};
  const double s = norm(u);
  if (s == 0) return {};
  return u * (2 * std::atan2(q.w < 0 ? -s : s, q.w < 0 ? -q.w : q.w) / s);
}

/// Constants of a body.
struct RigidBody {
  std::uint32_t body = 0;  ///< among the wall bodies
  BodyMove move = BodyMove::all;
  BodyTurn turn = BodyTurn::all;
  std::uint32_t fluid = 1;     ///< 1: moved by the fluid
  std::uint32_t contacts = 1;  ///< 1: collides with other bodies
  double mass = 0;             ///< kg
  Vec3d centre;                ///< reference point at t = 0, m
  Vec3d arm;                   ///< from there to the centre of mass at t = 0, m; 0 unless it only turns
  Vec3d moments;               ///< principal, about the reference point, kg m2
  Quat<double> principal;      ///< turns the coordinate axes to the principal ones at t = 0
  Vec3d axis;                  ///< of what constrains its moves, unit
  Vec3d hinge;                 ///< of what constrains its turns, unit
  double axial = 0;            ///< moment of inertia about it, kg m2
  double release = 0;          ///< s
  double volume = 0;           ///< m3; 0 where it encloses none
  Vec3d middle;                ///< from the reference point to that of the volume at t = 0, m

  /// The part of a velocity or force that may move the body.
  BL_HD Vec3d movable(const Vec3d& v) const {
    if (move == BodyMove::all) return v;
    const Vec3d along = dot(v, axis) * axis;
    if (move == BodyMove::axis) return along;
    return move == BodyMove::plane ? v - along : Vec3d{};
  }
  /// The part of a torque that may turn it.
  BL_HD Vec3d turnable(const Vec3d& t) const {
    if (turn == BodyTurn::all) return t;
    return turn == BodyTurn::axis ? dot(t, hinge) * hinge : Vec3d{};
  }
  /// Angular velocity at angular momentum l, rad/s.
  BL_HD Vec3d omega(const Quat<double>& rotation, const Vec3d& l) const {
    if (turn == BodyTurn::none) return {};
    if (turn == BodyTurn::axis) return (dot(l, hinge) / axial) * hinge;
    const Quat<double> frame = rotation * principal;
    const Vec3d p = frame.conjugate().rotate(l);
    return frame.rotate({p.x / moments.x, p.y / moments.y, p.z / moments.z});
  }
  /// Angular momentum at angular velocity w, kg m2/s.
  BL_HD Vec3d momentum(const Quat<double>& rotation, const Vec3d& w) const {
    if (turn == BodyTurn::none) return {};
    if (turn == BodyTurn::axis) return (axial * dot(w, hinge)) * hinge;
    const Quat<double> frame = rotation * principal;
    const Vec3d p = frame.conjugate().rotate(w);
    return frame.rotate({p.x * moments.x, p.y * moments.y, p.z * moments.z});
  }
  /// Energy of rotation, J.
  BL_HD double turning_energy(const Quat<double>& rotation, const Vec3d& l) const {
    return 0.5 * dot(l, omega(rotation, l));
  }

  /// Rotation after a time h (s) without torque. Turns about the principal axes one after another, there and
  /// back again: symplectic and reversible, and the angular momentum, kept in the lab frame, stays what it is
  /// [dullweber97].
  BL_HD Quat<double> turned(const Quat<double>& rotation, const Vec3d& l, double h) const {
    if (turn == BodyTurn::none) return rotation;
    if (turn == BodyTurn::axis)
      return normalised(Quat<double>::from_rotation((h * dot(l, hinge) / axial) * hinge) * rotation);
    Quat<double> frame = rotation * principal;
    const int order[5] = {0, 1, 2, 1, 0};
    for (int s = 0; s < 5; ++s) {
      const int k = order[s];
      Vec3d step;
      step[k] = (s == 2 ? h : 0.5 * h) * frame.conjugate().rotate(l)[k] / moments[k];
      frame = frame * Quat<double>::from_rotation(step);
    }
    return normalised(frame * principal.conjugate());
  }

  /// 1 / effective mass (1/kg) against a force along n at r from the reference point.
  BL_HD double inverse_effective_mass(const Quat<double>& rotation, const Vec3d& r, const Vec3d& n) const {
    return dot(n, movable(n)) / mass + inverse_turning_inertia(rotation, cross(r, n));
  }
  /// 1 / moment of inertia about a, 1/(kg m2), times |a|^2.
  BL_HD double inverse_turning_inertia(const Quat<double>& rotation, const Vec3d& a) const {
    return dot(a, omega(rotation, a));
  }
  /// The same for rolling about a point at r: the mass adds to the inertia.
  BL_HD double inverse_rolling_inertia(const Quat<double>& rotation, const Vec3d& r, const Vec3d& a) const {
    const double e = inverse_turning_inertia(rotation, a);
    return e / (1 + e * mass * norm2(r));
  }
};

/// Force and torque of contacts on one body.
struct ContactLoad {
  Vec3d force;   ///< N
  Vec3d torque;  ///< about the body's reference point, N m
  std::uint32_t body;
};

/// Loads of each grain, or each ball of a body, on the bodies in contact with it: one entry per body.
struct ContactLoads {
  ContactLoad* slots = nullptr;  ///< [capacity][size]
  Index* counts = nullptr;       ///< [size]
  Index size = 0;
  int capacity = 0;  ///< bodies in contact with one of them at once

  BL_HD explicit operator bool() const { return slots != nullptr; }
  BL_HD void clear(Index i) const { counts[i] = 0; }
  BL_HD void add(Index i, const ContactLoad& load) const {
    const Index n = counts[i];
    for (Index k = 0; k < n; ++k) {
      ContactLoad& slot = slots[std::size_t(k) * size + i];
      if (slot.body != load.body) continue;
      slot.force += load.force;
      slot.torque += load.torque;
      return;
    }
    if (n >= Index(capacity)) return;
    slots[std::size_t(n) * size + i] = load;
    counts[i] = n + 1;
  }
};

/// Force and torque on a body, for reductions: plain numbers, since shared memory runs no constructors.
struct LoadSum {
  double sum[6];
  BL_HD Vec3d force() const { return {sum[0], sum[1], sum[2]}; }
  BL_HD Vec3d torque() const { return {sum[3], sum[4], sum[5]}; }
  BL_HD void add(const Vec3d& force, const Vec3d& torque) {
    for (int k = 0; k < 3; ++k) sum[k] += force[k], sum[3 + k] += torque[k];
  }
  BL_HD static LoadSum zero() { return {{0, 0, 0, 0, 0, 0}}; }
  BL_HD static void combine(LoadSum& into, const LoadSum& from) {
    for (int k = 0; k < 6; ++k) into.sum[k] += from.sum[k];
  }
};

/// Bounds for what single particles add to sums over a body, far above what occurs.
struct LoadBounds {
  double pressure, area, length;  ///< Pa; m2, of a particle; m, from the body to a particle

  std::array<double, 6> load() const {
    const double force = pressure * area;
    return {force, force, force, force * length, force * length, force * length};
  }
};

/// Sum of what was recorded for one body.
struct ContactLoadReduction {
  using Value = LoadSum;
  ContactLoads loads;
  std::uint32_t body;
  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index i) const {
    Value sum = Value::zero();
    for (Index k = 0; k < loads.counts[i]; ++k) {
      const ContactLoad& load = loads.slots[std::size_t(k) * loads.size + i];
      if (load.body == body) sum.add(load.force, load.torque);
    }
    return sum;
  }
  BL_HD void combine(Value& into, const Value& from) const { Value::combine(into, from); }
};

}  // namespace BL_SOLVER
