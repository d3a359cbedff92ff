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
    const bool first = contacts.grains.id[i] < contacts.grains.id[j];
    const ContactPass::Seen pair = contacts.look(first ? i : j, first ? j : i, slot);
    if (pair.acts) f(j, first, pair.on_lo.force, pair.r);
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
