#pragma once
#include "kernels/contact/lubrication_pass.hpp"
#include "kernels/stress/pair_moment.hpp"

namespace BL_SOLVER {

/// f(j, whether grain i is the first of the pair, force on the first, x_first - x_second) of each contact of
/// grain i with another, at their present velocities; histories are not changed. contacts: with dt = 0.
template <class F>
BL_HD void each_contact(const ContactPass& contacts, Index i, F&& f) {
  contacts.list.each(i, [&](std::uint64_t slot, Index j) {
    if (!contacts.histories.touching[slot]) return;
    const GrainView& g = contacts.grains;
    const bool first = g.id[i] < g.id[j];
    const Index lo = first ? i : j, hi = first ? j : i;  // as in ContactPass
    const Real R_lo = g.radius[lo], R_hi = g.radius[hi];
    const Vec3d r = g.frame.separation(g.x[lo], g.x[hi]);
    const SphereGap gap(r, R_lo, R_hi);
    if (!gap.overlaps()) return;
    const ContactGeometry at =
        sphere_contact(g.sphere(lo, R_lo), g.sphere(hi, R_hi), r, gap.distance, gap.overlap());
    PairHistory h = contacts.histories[slot];
    const Real3 v_rel = g.v[lo] - g.frame.seen(g.v[hi], g.x[lo], g.x[hi]);
    f(j, first, contacts.law_of(lo, hi)(at, v_rel, g.omega[lo], g.omega[hi], 0, h).force, r);
  });
}

/// Stress of the contacts between grains.
struct ContactStressPass {
  ContactPass contacts;  ///< with dt = 0
  Span<PairMoment<>> out;

  BL_HD void operator()(Index i) const {
    PairMoment<> sum;
    each_contact(contacts, i,
                 [&](Index, bool, const Real3& force, const Vec3d& r) { sum.add(force, Real3(r)); });
    out[i] = sum.times(Real(0.5));
  }
};

/// Stress of lubrication between grains.
struct LubricationStressPass {
  LubricationPass films;  ///< its sums are not used
  Span<PairMoment<>> out;

  BL_HD void operator()(Index i) const {
    PairMoment<> sum;
    films.list.each(i, [&](std::uint64_t, Index j) {
      const bool first = films.grains.id[i] < films.grains.id[j];
      films.between(first ? i : j, first ? j : i,
                    [&](const ContactForce& f, const Vec3d& r) { sum.add(f.force, Real3(r)); });
    });
    out[i] = sum.times(Real(0.5));
  }
};

}  // namespace BL_SOLVER
