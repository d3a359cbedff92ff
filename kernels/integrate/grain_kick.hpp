#pragma once
// Kicks of a grain with drag. The fluid velocity and the drag coefficient are constant over a fluid step, so
// drag is integrated exactly: the terminal velocity is correct for any stiffness.

#include "bedload/parallel/overlap.hpp"
#include "kernels/boundaries/edges.hpp"
#include "kernels/contact/grain_mass.hpp"
#include "kernels/integrate/grain_fields.hpp"
#include "kernels/integrate/relaxation.hpp"

namespace BL_SOLVER {

/// Forces on a grain other than contacts, for the kicks between two evaluations of its contacts.
struct GrainKick {
  Vec3d gravity;  ///< m/s2
  MassPerR3 mass_per_r3;
  double h;  ///< half a substep, s
  bool exponential;
  Span<const Real> radius;
  // empty where there is no fluid
  Span<const Real3> fluid_force = {};
  Span<const Real3> fluid_torque = {};  ///< N m; where fluid flows around the grains
  DragView drag = {};
  Span<GrainRelaxation> relaxation = {};  ///< by `begin`
  Span<const Real> clump_d = {};  ///< > 0: drag acts on the grain's clump instead; empty: on grains alone
  Span<const Real3> drive = {};   ///< N; empty: none
  Edges edges = {};

  BL_HD bool wet() const { return bool(drag.coefficient); }
  /// Finds what is the same in all kicks of an advance; before the first one of grain i.
  BL_HD void begin(Index i) const {
    if (!wet()) return;
    const double m = mass(i), inertia = 0.4 * m * radius[i] * radius[i];
    const double K = clump_d && clump_d[i] > 0 ? Real(0) : drag.coefficient[i];
    relaxation[i] = {Relaxation(K / m, h, exponential),
                     Relaxation(drag.rot_coefficient[i] / inertia, h, exponential)};
  }
  /// Prefetches the input of KickedGrain for grain i.
  BL_HD void prefetch(Index i) const {
    if (drive) read_ahead(drive[i]);
    if (!wet()) return;
    read_ahead(fluid_force[i]), read_ahead(drag.velocity[i]), read_ahead(drag.rotation[i]);
    read_ahead(relaxation[i]);
  }
  BL_HD double mass(Index i) const { return mass_per_r3(i) * radius[i] * radius[i] * radius[i]; }
  /// Position after a substep from x; a reflecting side changes v, never the spin.
  BL_HD Vec3d drift(const Vec3d& x, Vec3d& v) const {
    Vec3d to = x + 2 * h * v;
    edges.put_back(x, to, v);
    return to;
  }
};

/// Velocity and spin of one grain during its kicks. Call `load` before `kick`.
struct KickedGrain {
  Vec3d v, omega;
  Vec3d impulse, spin_impulse;  ///< from drag, so far: N s, N m s

  BL_HD KickedGrain(const GrainKick& k, Index i, const Vec3d& v0, const Vec3d& omega0)
      : v(v0),
        omega(omega0),
        wet_(k.wet()),
        pushed_(k.fluid_force),
        turned_(k.fluid_torque),
        driven_(k.drive),
        m_(k.mass(i)),
        inertia_(0.4 * m_ * k.radius[i] * k.radius[i]),
        h_(k.h),
        fluid_force_(pushed_ ? Vec3d(k.fluid_force[i]) : Vec3d{}),
        fluid_torque_(turned_ ? Vec3d(k.fluid_torque[i]) : Vec3d{}),
        drive_(driven_ ? Vec3d(k.drive[i]) : Vec3d{}),
        gravity_(k.gravity),
        by_drag_(wet_ ? k.relaxation[i] : GrainRelaxation{}),
        fluid_velocity_(by_drag_.slide.fraction > 0 ? Vec3d(k.drag.velocity[i]) : Vec3d{}),
        fluid_angular_velocity_(by_drag_.spin.fraction > 0 ? Vec3d(k.drag.rotation[i]) : Vec3d{}) {}

  /// Sets the load of contacts: force (N) and torque (N m).
  BL_HD void load(Vec3d force, Vec3d torque) {
    if (pushed_) force += fluid_force_;
    if (turned_) torque += fluid_torque_;
    if (driven_) force += drive_;
    a_ = force * quotient(1.0, m_) + gravity_;
    alpha_ = torque * quotient(1.0, inertia_);
  }
  /// Kick of half a substep.
  BL_HD void kick() {
    const Vec3d dv = by_drag_.slide.drag(v, fluid_velocity_, a_, h_);
    const Vec3d dw = by_drag_.spin.drag(omega, fluid_angular_velocity_, alpha_, h_);
    v += dv + h_ * a_;
    omega += dw + h_ * alpha_;
    impulse += m_ * dv;
    spin_impulse += inertia_ * dw;
  }

 private:
  bool wet_, pushed_, turned_, driven_;
  double m_, inertia_, h_;
  Vec3d fluid_force_, fluid_torque_, drive_, gravity_, a_, alpha_;
  GrainRelaxation by_drag_;
  Vec3d fluid_velocity_, fluid_angular_velocity_;
};

}  // namespace BL_SOLVER
