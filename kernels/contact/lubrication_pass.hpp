#pragma once
#include "kernels/contact/contact_pass.hpp"

namespace BL_SOLVER {

/// Lubrication between grains, scaled by the wetness of the drier one. Both partners evaluate a pair, ordered
/// from the lower to the higher id. Runs over the threads that share the rows of the list.
struct LubricationPass {
  GrainView grains;
  Lubrication law;
  Span<const Real> wetness;
  VerletListView list;
  ContactSum* sums;  ///< [grains]

  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, list.bits);
    const Index i = lane.row;
    ContactSum sum;
    if (wetness[i] > 0) list.each(lane, [&](std::uint64_t, Index j) { pair(i, j, sum); });
    lane.combine(sum, [](ContactSum& into, const ContactSum& other) { into.add(other); });
    if (lane.index == 0) sums[i] = sum;
  }

  /// f(force on lo, x_lo - x_hi) of the two grains, ordered by id, if there is a film between them.
  template <class F>
  BL_HD void between(Index lo, Index hi, F&& f) const {
    const auto& [frame, mass, x, v, omega, radius, id] = grains;
    const Real R_lo = radius[lo], R_hi = radius[hi], wet = min_of(wetness[lo], wetness[hi]);
    const Vec3d r = frame.separation(x[lo], x[hi]);
    const double range = double(R_lo) + double(R_hi) + double(law.range(R_lo * R_hi / (R_lo + R_hi)));
    const double r2 = norm2(r);
    if (!(wet > 0) || !(r2 < range * range)) return;
    const NearSurfaces at = NearSurfaces::spheres(R_lo, R_hi, r, std::sqrt(r2));
    ContactForce force = law(at, v[lo] - frame.seen(v[hi], x[lo], x[hi]), omega[lo], omega[hi]);
    force.force *= wet, force.torque_i *= wet, force.torque_j *= wet;
    f(force, r);
  }

 private:
  BL_HD void pair(Index i, Index j, ContactSum& sum) const {
    const bool first = grains.id[i] < grains.id[j];
    between(first ? i : j, first ? j : i, [&](const ContactForce& f, const Vec3d&) {
      sum.force += Vec3d(first ? f.force : -f.force);
      sum.torque += Vec3d(first ? f.torque_i : f.torque_j);
    });
  }
};

}  // namespace BL_SOLVER
