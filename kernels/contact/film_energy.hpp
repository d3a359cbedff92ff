#pragma once
// What lubrication dissipates: the work of its forces on grains, less that of the walls, found grain by grain
// as in contact_energy.hpp. It stores nothing.

#include "kernels/contact/contact_energy.hpp"

namespace BL_SOLVER {

/// Lubrication of a grain at the end of a substep. Kept, since the next substep begins with it.
struct FilmAction {
  Real3 force, torque;  ///< on the grain, N, N m
  double by_walls;      ///< power of the walls, W

  BL_HD double power(const Real3& v, const Real3& omega) const {
    return dot(Vec3d(force), Vec3d(v)) + dot(Vec3d(torque), Vec3d(omega));
  }
};
/// Bit by bit.
template <>
struct FileType<FilmAction> {
  static constexpr Scalar scalar = Scalar::f64;
  static constexpr int components = sizeof(FilmAction) / sizeof(double);
};

/// Over the grains, after LubricationPass; dt = 0: only notes what acts.
struct FilmFlowPass {
  WallContacts walls;
  WallRows rows;
  Span<const Index> wall_row;   ///< of each grain, kNone: far from walls; empty: all are
  const ContactSum* by_grains;  ///< [grains]
  FilmAction* actions;          ///< [grains]
  EnergyFlow* flows;            ///< [grains]

  BL_HD void operator()(Index i) const {
    const GrainView& g = walls.grains;
    ContactSum sum = by_grains[i];
    FilmAction now{};
    const Index row = wall_row ? wall_row[i] : kNone;
    if (row != kNone)
      walls.each_film(
          i, rows.count[row], [&](Index k) { return rows(row, k); },
          [&](std::uint32_t body, const WallContacts::Contact& c) {
            sum.add({Vec3d(c.on_grain.force), Vec3d(c.on_grain.torque_i)});
            const BodyPose& pose = walls.poses[body];
            const Vec3d v_wall = walls.surface_velocity(pose, walls.arm(pose, c.point));
            now.by_walls +=
                dot(Vec3d(c.on_grain.force), v_wall) - dot(Vec3d(c.on_grain.torque_j), pose.omega);
          });
    now.force = Real3(sum.force), now.torque = Real3(sum.torque);
    const FilmAction before = actions[i];
    actions[i] = now;
    const double dt = walls.dt;
    if (!(dt > 0)) return;
    const Real3 v = g.v[i], omega = g.omega[i];
    const double by_walls = 0.5 * dt * (before.by_walls + now.by_walls);
    flows[i].of[EnergyFlow::walls] += by_walls;
    flows[i].of[EnergyFlow::films] += by_walls - 0.5 * dt * (before.power(v, omega) + now.power(v, omega));
  }
};

}  // namespace BL_SOLVER
