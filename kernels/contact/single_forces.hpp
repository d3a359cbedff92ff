#pragma once
// Forces of single contacts at the end of a substep, for those who look at them. The passes run before the
// contacts are evaluated and leave their histories as they are.

#include "kernels/contact/lubrication_pass.hpp"
#include "kernels/contact/wall_pass.hpp"

namespace BL_SOLVER {

/// Of pairs, each in the row of its lower id.
struct SinglePairForces {
  ContactPass contacts;
  Real3* force;  ///< [slots], on the grain of lower id, N

  BL_HD void operator()(Index i) const {
    const GrainView& g = contacts.grains;
    contacts.list.each(i, [&](std::uint64_t slot, Index j) {
      if (g.id[i] < g.id[j]) force[slot] = contacts.look(i, j, slot).on_lo.force;
    });
  }
};

/// Of walls, over the grains near them.
struct SingleWallForces {
  WallContacts contacts;
  WallRows rows;
  Real3* force;  ///< [capacity][grains], on the grain, in the order of the memories after the substep, N

  BL_HD void operator()(Index row) const {
    const Index i = rows.grain[row];
    std::size_t next = i;
    contacts.each(
        Lane(i, 0), i, rows.count[row], [&](Index k) { return rows(row, k); }, false,
        [&](std::uint32_t, const WallContacts::Contact& c) {
          force[next] = c.on_grain.force;
          next += contacts.grains.x.size;
        });
  }
};

/// Of lubrication between pairs, each in the row of its lower id.
struct SinglePairFilms {
  LubricationPass films;
  Real3* force;  ///< [slots], on the grain of lower id, N

  BL_HD void operator()(Index i) const {
    const Span<const Id> id = films.grains.id;
    films.list.each(i, [&](std::uint64_t slot, Index j) {
      if (!(id[i] < id[j])) return;
      force[slot] = {};
      films.between(i, j, [&](const ContactForce& f, const Vec3d&) { force[slot] = f.force; });
    });
  }
};

/// A closest point of a wall near a grain.
struct NearWall {
  Vec3d normal;
  double gap;         ///< m; negative: overlap
  std::uint64_t key;  ///< as that of a WallMemory
  Real3 film;         ///< of lubrication on the grain, N
  Index grain;
};

/// Walls near grains, over the grains near them.
struct NearWallsPass {
  WallContacts contacts;
  WallRows rows;
  double gap;    ///< m
  double range;  ///< of laws and lubrication, over the radius, where that is more
  NearWall* near;
  Index* count;  ///< [rows], of kMostWallContacts for each

  BL_HD void operator()(Index row) const {
    const Index i = rows.grain[row];
    const Real R = contacts.grains.radius[i];
    NearWall* const own = near + std::size_t(row) * kMostWallContacts;
    Index n = 0;
    contacts.each_near(
        i, rows.count[row], [&](Index k) { return rows(row, k); }, max_of(gap, range * double(R)),
        [&](const SurfaceContact& c) {
          Real3 film;
          if (contacts.lubrication.acts() && contacts.wetness[i] > 0)
            film = contacts.film(i, c).on_grain.force;
          own[n++] = {c.closest.normal, c.closest.distance - double(R), c.key(), film, i};
        });
    count[row] = n;
  }
};

}  // namespace BL_SOLVER
