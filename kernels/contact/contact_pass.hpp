#pragma once
// All contacts of one grain: its list, then the walls. Both partners of a pair evaluate it, each seen from
// the lower to the higher id, so forces are opposite and histories equal to the last bit.

#include "bedload/neighbours/verlet_list.hpp"
#include "kernels/bodies/rigid_body.hpp"
#include "kernels/contact/contact_law.hpp"
#include "kernels/contact/wall_contacts.hpp"

namespace bedload::inline BL_VARIANT {

/// Pairs of grains closer than the sum of their radii and a skin, but for those of one rigid group.
struct GrainNear {
  Frame frame;
  Span<const Vec3d> x;
  Span<const Real> radius;
  Span<const std::uint32_t> group;  ///< 0: none; empty without groups
  double largest;                   ///< radius, m
  double skin;                      ///< m
  BL_HD Vec3d place(Index i) const { return x[i]; }
  BL_HD double reach(Index i) const { return radius[i] + largest + skin; }
  BL_HD bool operator()(Index i, Index j) const {
    if (group && group[i] != 0 && group[i] == group[j]) return false;
    const double range = double(radius[i]) + double(radius[j]) + skin;
    return i != j && norm2(frame.separation(x[i], x[j])) < range * range;
  }
};

/// Takes history over into a new list; entries are places in the sorted store.
struct CarryHistoryPass {
  VerletListView from, to;
  Span<const Index> order;  ///< former place of each grain; kNone if it is new
  const ContactHistory* old_history;
  ContactHistory* history;
  BL_HD void operator()(Index i) const {
    const Index was_i = order[i];
    if (was_i == kNone) return;
    for (std::uint32_t k = 0; k < to.count[i]; ++k) {
      const Index was_j = order[to.entry[to.slot(i, k)]];
      ContactHistory h;
      for (std::uint32_t l = 0; l < from.count[was_i]; ++l)
        if (from.entry[from.slot(was_i, l)] == was_j) h = old_history[from.slot(was_i, l)];
      history[to.slot(i, k)] = h;
    }
  }
};

/// Everything that acts on grain i by touch.
struct ContactSum {
  Vec3d force;   ///< N
  Vec3d torque;  ///< N m
};

struct ContactPass {
  Frame frame;
  ContactLaw law;    ///< between grains
  Real mass_per_r3;  ///< 4/3 pi rho_s
  Real dt;           ///< s
  Span<const Vec3d> x;
  Span<const Real3> v, omega;
  Span<const Real> radius;
  Span<const Id> id;
  VerletListView list;
  ContactHistory* history;
  SurfaceSet walls;
  WallMemory* const* wall_memory;  ///< [wall_capacity][grains]
  Index* wall_contacts;            ///< [grains]
  int wall_capacity;               ///< walls that a grain may touch at once
  const ContactLaw* wall_laws;     ///< [bodies]
  const BodyPose* poses;           ///< [bodies]
  const RigidBody* free_bodies = nullptr;
  TouchLoads loads = {};  ///< where to record what the grains do to free bodies; may be none

  BL_HD Sphere sphere(Index i) const { return {radius[i], mass_per_r3 * cube(radius[i])}; }

  /// Sums over the contacts of i and advances their histories by dt.
  BL_HD ContactSum operator()(Index i) const {
    ContactSum sum;
    if (loads) loads.clear(i);
    if (law.normal == NormalLaw::none) return sum;
    const std::uint32_t n = list.count[i];
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint64_t slot = list.slot(i, k);
      pair(i, list.entry[slot], history[slot], sum);
    }
    if (walls.surfaces.size > 0)
      each_wall(i, true, [&](std::uint32_t body, const WallContact& c) {
        sum.force += Vec3d(c.on_grain.force);
        sum.torque += Vec3d(c.on_grain.torque_i);
        if (loads && poses[body].free) loads.add(i, {c.on_wall(), torque_on(body, c), body});
      });
    return sum;
  }

  struct WallContact {
    ContactForce on_grain;
    Vec3d point;                                                    ///< m
    BL_HD Vec3d on_wall() const { return -Vec3d(on_grain.force); }  ///< N
  };
  /// On a wall body, about its centre, N m.
  BL_HD Vec3d torque_on(std::uint32_t body, const WallContact& c) const {
    return cross(arm(poses[body], c.point), c.on_wall()) + Vec3d(c.on_grain.torque_j);
  }
  /// Of a place from the centre of a body, by the nearest image, m.
  BL_HD Vec3d arm(const BodyPose& pose, const Vec3d& point) const {
    return frame.nearest_image(point - pose.origin());
  }
  BL_HD WallMemories memories(Index i) const { return {wall_memory, wall_contacts, i}; }

  /// f(body, contact) for all that grain i touches of the walls; `keep`: histories are advanced.
  template <class F>
  BL_HD void each_wall(Index i, bool keep, F&& f) const {
    const WallMemories memory = memories(i);
    const double R = double(radius[i]);
    WallTouches touches(memory, walls.surfaces.data, wall_capacity);
    for (Index s = 0; s < walls.surfaces.size; ++s) {
      const Surface& surface = walls.surfaces[s];
      const BodyPose& pose = poses[surface.body];
      // a patch that holds a grain on its side may be behind its centre
      const double reach = surface.tracked() ? R : 2 * R;
      const SurfaceView view(surface, pose, frame, x[i]);
      if (!pose.present || view.beyond(walls, reach)) continue;
      view.each_closest_point(walls, reach, 1e-4 * R,
                              [&](const ClosestPoint& closest) { touches.add(s, closest, R); });
    }
    if (touches.size() > 0) {
      touches.settle();
      WallMemory next[kMostWallContacts];
      for (int k = 0; k < touches.size(); ++k) {
        next[k] = touch_one(i, touches[k], memory, f);
      }
      if (keep)
        for (int k = 0; k < touches.size(); ++k) memory[k] = next[k];
    }
    if (keep && memory.count() != Index(touches.size())) wall_contacts[i] = Index(touches.size());
  }

 private:
  template <class F>
  BL_HD WallMemory touch_one(Index i, const WallTouch& touch, const WallMemories& memory, F& f) const {
    const ClosestPoint& closest = touch.closest;
    const BodyPose& pose = poses[touch.body];
    ContactHistory h;
    if (touch.from != kNone) h = memory[touch.from].history;
    h.overlap = std::abs(h.overlap);
    const Vec3d point = x[i] - closest.distance * closest.normal;
    ContactGeometry at = touch_wall(sphere(i), closest.normal, double(radius[i]) - closest.distance);
    const Vec3d r = arm(pose, point),
                v_wall = pose.v + cross(pose.omega, r) + pose.rotation.rotate(pose.slide);
    if (pose.free)
      at.m_star /= 1 + at.m_star * Real(free_bodies[pose.free - 1].inverse_effective_mass(pose.rotation, r,
                                                                                          closest.normal));
    const ContactForce on_grain =
        wall_laws[touch.body](at, v[i] - Real3(v_wall), omega[i], Real3(pose.omega), dt, h);
    f(touch.body, WallContact{on_grain, point});
    h.overlap *= closest.side;
    return {touch.key(), closest.normal, h};
  }
  BL_HD void pair(Index i, Index j, ContactHistory& h, ContactSum& sum) const {
    const Vec3d r_ij = frame.separation(x[i], x[j]);
    const double reach = double(radius[i]) + double(radius[j]), r2 = norm2(r_ij);
    if (!(r2 < reach * reach)) {
      if (h.overlap != 0) h = {};
      return;
    }
    const bool first = id[i] < id[j];
    const Index lo = first ? i : j, hi = first ? j : i;
    const double distance = std::sqrt(r2);
    const ContactGeometry at =
        touch(sphere(lo), sphere(hi), first ? r_ij : -r_ij, distance, reach - distance);
    const ContactForce f = law(at, v[lo] - v[hi], omega[lo], omega[hi], dt, h);
    sum.force += Vec3d(first ? f.force : -f.force);
    sum.torque += Vec3d(first ? f.torque_i : f.torque_j);
  }
};

}  // namespace bedload::inline BL_VARIANT
