#pragma once
// Velocity Verlet for grains. Between substeps velocities are at mid-step. In fp32 builds each is then the
// sum of two floats, else small kicks would be lost to round-off.

#include <bit>

#include "kernels/contact/contact_pass.hpp"
#include "kernels/integrate/grain_kick.hpp"

namespace BL_SOLVER {

BL_HD Vec3d join(const Real3& most, const Real3& rest) { return Vec3d(most) + Vec3d(rest); }
/// v rounded to the 24 bits of a float, by bit operations: GCC 12 drops double(float(v)) from vectorised
/// code.
BL_HD double to_float_bits(double v) {
  if constexpr (sizeof(Real) == 8) return v;
  const auto bits = std::bit_cast<std::uint64_t>(v) + (1ull << 28);
  return std::bit_cast<double>(bits & ~((1ull << 29) - 1));
}
BL_HD void split(const Vec3d& v, Real3& most, Real3& rest) {
  const Vec3d head{to_float_bits(v.x), to_float_bits(v.y), to_float_bits(v.z)};
  most = Real3(head);
  rest = Real3(v - head);
}

/// First half kick and drift of an advance; touches only grain i.
struct FirstKickPass {
  GrainKick kick;
  Span<const Real3> force, torque;
  Span<Vec3d> x;
  Velocities<Real3> now, rest;
  DragImpulses impulses;
  BL_HD void operator()(Index i) const {
    kick.begin(i);
    KickedGrain g(kick, i, Vec3d(now.v[i]), Vec3d(now.omega[i]));
    g.load(Vec3d(force[i]), Vec3d(torque[i]));
    g.kick();
    x[i] = kick.drift(x[i], g.v);
    split(g.v, now.v[i], rest.v[i]);
    split(g.omega, now.omega[i], rest.omega[i]);
    if (!kick.wet()) return;
    impulses.linear[i] = Real3(g.impulse);
    impulses.angular[i] = Real3(g.spin_impulse);
  }
};

/// State of a grain at the end of its drift, prefetched before the loop over its contacts.
struct ArrivedGrain {
  Real3 v_most, v_rest, omega_most, omega_rest;
  Index wall_row;
  BL_HD ArrivedGrain(const ContactPass& contacts, const GrainKick& kick, Index i,
                     const Velocities<const Real3>& rest)
      : v_most(contacts.grains.v[i]),
        v_rest(rest.v[i]),
        omega_most(contacts.grains.omega[i]),
        omega_rest(rest.omega[i]),
        wall_row(contacts.wall_row_of(i)) {
    kick.prefetch(i);
  }
  BL_HD Vec3d v() const { return join(v_most, v_rest); }
  BL_HD Vec3d omega() const { return join(omega_most, omega_rest); }
};

/// Contacts of the grains where they have drifted to, then Finish: the kicks that follow. Neighbours are
/// read, so results go to other arrays. This pass and the next run over the threads that share the rows of
/// the contacts' list. Laws act as Law.
template <class Law, class Finish>
struct SubstepPass {
  ContactPass contacts;
  GrainKick kick;
  Velocities<const Real3> rest;
  Finish finish;
  BL_HD void operator()(Index thread) const {
    // with the walls of the next substep, which waits for this one to end
    if constexpr (!Finish::kLast) let_next_loop_begin();
    const Lane lane(thread, contacts.list.bits);
    const Index i = lane.row;
    const ArrivedGrain now(contacts, kick, i, rest);
    ContactSum sum = contacts.pairs<Law>(lane);
    KickedGrain g(kick, i, now.v(), now.omega());
    contacts.add_others(i, now.wall_row, sum);
    if (lane.index != 0) return;
    g.load(sum.force, sum.torque);
    finish(i, g, sum, kick, contacts.grains.x);
  }
};

/// The second half kick of a substep, then the first half kick and the drift of the next one.
struct NextDrift {
  static constexpr bool kLast = false;
  Span<Vec3d> next_x;
  Velocities<Real3> next, rest;
  DragImpulses impulses;
  BL_HD void operator()(Index i, KickedGrain& g, const ContactSum&, const GrainKick& kick,
                        Span<const Vec3d> x) const {
    g.kick();
    g.kick();
    next_x[i] = kick.drift(x[i], g.v);
    split(g.v, next.v[i], rest.v[i]);
    split(g.omega, next.omega[i], rest.omega[i]);
    if (!kick.wet()) return;
    impulses.linear[i] += Real3(g.impulse);
    impulses.angular[i] += Real3(g.spin_impulse);
  }
};

/// The second half kick of the last substep; leaves the forces, and the mean drag.
struct LastKick {
  static constexpr bool kLast = true;
  double duration;  ///< of the advance, s
  Velocities<Real3> next;
  Velocities<Real3> rest;  ///< low parts, for clumps to gather; empty: they are dropped
  DragImpulses impulses;
  Span<Real3> force, torque, drag_force;
  BL_HD void operator()(Index i, KickedGrain& g, const ContactSum& sum, const GrainKick& kick,
                        Span<const Vec3d>) const {
    g.kick();
    if (rest.v) {
      split(g.v, next.v[i], rest.v[i]);
      split(g.omega, next.omega[i], rest.omega[i]);
    } else {
      next.v[i] = Real3(g.v);
      next.omega[i] = Real3(g.omega);
    }
    force[i] = Real3(sum.force);
    torque[i] = Real3(sum.torque);
    if (!kick.wet()) return;
    const Vec3d all = Vec3d(impulses.linear[i]) + g.impulse;
    impulses.linear[i] = Real3(all);
    impulses.angular[i] = Real3(Vec3d(impulses.angular[i]) + g.spin_impulse);
    drag_force[i] = Real3(all * (1 / duration));
  }
};

/// Contact forces alone.
struct EvaluatePass {
  ContactPass contacts;
  Span<Real3> force, torque;
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, contacts.list.bits);
    const ContactSum sum = contacts(lane);
    if (lane.index != 0) return;
    const Index i = lane.row;
    force[i] = Real3(sum.force);
    torque[i] = Real3(sum.torque);
  }
};

/// Grains that are held: the fluid flows past fixed spheres.
struct HeldPass {
  double duration;  ///< s
  DragView drag;
  DragImpulses impulses;
  Span<Real3> drag_force;
  BL_HD void operator()(Index i) const {
    drag_force[i] = drag.coefficient[i] > 0 ? drag.coefficient[i] * drag.velocity[i] : Real3{};
    impulses.linear[i] = Real(duration) * drag_force[i];
    impulses.angular[i] =
        drag.rot_coefficient[i] > 0 ? Real(duration) * drag.rot_coefficient[i] * drag.rotation[i] : Real3{};
  }
};

}  // namespace BL_SOLVER
