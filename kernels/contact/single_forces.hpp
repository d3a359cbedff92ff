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

}  // namespace BL_SOLVER
