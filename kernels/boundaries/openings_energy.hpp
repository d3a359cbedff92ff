#pragma once
// Energy of grains that come in and that leave, and the contacts that end with those.

#include "kernels/boundaries/sinks.hpp"
#include "kernels/contact/contact_energy.hpp"
#include "kernels/integrate/grain_sums.hpp"

namespace BL_SOLVER {

/// Kinetic and rotational energy of grains, J; that of clumps is not their grains'.
struct MotionEnergy {
  GrainView grains;
  Span<const std::uint32_t> clump;  ///< of each grain, 0: none; empty without clumps

  BL_HD void operator()(Index i, double* out) const {
    if (clump && clump[i] > 0) return;
    const Sphere s = grains.sphere(i);
    out[0] = 0.5 * s.m * (norm2(Vec3d(grains.v[i])) + 0.4 * s.R * s.R * norm2(Vec3d(grains.omega[i])));
  }
};
/// The same of clumps, of which some may stay.
struct ClumpMotionEnergy {
  ClumpTotals clumps;
  Index first = 0;
  Span<const std::uint32_t> sink = {};  ///< [clumps]; empty: of all from the first on

  BL_HD void operator()(Index k, double* out) const {
    const Index c = first + k;
    if (sink && sink[c] == kStays) return;
    double all[ClumpTotals::kSums];
    clumps(c, all);
    out[0] = all[TotalsReduction::kinetic] + all[TotalsReduction::rotational];
  }
};

/// What leaves with grains: their motion and what is stored in their contacts, whose other partner may stay.
struct LeavingEnergy {
  TotalsReduction totals;
  Span<const std::uint32_t> sink;  ///< of grains and ghosts

  BL_HD void operator()(Index i, double* out) const {
    using T = TotalsReduction;
    if (sink[i] != kStays) {
      const T::Value all = totals(i);
      out[0] = all.sum[T::kinetic] + all.sum[T::rotational] + all.sum[T::elastic];
      return;
    }
    totals.contacts.list.each(i, [&](std::uint64_t slot, Index j) {
      if (sink[j] != kStays && totals.contacts.histories.touching[slot])
        out[0] += totals.share(i, j, totals.contacts.histories[slot]);
    });
  }
};

/// Enters contacts that end because a partner leaves, with what they have dissipated; each pair in the row of
/// its lower id.
struct EndContactsPass {
  ContactPass contacts;
  WallContacts walls;
  Span<const std::uint32_t> sink;  ///< of grains and ghosts
  OpenLosses losses;

  BL_HD void operator()(Index i) const {
    const GrainView& g = contacts.grains;
    contacts.list.each(i, [&](std::uint64_t slot, Index j) {
      const bool ends = sink[i] != kStays || sink[j] != kStays;
      if (ends && g.id[i] < g.id[j] && contacts.histories.touching[slot])
        losses.enter(g, i, j, losses.of_pairs[slot]);
    });
    if (sink[i] == kStays) return;
    const WallMemories memories = walls.memories(i);
    for (Index k = 0; k < memories.count(); ++k)
      losses.enter_at_wall(g, i, walls.walls.surfaces[memories[k].surface()].body, losses.at_walls[i].of[k],
                           losses.wall_peaks[i].of[k]);
  }
};

}  // namespace BL_SOLVER
