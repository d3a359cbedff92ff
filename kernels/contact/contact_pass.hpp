#pragma once
// Contacts between grains. Both partners of a pair evaluate it, each seen from the lower to the higher id, so
// forces are opposite and histories equal to the last bit.

#include "bedload/neighbours/long_rows.hpp"
#include "bedload/parallel/overlap.hpp"
#include "kernels/contact/contact_loss.hpp"
#include "kernels/contact/grain_frame.hpp"
#include "kernels/contact/grain_mass.hpp"
#include "kernels/contact/lubrication.hpp"
#include "kernels/contact/pair_histories.hpp"
#include "kernels/contact/registry.hpp"

namespace BL_SOLVER {

/// Pairs of grains whose distance is below the sum of their radii, a skin and the range of what acts between
/// grains that do not touch; pairs within one clump are left out.
struct GrainNear {
  GrainFrame frame;
  Span<const Vec3d> x;
  Span<const Real> radius;
  Span<const std::uint32_t> clump;  ///< 0: none; empty without clumps
  double largest;                   ///< radius, m
  double skin;                      ///< m
  double range = 0;                 ///< of lubrication and of the laws, over R*
  double stretch = 1;               ///< of GrainFrame
  BL_HD Vec3d place(Index i) const { return frame.listed(x[i]); }
  BL_HD double reach(Index i) const {
    return stretch * (radius[i] + largest + skin + beyond(radius[i], largest));
  }
  BL_HD bool operator()(Index i, Index j) const {
    if (clump && clump[i] != 0 && clump[i] == clump[j]) return false;
    return i != j && closer(i, j, skin + beyond(radius[i], radius[j]));
  }
  BL_HD double beyond(double R_i, double R_j) const { return range * R_i * R_j / (R_i + R_j); }
  BL_HD bool closer(Index i, Index j, double gap) const {
    const double range = double(radius[i]) + double(radius[j]) + gap;
    return norm2(frame.separation(x[i], x[j])) < range * range;
  }
};

/// Sorts each row: pairs in contact when the list was built come first, so that the threads of a warp
/// evaluate contacts at the same time. Rows in pieces stay as they are.
struct ContactsFirstPass {
  GrainNear near;
  VerletListView list;
  LongRowsView long_rows;
  Index* entry;
  BL_HD void operator()(Index i) const {
    if (long_rows.cut(i)) return;
    std::uint32_t contacts = 0;
    list.each(i, [&](std::uint64_t slot, Index j) {
      if (!near.closer(i, j, 0)) return;
      Index& first = entry[list.slot(i, contacts++)];
      entry[slot] = first, first = j;
    });
  }
};

/// Copies histories into a new list, except of rows in pieces; entries are indices in the sorted store.
struct CarryHistoryPass {
  VerletListView from, to;
  LongRowsView long_rows;        ///< of `to`
  Span<const Index> order;       ///< former index of each grain; kNone if it had no row
  Span<const Id> former_id, id;  ///< by former and by present index
  PairHistories old_histories, histories;
  const OpenContact* old_losses = nullptr;  ///< by slot; null: not asked for
  OpenContact* losses = nullptr;
  BL_HD void operator()(Index i) const {
    const Index was_i = order[i];
    if (was_i == kNone || long_rows.cut(i)) return;
    from.each(was_i, [&](std::uint64_t old_slot, Index was_j) {
      if (!old_histories.touching[old_slot]) return;
      const Id partner = former_id[was_j];
      to.each(i, [&](std::uint64_t slot, Index j) {
        if (id[j] == partner) carry(old_slot, slot);
      });
    });
  }
  BL_HD void carry(std::uint64_t old_slot, std::uint64_t slot) const {
    histories.store(slot, old_histories[old_slot]);
    histories.touching[slot] = 1;
    if (losses) losses[slot] = old_losses[old_slot];
  }
};

/// The same of rows in pieces, over the entries that pieces may have. Both partners of a pair hold its
/// history: it is taken from that of the smaller grain, whose row is short, unless another rank has or had
/// it.
struct CarryLongHistoryPass {
  CarryHistoryPass rows;
  BL_HD void operator()(Index of_piece) const {
    const auto& [from, to, long_rows, order, former_id, id, old_histories, histories, old_losses, losses] =
        rows;
    const Index piece = of_piece / LongRowsView::kPiece, i = long_rows.row[piece];
    const std::uint32_t k = long_rows.begin(piece) + of_piece % LongRowsView::kPiece;
    if (order[i] == kNone || k >= to.count[i]) return;
    const std::uint64_t slot = to.slot(i, k);
    const Index j = to.entry[slot], was_j = j < order.size ? order[j] : kNone;
    const bool short_row = was_j != kNone;
    const Index row = short_row ? was_j : order[i];
    for (std::uint32_t n = 0; n < from.count[row]; ++n) {
      const std::uint64_t old_slot = from.slot(row, n);
      const Index was = from.entry[old_slot];
      if (short_row ? was != order[i] : former_id[was] != id[j]) continue;
      if (old_histories.touching[old_slot]) rows.carry(old_slot, slot);
      return;
    }
  }
};

/// Contact force and torque on a grain, N and N m.
template <class T>
struct ContactSumOf {
  Vec3<T> force, torque;

  BL_HD void add(const ContactSumOf& other) { force += other.force, torque += other.torque; }
};
using ContactSum = ContactSumOf<double>;
/// Of the pairs in a row or piece, whose forces are no more precise.
using PairSum = ContactSumOf<Real>;

/// Grains as contacts see them.
struct GrainView {
  GrainFrame frame;
  MassPerR3 mass_per_r3;
  Span<const Vec3d> x;
  Span<const Real3> v, omega;
  Span<const Real> radius;
  Span<const Id> id;

  BL_HD double mass(Index i) const { return mass_per_r3(i) * radius[i] * radius[i] * radius[i]; }
  BL_HD Sphere sphere(Index i, Real R) const { return {R, Real(mass_per_r3(i)) * cube(R)}; }
  BL_HD Sphere sphere(Index i) const { return sphere(i, radius[i]); }
};

struct ContactPass {
  GrainView grains;
  ContactLaw law;
  Real dt;  ///< s
  VerletListView list;
  PairHistories histories;
  Span<const Index> wall_row = {};  ///< of each grain in by_walls, kNone: far from walls; empty: all are
  const ContactSum* by_walls = nullptr;
  const ContactSum* by_films = nullptr;  ///< [grains], of the fluid between them; null: none
  const ContactLaw* laws = nullptr;      ///< [materials][materials]; null: `law` for all
  std::uint32_t materials = 1;
  bool acts = true;  ///< false: grains pass through each other
  LongRowsView long_rows = {};
  ContactSum* by_pieces = nullptr;  ///< [pieces] of these

  /// Index in `laws` of the law between two grains.
  BL_HD std::uint32_t pair_of(Index i, Index j) const {
    return grains.mass_per_r3.material[i] * materials + grains.mass_per_r3.material[j];
  }

  BL_HD const ContactLaw& law_of(Index i, Index j) const { return laws ? laws[pair_of(i, j)] : law; }
  /// Whether two grains act on each other; `touched`: they did in the substep before.
  template <class Law = ContactLaw>
  BL_HD bool meet(Index i, Index j, const SphereGap& gap, Real R_i, Real R_j, bool touched) const {
    if constexpr (Law::kApart)
      return law_of(i, j).acts(gap, R_i, R_j, touched);
    else
      return gap.overlaps();
  }

  /// A pair as those see it who look on: histories stay as they are.
  struct Seen {
    bool touched, acts;
    Vec3d r;                    ///< x_lo - x_hi, m
    Real3 v;                    ///< of lo to hi, m/s
    PairHistory before, after;  ///< of the substep
    ContactGeometry at;         ///< if it acts, as what follows
    ContactForce on_lo;
  };
  template <class Law = ContactLaw>
  BL_HD Seen look(Index lo, Index hi, std::uint64_t slot) const {
    const GrainView& g = grains;
    Seen pair{};
    pair.touched = histories.touching[slot];
    pair.r = g.frame.separation(g.x[lo], g.x[hi]);
    pair.v = g.v[lo] - g.frame.seen(g.v[hi], g.x[lo], g.x[hi]);
    if (pair.touched) pair.before = pair.after = histories[slot];
    const Real R_lo = g.radius[lo], R_hi = g.radius[hi];
    const SphereGap gap(pair.r, R_lo, R_hi);
    pair.acts = meet<Law>(lo, hi, gap, R_lo, R_hi, pair.touched);
    if (!pair.acts) return pair;
    pair.at = sphere_contact(g.sphere(lo, R_lo), g.sphere(hi, R_hi), pair.r, gap.distance, gap.overlap(),
                             Vec3d(dt * pair.v));
    pair.on_lo = composed<Law>(law_of(lo, hi))(pair.at, pair.v, g.omega[lo], g.omega[hi], dt, pair.after);
    return pair;
  }

  /// Sums over all contacts of the lane's row, and advances the histories of its pairs by dt.
  BL_HD ContactSum operator()(const Lane& lane) const {
    ContactSum sum = pairs<ContactLaw>(lane);
    add_others(lane.row, wall_row_of(lane.row), sum);
    return sum;
  }
  /// The contacts between grains alone, by the laws of type Law.
  template <class Law>
  BL_HD ContactSum pairs(const Lane& lane) const {
    const Index i = lane.row;
    if (!acts || long_rows.cut(i)) return {};
    PairSum sum;
    const Grain own = grain(i);
    list.each(lane, [&](std::uint64_t slot, Index j) { pair<Law>(own, j, slot, sum); });
    return whole(lane, sum);
  }
  /// The same of a piece of a long row.
  template <class Law>
  BL_HD ContactSum pairs_of_piece(const Lane& lane) const {
    PairSum sum;
    const Index i = long_rows.row[lane.row];
    const Grain own = grain(i);
    const std::uint32_t begin = long_rows.begin(lane.row);
    const std::uint32_t end = min_of(list.count[i], begin + LongRowsView::kPiece);
    for (std::uint32_t k = begin + lane.index; k < end; k += lane.count) {
      const std::uint64_t slot = list.slot(i, k);
      pair<Law>(own, list.entry[slot], slot, sum);
    }
    return whole(lane, sum);
  }
  /// Row of a grain in by_walls; kNone: it is far from walls.
  BL_HD Index wall_row_of(Index i) const { return wall_row ? wall_row[i] : kNone; }
  /// Adds forces of walls and lubrication films, and those of a long row; waits for the loops over these.
  BL_HD void add_others(Index i, Index row, ContactSum& sum) const {
    if (!acts) return;
    wait_for_loops_before();
    if (long_rows.cut(i))
      for (Index piece = long_rows.first[i]; piece < long_rows.first[i + 1]; ++piece)
        sum.add(by_pieces[piece]);
    if (row != kNone) sum.add(by_walls[row]);
    if (by_films) sum.add(by_films[i]);
  }

 private:
  struct Grain {
    Index i;
    Vec3d x;
    Real R;
    Real3 v, omega;
    Id id;
  };
  struct Other {
    Real3 v, omega;
    Id id = 0;
  };
  BL_HD Grain grain(Index i) const {
    return {i, grains.x[i], grains.radius[i], grains.v[i], grains.omega[i], grains.id[i]};
  }
  /// Of all lanes that share the row.
  BL_HD static ContactSum whole(const Lane& lane, PairSum& sum) {
    lane.combine(sum, [](PairSum& into, const PairSum& other) { into.add(other); });
    return {Vec3d(sum.force), Vec3d(sum.torque)};
  }
  BL_HD Other load(Index j) const { return {grains.v[j], grains.omega[j], grains.id[j]}; }
  /// By value: a reference would force both into memory.
  BL_HD static Real3 either(bool first, const Real3& a, const Real3& b) {
    return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
  }
  template <class Law>
  BL_HD void pair(const Grain& own, Index j, std::uint64_t slot, PairSum& sum) const {
    // load as early as a value is known to be needed: a pair then waits for memory only once
    const bool touched = histories.touching[slot];
    const Real R = grains.radius[j];
    const Vec3d x_j = grains.x[j];
    Other other;
    PairHistory h;
    if (touched) h = histories[slot], other = load(j);
    const Vec3d r = grains.frame.separation(own.x, x_j);
    const SphereGap gap(r, own.R, R);
    if (!meet<Law>(own.i, j, gap, own.R, R, touched)) {
      if (touched) histories.touching[slot] = 0;
      return;
    }
    if (!touched) other = load(j);
    const bool first = own.id < other.id;
    const Real3 v_j = grains.frame.seen(other.v, own.x, x_j), omega_j = other.omega;
    const Index lo = first ? own.i : j, hi = first ? j : own.i;
    const Real R_lo = first ? own.R : R, R_hi = first ? R : own.R;
    const Real3 v_rel = first ? own.v - v_j : v_j - own.v, omega_lo = either(first, own.omega, omega_j),
                omega_hi = either(first, omega_j, own.omega);
    const ContactGeometry at = sphere_contact(grains.sphere(lo, R_lo), grains.sphere(hi, R_hi),
                                              first ? r : -r, gap.distance, gap.overlap(), Vec3d(dt * v_rel));
    // most cases have one law, a kernel parameter in registers; a reference would force it into memory
    const Law acting = laws ? Law::of(laws[pair_of(lo, hi)]) : Law::of(law);
    const ContactForce f = acting(at, v_rel, omega_lo, omega_hi, dt, h);
    sum.add({first ? f.force : -f.force, either(first, f.torque_i, f.torque_j)});
    histories.store(slot, h);
    if (!touched) histories.touching[slot] = 1;
  }
};

/// Contacts of the pieces of long rows, of which each has several lanes; beside the loop over the walls.
template <class Law>
struct LongContactPass {
#if BL_CUDA
  static constexpr unsigned kLaneBits = 5;
#else
  static constexpr unsigned kLaneBits = 0;
#endif
  ContactPass contacts;
  BL_HD void operator()(Index thread) const {
    let_next_loop_begin();  // with the other rows, which waits for this one
    const Lane lane(thread, kLaneBits);
    const ContactSum sum = contacts.pairs_of_piece<Law>(lane);
    wait_for_loops_before();
    if (lane.index == 0) contacts.by_pieces[lane.row] = sum;
  }
};

}  // namespace BL_SOLVER
