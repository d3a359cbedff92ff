#pragma once
// Sums and extremes over grains, for reduce(). Values are plain arrays: shared memory runs no constructors.

#include "kernels/contact/wall_pass.hpp"

namespace BL_SOLVER {

BL_HD bool finite(const Vec3d& a) {
  const double s = a.x * 0 + a.y * 0 + a.z * 0;
  return s == 0;
}

/// Largest speed2, displacement2, drag_coefficient / mass, and the smallest id of a grain whose state is not
/// finite.
struct WatchReduction {
  struct Value {
    double speed2, displacement2, drag_rate, bad;
  };
  GrainView grains;
  Span<const Vec3d> x_list;
  Span<const Real> drag_coefficient;

  BL_HD Value identity() const { return {0, 0, 0, double(kNone)}; }
  BL_HD Value operator()(Index i) const {
    const Vec3d x = grains.x[i], u = Vec3d(grains.v[i]);
    const bool good = finite(x) && finite(u) && finite(Vec3d(grains.omega[i]));
    if (!good) return {0, 0, 0, double(grains.id[i])};
    return {norm2(u), norm2(grains.frame.nearest_image(x - x_list[i])),
            double(drag_coefficient[i]) / grains.mass(i), double(kNone)};
  }
  BL_HD void combine(Value& a, const Value& b) const {
    a.speed2 = max_of(a.speed2, b.speed2);
    a.displacement2 = max_of(a.displacement2, b.displacement2);
    a.drag_rate = max_of(a.drag_rate, b.drag_rate);
    a.bad = min_of(a.bad, b.bad);
  }
};

/// Conserved sums, energies, contacts. Each partner of a pair counts half of it.
struct TotalsReduction {
  enum Sum { mass, kinetic, rotational, elastic, px, py, pz, lx, ly, lz, cx, cy, cz, pairs, on_walls, kSums };
  struct Value {
    double sum[kSums];
    double speed2, overlap;  ///< largest
  };
  ContactPass contacts;
  WallContacts walls;
  Span<const std::uint32_t> clump;  ///< of each grain, 0: none; the motion of those of clumps is not counted

  BL_HD Value identity() const {
    Value v{};
    return v;
  }
  /// Half of what a pair in contact stores, J.
  BL_HD double share(Index i, Index j, const ContactHistory& h) const {
    const Sphere s = contacts.grains.sphere(i), o = contacts.grains.sphere(j);
    return 0.5 * contacts.law_of(i, j).stored(s.R * o.R / (s.R + o.R), s.m * o.m / (s.m + o.m), h);
  }
  BL_HD Value operator()(Index i) const {
    Value t{};
    const GrainView& g = contacts.grains;
    const Sphere s = g.sphere(i);
    const double m = clump && clump[i] > 0 ? 0 : double(s.m), inertia = 0.4 * m * s.R * s.R;
    const Vec3d v = Vec3d(g.v[i]), w = Vec3d(g.omega[i]), x = g.x[i];
    const Vec3d angular = cross(x, m * v) + inertia * w;
    t.sum[mass] = m;
    t.sum[kinetic] = 0.5 * m * norm2(v);
    t.sum[rotational] = 0.5 * inertia * norm2(w);
    t.sum[px] = m * v.x, t.sum[py] = m * v.y, t.sum[pz] = m * v.z;
    t.sum[lx] = angular.x, t.sum[ly] = angular.y, t.sum[lz] = angular.z;
    t.sum[cx] = m * x.x, t.sum[cy] = m * x.y, t.sum[cz] = m * x.z;
    t.speed2 = norm2(v);
    contacts.list.each(i, [&](std::uint64_t slot, Index j) {
      if (!contacts.histories.touching[slot]) return;
      const ContactHistory h = contacts.histories[slot];
      t.sum[pairs] += 0.5;
      t.sum[elastic] += share(i, j, h);
      t.overlap = max_of(t.overlap, h.overlap / (2 * double(s.R)));
    });
    const WallMemories memory = walls.memories(i);
    for (Index k = 0; k < memory.count(); ++k) {
      const ContactHistory& h = memory[k].history;
      const std::uint32_t body = walls.walls.surfaces[memory[k].surface()].body;
      t.sum[on_walls] += 1;
      const ContactLaw& law = walls.law(body, i);
      t.sum[elastic] += law.stored(s.R, s.m, h);
      t.overlap = max_of(t.overlap, law.last_overlap(h) / (2 * double(s.R)));
    }
    return t;
  }
  BL_HD void combine(Value& a, const Value& b) const {
    for (int k = 0; k < kSums; ++k) a.sum[k] += b.sum[k];
    a.speed2 = max_of(a.speed2, b.speed2);
    a.overlap = max_of(a.overlap, b.overlap);
  }
};

/// Its sums alone.
struct TotalSums {
  struct Value {
    double sum[TotalsReduction::kSums];
  };
  TotalsReduction of;

  BL_HD Value identity() const {
    Value v{};
    return v;
  }
  BL_HD Value operator()(Index i) const {
    const TotalsReduction::Value all = of(i);
    Value v;
    for (int k = 0; k < TotalsReduction::kSums; ++k) v.sum[k] = all.sum[k];
    return v;
  }
  BL_HD void combine(Value& a, const Value& b) const {
    for (int k = 0; k < TotalsReduction::kSums; ++k) a.sum[k] += b.sum[k];
  }
};

/// Load of the grains on one wall body in a substep of contacts.dt; histories are not changed.
struct BodyLoadReduction {
  using Value = LoadSum;
  WallContacts contacts;
  std::uint32_t body;

  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index i) const {
    return by_grain(i, contacts.walls.surfaces.size, [](Index s) { return s; });
  }
  BL_HD void combine(Value& into, const Value& from) const { Value::combine(into, from); }

  /// By grain i, among the surfaces surface(k), k < n.
  template <class Surfaces>
  BL_HD Value by_grain(Index i, Index n, Surfaces&& surface) const {
    Value sum = Value::zero();
    const auto add = [&](std::uint32_t of, const WallContacts::Contact& c) {
      if (of == body) sum.add(c.on_wall(), contacts.torque_on(body, c));
    };
    if (contacts.lubrication.acts()) contacts.each_film(i, n, surface, add);
    // a contact that begins in the substep is not remembered yet
    if (contacts.dt > 0 || contacts.memories(i).count() > 0)
      contacts.each(Lane(i, 0), i, n, surface, false, add);
    return sum;
  }
};

/// The same over the grains near walls, with the surfaces listed for each.
struct ListedLoadReduction {
  using Value = LoadSum;
  BodyLoadReduction load;
  WallRows rows;

  BL_HD Value identity() const { return Value::zero(); }
  BL_HD Value operator()(Index row) const {
    return load.by_grain(rows.grain[row], rows.count[row], [&](Index k) { return rows(row, k); });
  }
  BL_HD void combine(Value& into, const Value& from) const { Value::combine(into, from); }
};

}  // namespace BL_SOLVER
