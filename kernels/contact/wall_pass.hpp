#pragma once
// Contacts of grains with walls.

#include <type_traits>

#include "kernels/bodies/rigid_body.hpp"
#include "kernels/contact/contact_pass.hpp"
#include "kernels/contact/wall_contacts.hpp"

namespace BL_SOLVER {

/// Grains that may get into contact with walls, and with which surfaces, both ascending. The first surfaces
/// of all rows are contiguous, then the second ones.
struct WallRows {
  Span<const Index> grain;               ///< [rows]
  const std::uint32_t* count = nullptr;  ///< [rows], of their surfaces
  const Index* entry = nullptr;          ///< [largest count][rows]
  BL_HD Index operator()(Index row, Index k) const { return entry[std::uint64_t(k) * grain.size + row]; }
};

/// What a pass over walls is compiled for.
template <class ContactLaws, class SurfaceKinds, bool free>
struct WallScope {
  using Law = ContactLaws;
  using Kinds = SurfaceKinds;
  static constexpr bool kFree = free;  ///< bodies that grains may move
};
using AnyWalls = WallScope<ContactLaw, AllKinds, true>;

struct WallContacts {
  GrainView grains;
  Real dt;  ///< s
  SurfaceSet walls;
  WallMemory* const* memory;  ///< [capacity][rows]
  const Index* row;           ///< [grains]
  Index* count;               ///< [grains], of memories in use
  int capacity;               ///< contacts of a grain with walls at once
  const ContactLaw* laws;     ///< [bodies][materials]
  std::uint32_t materials;
  const BodyPose* poses;  ///< [bodies]
  const RigidBody* free_bodies = nullptr;
  Lubrication lubrication = {};
  Span<const Real> wetness = {};  ///< for lubrication

  struct Contact {
    ContactForce on_grain;
    Vec3d point;                                                    ///< m
    BL_HD Vec3d on_wall() const { return -Vec3d(on_grain.force); }  ///< N
  };
  /// How a contact came about in a substep, for those who ask for it.
  struct Course {
    Index from;  ///< its place among the memories before; kNone: it is new
    const ContactGeometry& at;
    const Vec3d& v_wall;  ///< of the wall at the contact, m/s
    const ContactLaw& law;
    const ContactHistory& after;
  };
  /// On a wall body, about its centre, N m.
  BL_HD Vec3d torque_on(std::uint32_t body, const Contact& c) const {
    return cross(arm(poses[body], c.point), c.on_wall()) + Vec3d(c.on_grain.torque_j);
  }
  /// r: from the body's centre, m.
  BL_HD static Vec3d surface_velocity(const BodyPose& pose, const Vec3d& r) {
    return pose.v + cross(pose.omega, r) + (pose.turned() ? pose.rotation.rotate(pose.slide) : pose.slide);
  }
  /// From the centre of a body to a point, by the nearest image, m.
  BL_HD Vec3d arm(const BodyPose& pose, const Vec3d& point) const {
    return grains.frame.nearest_image(point - pose.origin());
  }
  BL_HD WallMemories memories(Index i) const { return {memory, count, i, row ? row[i] : i}; }
  BL_HD const ContactLaw& law(std::uint32_t body, Index i) const {
    return laws[body * materials + (grains.mass_per_r3.material ? grains.mass_per_r3.material[i] : 0)];
  }

  /// f(body, contact) for the lane's contacts of grain i with the surfaces `surface(k)`, ascending, k < n;
  /// the lanes of a grain share them. `keep`: histories are advanced.
  template <class Scope = AnyWalls, class Surfaces, class F>
  BL_HD void each(const Lane& lane, Index i, Index n, Surfaces&& surface, bool keep, F&& f) const {
    const Grain grain{grains.x[i], grains.v[i], grains.omega[i], grains.sphere(i)};
    SurfaceContacts<typename Scope::Kinds> found(memories(i), walls.surfaces.data, capacity);
    find<Scope::Law::kApart>(i, n, surface, double(grain.R()), found);
    found.resolve();
    if constexpr (Scope::Law::kApart) found.drop_apart(double(grain.R()));
    using Law = typename Scope::Law;
    found.each(
        lane, keep,
        [&](const SurfaceContact& contact, std::uint32_t left, ContactHistory& h) {
          composed<Law>(law(contact.body, i))
              .take_over(composed<Law>(law(left, i)), grain.R(), grain.sphere.m, h);
        },
        [&](const SurfaceContact& contact, WallMemory& memory) {
          evaluate<Scope>(grain, contact, law(contact.body, i), memory, f);
        });
  }
  /// f(contact) for the closest points of walls within `gap` (m) of grain i, in contact or not.
  template <class Surfaces, class F>
  BL_HD void each_near(Index i, Index n, Surfaces&& surface, double gap, F&& f) const {
    SurfaceContacts<> near(WallMemories{nullptr, nullptr, i}, walls.surfaces.data, kMostWallContacts);
    find<false>(i, n, surface, double(grains.radius[i]) + gap, near);
    if (near.size() == 0) return;
    near.resolve();
    for (int k = 0; k < near.size(); ++k) f(near[k]);
  }
  /// f(body, contact) for the lubrication films between a wet grain and all walls. Only with lubrication.
  template <class Surfaces, class F>
  BL_HD void each_film(Index i, Index n, Surfaces&& surface, F&& f) const {
    if (!(wetness[i] > 0)) return;
    each_near(i, n, surface, double(lubrication.range(grains.radius[i])),
              [&](const SurfaceContact& near) { f(near.body, film(i, near)); });
  }
  /// The film between a wet grain and a wall.
  BL_HD Contact film(Index i, const SurfaceContact& near) const {
    const Real R = grains.radius[i];
    const ClosestPoint& closest = near.closest;
    const BodyPose& pose = poses[near.body];
    const Vec3d point = grains.x[i] - closest.distance * closest.normal;
    const NearSurfaces at{.n = closest.normal,
                          .gap = closest.distance - double(R),
                          .R_star = R,
                          .skew = 1,
                          .arm_i = Real(closest.distance),
                          .arm_j = 0};
    ContactForce on_grain = lubrication(at, grains.v[i] - Real3(surface_velocity(pose, arm(pose, point))),
                                        grains.omega[i], Real3(pose.omega));
    on_grain.force *= wetness[i], on_grain.torque_i *= wetness[i], on_grain.torque_j *= wetness[i];
    return {on_grain, point};
  }
  /// Number of contacts of grain i that are left out, since the deepest `capacity` alone count.
  BL_HD Index dropped(Index i) const {
    const auto any = [](Index s) { return s; };
    return left_out(memories(i), walls.surfaces.data, capacity, [&](auto& found) {
      find<ContactLaw::kApart>(i, walls.surfaces.size, any, double(grains.radius[i]), found);
    });
  }

 private:
  struct Grain {
    Vec3d x;
    Real3 v, omega;
    Sphere sphere;
    BL_HD Real R() const { return sphere.R; }
  };
  /// Collects what is within `radius` (m) of the centre of grain i. apart: and what has touched it before, as
  /// far as its law reaches.
  template <bool apart, class Kinds, int kMost, class Surfaces>
  BL_HD void find(Index i, Index n, Surfaces&& surface, double radius,
                  SurfaceContacts<Kinds, kMost>& found) const {
    const Real R = grains.radius[i];
    const Vec3d x = grains.x[i];
    for (Index k = 0; k < n; ++k) {
      const Index s = surface(k);
      const std::uint32_t body = walls.surfaces[s].body;
      if (!poses[body].present) continue;
      double reach = radius;
      if constexpr (apart) reach += double(law(body, i).range() * R);
      found.seek(walls, s, poses[body], grains.frame, x, 1e-4 * double(R), radius, reach);
    }
  }
  template <class Scope, class F>
  BL_HD void evaluate(const Grain& grain, const SurfaceContact& contact, const ContactLaw& law,
                      WallMemory& memory, F& f) const {
    const ClosestPoint& closest = contact.closest;
    const BodyPose& pose = poses[contact.body];
    ContactHistory& h = memory.history;
    h.overlap = law.last_overlap(h);
    const Vec3d point = grain.x - closest.distance * closest.normal;
    const Vec3d r = arm(pose, point);
    ContactGeometry at =
        wall_contact(grain.sphere, memory.normal, closest.normal, Real(double(grain.R()) - closest.distance));
    // in the middle of the substep, as the velocity of the grain
    const Vec3d r_mid = r + closest.distance * (closest.normal - Vec3d(at.n_mid)) -
                        0.5 * double(dt) * (Vec3d(grain.v) - pose.v);
    const Vec3d v_wall = surface_velocity(pose, r_mid);
    if (Scope::kFree && pose.free)
      at.m_star /= 1 + at.m_star * Real(free_bodies[pose.free - 1].inverse_effective_mass(pose.rotation, r,
                                                                                          closest.normal));
    const ContactForce on_grain = composed<typename Scope::Law>(law)(at, grain.v - Real3(v_wall), grain.omega,
                                                                     Real3(pose.omega), dt, h);
    if constexpr (std::is_invocable_v<F&, std::uint32_t, const Contact&, const Course&>)
      f(contact.body, Contact{on_grain, point}, Course{contact.from, at, v_wall, law, h});
    else
      f(contact.body, Contact{on_grain, point});
    memory.normal = closest.normal;
  }
};

/// Sums over the wall contacts of each row's grain; advances their histories. Runs over the lanes that share
/// the rows.
template <class Scope>
struct WallContactPass {
  WallContacts contacts;
  WallRows rows;
  unsigned lane_bits;       ///< 0 with loads
  ContactSum* sums;         ///< [rows]
  ContactLoads loads = {};  ///< loads of the grains on free bodies; may be empty
  BL_HD void operator()(Index thread) const {
    const Lane lane(thread, lane_bits);
    const Index i = rows.grain[lane.row];
    if (Scope::kFree && loads) loads.clear(i);
    ContactSum sum;
    contacts.each<Scope>(
        lane, i, rows.count[lane.row], [&](Index k) { return rows(lane.row, k); }, true,
        [&](std::uint32_t body, const WallContacts::Contact& c) {
          sum.add({Vec3d(c.on_grain.force), Vec3d(c.on_grain.torque_i)});
          if (Scope::kFree && loads && contacts.poses[body].free)
            loads.add(i, {c.on_wall(), contacts.torque_on(body, c), body});
        });
    lane.combine(sum, [](ContactSum& into, const ContactSum& other) { into.add(other); });
    if (lane.index == 0) sums[lane.row] = sum;
  }
};

/// Adds lubrication between grains and walls to the sums of each row.
struct WallFilmPass {
  WallContacts contacts;
  WallRows rows;
  ContactSum* sums;  ///< [rows]
  BL_HD void operator()(Index row) const {
    contacts.each_film(
        rows.grain[row], rows.count[row], [&](Index k) { return rows(row, k); },
        [&](std::uint32_t, const WallContacts::Contact& c) {
          sums[row].add({Vec3d(c.on_grain.force), Vec3d(c.on_grain.torque_i)});
        });
  }
};

/// Surfaces within `beyond` of a grain's reach.
struct WallNear {
  Frame frame;
  SurfaceSet walls;
  const BodyPose* poses;  ///< [bodies]
  Span<const Vec3d> x;
  Span<const Real> radius;
  const Index* remembered;  ///< [grains], how many contacts
  double beyond;            ///< m

  BL_HD bool operator()(Index i, Index s) const {
    const Surface& surface = walls.surfaces[s];
    const SurfaceView view(surface, poses[surface.body], frame, x[i]);
    return walls.within(surface, view.local(), surface.reach(double(radius[i])) + beyond);
  }
  /// Whether a grain needs a row.
  BL_HD bool operator()(Index i) const {
    if (remembered[i] > 0) return true;
    for (Index s = 0; s < walls.surfaces.size; ++s)
      if ((*this)(i, s)) return true;
    return false;
  }
};

struct CountWallsPass {
  WallNear near;
  Span<const Index> grain;
  Span<std::uint32_t> count;
  BL_HD void operator()(Index row) const {
    count[row] = 0;
    for (Index s = 0; s < near.walls.surfaces.size; ++s) count[row] += near(grain[row], s);
  }
};

struct LargestCount {
  using Value = std::uint32_t;
  Span<const std::uint32_t> count;
  BL_HD Value identity() const { return 0; }
  BL_HD Value operator()(Index row) const { return count[row]; }
  BL_HD void combine(Value& a, const Value& b) const { a = max_of(a, b); }
};

struct FillWallsPass {
  WallNear near;
  WallRows rows;
  Index* entry;
  Span<Index> row_of;  ///< of each grain
  BL_HD void operator()(Index row) const {
    const Index i = rows.grain[row];
    std::uint64_t slot = row;
    for (Index s = 0; s < near.walls.surfaces.size; ++s)
      if (near(i, s)) entry[slot] = s, slot += rows.grain.size;
    row_of[i] = row;
  }
};

}  // namespace BL_SOLVER
