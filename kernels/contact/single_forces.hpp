#pragma once
// Forces of single contacts at the end of a substep, for those who look at them. The passes run before the
// contacts are evaluated and leave their histories as they are.

#include "kernels/contact/wall_pass.hpp"

namespace BL_SOLVER {

/// Of pairs, each in the row of its lower id.
struct SinglePairForces {
  ContactPass contacts;
  Real3* force;  ///< [slots], on the grain of lower id, N

  BL_HD void operator()(Index i) const {
    const GrainView& g = contacts.grains;
    contacts.list.each(i, [&](std::uint64_t slot, Index j) {
      if (g.id[i] < g.id[j]) force[slot] = between(i, j, slot);
    });
  }

 private:
  BL_HD Real3 between(Index i, Index j, std::uint64_t slot) const {
    const GrainView& g = contacts.grains;
    const Vec3d r = g.frame.separation(g.x[i], g.x[j]);
    const double reach = double(g.radius[i]) + double(g.radius[j]), distance = root(norm2(r));
    if (!(distance < reach)) return {};
    ContactHistory h;
    if (contacts.histories.touching[slot]) h = contacts.histories[slot];
    const Real3 v = g.v[i] - g.frame.seen(g.v[j], g.x[i], g.x[j]);
    const ContactGeometry at = sphere_contact(g.sphere(i), g.sphere(j), r, distance, reach - distance,
                                              double(contacts.dt) * Vec3d(v));
    return contacts.law_of(i, j)(at, v, g.omega[i], g.omega[j], contacts.dt, h).force;
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

}  // namespace BL_SOLVER
