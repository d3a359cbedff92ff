#pragma once
// Fields of grains at points, by a kernel with which mass, momentum and their balances hold exactly
// [goldhirsch10, weinhart12].

#include <cmath>
#include <numbers>

#include "kernels/bodies/clumps.hpp"
#include "kernels/contact/contact_loss.hpp"
#include "kernels/contact/wall_pass.hpp"
#include "kernels/stress/contact_stress.hpp"

namespace BL_SOLVER {

/// Lucy's function in double precision, 105 / (16 pi h^3) (1 - 6 q^2 + 8 q^3 - 3 q^4), q = r / h [lucy77].
struct CoarseKernel {
  double h;     ///< its support, m
  double most;  ///< its value at 0, 1/m3

  explicit CoarseKernel(double h) : h(h), most(105 / (16 * std::numbers::pi * h * h * h)) {}
  BL_HD double W(double r2) const {
    const double q = std::sqrt(r2) / h;
    return q < 1 ? most * (1 + 3 * q) * cube(1 - q) : 0;
  }
  /// Mean of W(|d - s b|) over 0 <= s <= 1, 1/m3.
  BL_HD double along(const Vec3d& d, const Vec3d& b) const {
    const double length = std::sqrt(norm2(b));
    if (!(length > 0)) return W(norm2(d));
    const double nearest = dot(d, b) / length, a2 = max_of(norm2(d) - nearest * nearest, 0.0);
    if (!(a2 < h * h)) return 0;
    const double half = std::sqrt(h * h - a2);
    const double from = max_of(-nearest, -half), to = min_of(length - nearest, half);
    return from < to ? most * (integral(to, a2) - integral(from, a2)) / length : 0;
  }

 private:
  /// Of W / most along a line at the distance root(a2), from its point nearest to the centre on, m.
  BL_HD double integral(double along, double a2) const {
    const double u = along / h, A = a2 / (h * h), r = std::sqrt(A + u * u);
    double log = 0;  // of (u + r) / root(A), odd in u
    if (A > 1e-24) log = std::log((std::abs(u) + r) / std::sqrt(A));
    if (u < 0) log = -log;
    return h * (u * (1 - 6 * A - 3 * A * A) - 2 * (1 + A) * cube(u) - 0.6 * square(u) * cube(u) +
                u * r * (2 * u * u + 5 * A) + 3 * A * A * log);
  }
};

/// at + k_0 step[0] + k_1 step[1] + k_2 step[2], 0 <= k_n < count[n], the first step fastest.
struct FieldPoints {
  Frame frame;
  Vec3d at, step[3];
  Vec3d dual[3];  ///< dot(dual[n], step[m]) = (n == m)
  int count[3];

  /// f(number, point - x) of each point within `reach` (m) of x or of an image of it.
  template <class F>
  BL_HD void each_near(const Vec3d& x, double reach, F&& f) const {
    const Vec3d inside = frame.wrap(x);
    for (int n = 0; n < 27; ++n) {
      const int image[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      Vec3d from = at - inside;
      bool there = true;
      for (int k = 0; k < 3; ++k) {
        there = there && (image[k] == 0 || frame.periodic[k]);
        from[k] -= image[k] * frame.length[k];
      }
      if (!there) continue;
      int first[3], last[3];
      for (int k = 0; k < 3; ++k) {
        const double middle = -dot(from, dual[k]), beyond = reach * std::sqrt(norm2(dual[k]));
        first[k] = int(std::ceil(clamp(middle - beyond, 0.0, double(count[k]))));
        last[k] = int(std::floor(clamp(middle + beyond, -1.0, double(count[k] - 1))));
      }
      for (int c = first[2]; c <= last[2]; ++c)
        for (int b = first[1]; b <= last[1]; ++b)
          for (int a = first[0]; a <= last[0]; ++a) {
            const Vec3d d = from + double(a) * step[0] + double(b) * step[1] + double(c) * step[2];
            if (norm2(d) < reach * reach) f(Index(a + count[0] * (b + count[1] * c)), d);
          }
    }
  }
};

/// What acts on grains at points of contact.
struct GrainActions {
  ContactPass contacts;  ///< with dt = 0
  LubricationPass films;
  WallContacts walls;  ///< with dt = 0

  /// f(force on grain i, from its centre to the point, whether they touch), N, m. The points of both partners
  /// of a pair are one.
  template <class F>
  BL_HD void each(Index i, F&& f) const {
    const GrainView& g = contacts.grains;
    const auto pair = [&](Index j, bool first, const Real3& on_first, const Vec3d& r, bool touch) {
      const double R = g.radius[i], part = R / (R + double(g.radius[j]));
      f(Vec3d(first ? on_first : -on_first), (first ? -part : part) * r, touch);
    };
    if (contacts.acts)
      each_contact(contacts, i, [&](Index j, bool first, const Real3& force, const Vec3d& r) {
        pair(j, first, force, r, true);
      });
    if (films.law.acts())
      films.list.each(i, [&](std::uint64_t, Index j) {
        const bool first = g.id[i] < g.id[j];
        films.between(first ? i : j, first ? j : i,
                      [&](const ContactForce& c, const Vec3d& r) { pair(j, first, c.force, r, false); });
      });
    const auto surface = [](Index s) { return s; };
    const auto by_wall = [&](const WallContacts::Contact& c, bool touch) {
      f(Vec3d(c.on_grain.force), g.frame.nearest_image(c.point - g.x[i]), touch);
    };
    if (walls.lubrication.acts())
      walls.each_film(i, walls.walls.surfaces.size, surface,
                      [&](std::uint32_t, const WallContacts::Contact& c) { by_wall(c, false); });
    if (walls.memories(i).count() > 0)
      walls.each(Lane(i, 0), i, walls.walls.surfaces.size, surface, false,
                 [&](std::uint32_t, const WallContacts::Contact& c) { by_wall(c, true); });
  }
};

/// Mean stress in a grain by what acts on it, Pa: row k has component k of the force; tension is positive.
struct GrainStress {
  Real of[9];
};
template <>
struct FileType<GrainStress> {
  static constexpr Scalar scalar = FileType<Real>::scalar;
  static constexpr int components = 9;
};
struct GrainStressPass {
  GrainActions actions;
  VolumePerR3 volume_per_r3;
  Span<GrainStress> out;

  BL_HD void operator()(Index i) const {
    double moment[9] = {};
    actions.each(i, [&](const Vec3d& force, const Vec3d& way, bool) {
      for (int k = 0; k < 9; ++k) moment[k] += force[k / 3] * way[k % 3];
    });
    const double volume = volume_per_r3(i) * cube(double(actions.contacts.grains.radius[i]));
    for (int k = 0; k < 9; ++k) out[i].of[k] = Real(moment[k] / volume);
  }
};

/// Sums at a point, per m3 of kernel: volume, mass, momentum 3, momentum times velocity 6 and volume times
/// fabric 6 (xx, xy, xz, yy, yz, zz), force times the way to where it acts 9. A clump has all of its mass and
/// its velocity where its centre of mass is, from which forces on its grains act: what holds it together then
/// has no stress, and its momentum balances as that of a grain.
struct CoarseTerms {
  static constexpr int kVolume = 0, kMass = 1, kMomentum = 2, kFlow = 5, kFabric = 11, kStress = 17,
                       kSums = 26;
  GrainActions actions;
  MassPerR3 mass_per_r3;
  VolumePerR3 volume_per_r3;
  ClumpView clumps{};  ///< empty without clumps

  /// From where the terms of a grain are: its centre, or that of its clump.
  struct Origin {
    Vec3d x, lever;  ///< m; from there to the centre of the grain
    Index clump;     ///< kNone: without one
  };
  BL_HD Origin origin(Index i) const {
    const Vec3d& x = actions.contacts.grains.x[i];
    if (!clumps.clump || clumps.clump[i] == 0) return {x, {}, kNone};
    const Vec3d lever = clumps.lever(i);
    return {x - lever, lever, clumps.clump[i] - 1};
  }
  /// Of a contact of grain i, the way from its origin on: add(sum, value) of its terms; adds to its fabric.
  template <class Add>
  BL_HD static void contact(const Vec3d& force, const Vec3d& way, bool touch, double fabric[6], Add&& add) {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) add(kStress + 3 * a + b, force[a] * way[b]);
    if (touch) products(way * (1 / std::sqrt(norm2(way))), 1, fabric);
  }
  /// Of grain i itself, or what it is of its clump, whose volume its contacts count with.
  template <class Add>
  BL_HD void grain(Index i, Index clump, const double fabric[6], Add&& add) const {
    const double r3 = cube(double(actions.contacts.grains.radius[i]));
    const double m = mass_per_r3(i) * r3, volume = volume_per_r3(i) * r3;
    const double whole = clump == kNone ? volume : volume * clumps.mass(clump) / m;
    const Vec3d v = clump == kNone ? Vec3d(actions.contacts.grains.v[i]) : clumps.v[clump];
    double flow[6] = {};
    products(v, m, flow);
    add(kVolume, volume), add(kMass, m);
    for (int k = 0; k < 3; ++k) add(kMomentum + k, m * v[k]);
    for (int k = 0; k < 6; ++k) add(kFlow + k, flow[k]), add(kFabric + k, whole * fabric[k]);
  }

 private:
  BL_HD static void products(const Vec3d& v, double by, double out[6]) {
    out[0] += by * v.x * v.x, out[1] += by * v.x * v.y, out[2] += by * v.x * v.z;
    out[3] += by * v.y * v.y, out[4] += by * v.y * v.z, out[5] += by * v.z * v.z;
  }
};

/// The largest magnitude of each term of any grain. What is not a number counts as infinite.
struct LargestTerms {
  struct Value {
    double v[CoarseTerms::kSums];
  };
  CoarseTerms terms;
  BL_HD Value identity() const {
    Value z;
    for (double& v : z.v) v = 0;
    return z;
  }
  BL_HD Value operator()(Index i) const {
    Value out = identity();
    double fabric[6] = {};
    const auto add = [&](int sum, double value) {
      const double v = std::abs(value);
      out.v[sum] = max_of(out.v[sum], v < 1e300 ? v : 1e300);
    };
    const CoarseTerms::Origin from = terms.origin(i);
    terms.actions.each(i, [&](const Vec3d& force, const Vec3d& way, bool touch) {
      CoarseTerms::contact(force, from.lever + way, touch, fabric, add);
    });
    terms.grain(i, from.clump, fabric, add);
    return out;
  }
  BL_HD void combine(Value& into, const Value& from) const {
    for (int k = 0; k < CoarseTerms::kSums; ++k) into.v[k] = max_of(into.v[k], from.v[k]);
  }
};

/// Adds the terms of each grain to the points near it, as whole numbers, so that their order does not matter.
struct SpreadPass {
  CoarseTerms terms;
  CoarseKernel kernel;
  FieldPoints points;
  double scale[CoarseTerms::kSums];  ///< to units, of terms times W
  WideSum* sums;                     ///< [points][kSums]

  BL_HD void operator()(Index i) const {
    const CoarseTerms::Origin from = terms.origin(i);
    const Vec3d x = from.x;
    const double reach =
        kernel.h + std::sqrt(norm2(from.lever)) + double(terms.actions.contacts.grains.radius[i]);
    bool near = false;
    points.each_near(x, reach, [&](Index, const Vec3d&) { near = true; });
    if (!near) return;
    double fabric[6] = {};
    terms.actions.each(i, [&](const Vec3d& force, const Vec3d& to_point, bool touch) {
      const Vec3d way = from.lever + to_point;
      double value[9] = {};
      CoarseTerms::contact(force, way, touch, fabric,
                           [&](int sum, double of) { value[sum - CoarseTerms::kStress] = of; });
      points.each_near(x, reach, [&](Index point, const Vec3d& d) {
        const double W = kernel.along(d, way);
        for (int k = 0; k < 9; ++k) add(point, CoarseTerms::kStress + k, value[k] * W);
      });
    });
    points.each_near(x, kernel.h, [&](Index point, const Vec3d& d) {
      const double W = kernel.W(norm2(d));
      terms.grain(i, from.clump, fabric, [&](int sum, double value) { add(point, sum, value * W); });
    });
  }

 private:
  BL_HD void add(Index point, int sum, double value) const {
    if (value != 0) sums[std::size_t(point) * CoarseTerms::kSums + sum].add(whole(value * scale[sum]));
  }
};

}  // namespace BL_SOLVER
