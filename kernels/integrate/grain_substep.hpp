#pragma once
// Velocity Verlet for grains. Between substeps velocities are at mid-step. In fp32 builds each is then the
// sum of two floats, else small kicks would be lost to round-off.

#include <bit>

#include "kernels/contact/contact_pass.hpp"
#include "kernels/integrate/grain_kick.hpp"

namespace bedload::inline BL_VARIANT {

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
  Span<Real3> v, omega, v_rest, omega_rest, impulse, spin_impulse;
  BL_HD void operator()(Index i) const {
    KickedGrain g(kick, i, Vec3d(v[i]), Vec3d(omega[i]));
    g.load(Vec3d(force[i]), Vec3d(torque[i]));
    g.kick();
    x[i] = kick.drift(x[i], g.v);
    split(g.v, v[i], v_rest[i]);
    split(g.omega, omega[i], omega_rest[i]);
    if (!kick.wet()) return;
    impulse[i] = Real3(g.impulse);
    spin_impulse[i] = Real3(g.spin_impulse);
  }
};

/// State of a grain at the end of its drift, prefetched before the loop over its contacts.
struct ArrivedGrain {
  Real3 v_most, v_rest, omega_most, omega_rest;
  Index wall_row;
  BL_HD ArrivedGrain(const ContactPass& contacts, const GrainKick& kick, Index i, Span<const Real3> v_rests,
                     Span<const Real3> omega_rests)
      : v_most(contacts.grains.v[i]),
        v_rest(v_rests[i]),
        omega_most(contacts.grains.omega[i]),
        omega_rest(omega_rests[i]),
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
  Span<const Real3> v_rest, omega_rest;
  Finish finish;
  BL_HD void operator()(Index thread) const {
    // with the walls of the next substep, which waits for this one to end
    if constexpr (!Finish::kLast) let_next_loop_begin();
    const Lane lane(thread, contacts.list.bits);
    const Index i = lane.row;
    const ArrivedGrain now(contacts, kick, i, v_rest, omega_rest);
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
  Span<Real3> next_v, next_omega, v_rest, omega_rest, impulse, spin_impulse;
  BL_HD void operator()(Index i, KickedGrain& g, const ContactSum&, const GrainKick& kick,
                        Span<const Vec3d> x) const {
    g.kick();
    g.kick();
    next_x[i] = kick.drift(x[i], g.v);
    split(g.v, next_v[i], v_rest[i]);
    split(g.omega, next_omega[i], omega_rest[i]);
    if (!kick.wet()) return;
    impulse[i] += Real3(g.impulse);
    spin_impulse[i] += Real3(g.spin_impulse);
  }
};

/// The second half kick of the last substep; leaves the forces, and the mean drag.
struct LastKick {
  static constexpr bool kLast = true;
  double duration;  ///< of the advance, s
  Span<Real3> next_v, next_omega, impulse, spin_impulse, force, torque, drag_force;
  BL_HD void operator()(Index i, KickedGrain& g, const ContactSum& sum, const GrainKick& kick,
                        Span<const Vec3d>) const {
    g.kick();
    next_v[i] = Real3(g.v);
    next_omega[i] = Real3(g.omega);
    force[i] = Real3(sum.force);
    torque[i] = Real3(sum.torque);
    if (!kick.wet()) return;
    const Vec3d all = Vec3d(impulse[i]) + g.impulse;
    impulse[i] = Real3(all);
    spin_impulse[i] = Real3(Vec3d(spin_impulse[i]) + g.spin_impulse);
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
  Span<Real3> impulse, spin_impulse, drag_force;
  BL_HD void operator()(Index i) const {
    drag_force[i] = drag.coefficient[i] > 0 ? drag.coefficient[i] * drag.velocity[i] : Real3{};
    impulse[i] = Real(duration) * drag_force[i];
    spin_impulse[i] =
        drag.rot_coefficient[i] > 0 ? Real(duration) * drag.rot_coefficient[i] * drag.rotation[i] : Real3{};
  }
};

}  // namespace bedload::inline BL_VARIANT
