#pragma once
#include "kernels/contact/lubrication_pass.hpp"
#include "kernels/stress/pair_moment.hpp"

namespace bedload::inline BL_VARIANT {

/// Stress of the contacts between grains at their present velocities; histories are not changed.
struct ContactStressPass {
  ContactPass contacts;  ///< with dt = 0
  Span<PairMoment<>> out;

  BL_HD void operator()(Index i) const {
    PairMoment<> sum;
    contacts.list.each(i, [&](std::uint64_t slot, Index j) {
      if (!contacts.histories.touching[slot]) return;
      const bool first = contacts.id[i] < contacts.id[j];
      const Index lo = first ? i : j, hi = first ? j : i;  // as in ContactPass
      const Real R_lo = contacts.radius[lo], R_hi = contacts.radius[hi];
      const Vec3d r = contacts.frame.separation(contacts.x[lo], contacts.x[hi]);
      const double distance = norm(r), overlap = double(R_lo) + double(R_hi) - distance;
      if (!(overlap > 0)) return;
      const ContactGeometry at =
          sphere_contact(contacts.sphere(lo, R_lo), contacts.sphere(hi, R_hi), r, distance, overlap);
      ContactHistory h = contacts.histories[slot];
      sum.add(contacts
                  .law_of(lo, hi)(at, contacts.v[lo] - contacts.v[hi], contacts.omega[lo], contacts.omega[hi],
                                  0, h)
                  .force,
              Real3(r));
    });
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
      const bool first = films.id[i] < films.id[j];
      films.between(first ? i : j, first ? j : i,
                    [&](const ContactForce& f, const Vec3d& r) { sum.add(f.force, Real3(r)); });
    });
    out[i] = sum.times(Real(0.5));
  }
};

}  // namespace bedload::inline BL_VARIANT
