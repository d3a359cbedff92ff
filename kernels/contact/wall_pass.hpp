#pragma once
// Contacts of grains with walls.

#include "kernels/bodies/rigid_body.hpp"
#include "kernels/contact/contact_pass.hpp"
#include "kernels/contact/wall_contacts.hpp"

namespace bedload::inline BL_VARIANT {

/// Grains that walls may come to touch, with the surfaces that may, both ascending.
struct WallRows {
  Span<const Index> grain;                ///< [rows]
  const std::uint64_t* offset = nullptr;  ///< [rows + 1]
  const Index* surface = nullptr;
};

struct WallContacts {
  Frame frame;
  MassPerR3 mass_per_r3;
  Real dt;  ///< s
  Span<const Vec3d> x;
  Span<const Real3> v, omega;
  Span<const Real> radius;
  SurfaceSet walls;
  WallMemory* const* memory;  ///< [capacity][grains]
  Index* count;               ///< [grains], of them in use
  int capacity;               ///< walls that a grain may touch at once
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
  /// On a wall body, about its centre, N m.
  BL_HD Vec3d torque_on(std::uint32_t body, const Contact& c) const {
    return cross(arm(poses[body], c.point), c.on_wall()) + Vec3d(c.on_grain.torque_j);
  }
  BL_HD WallMemories memories(Index i) const { return {memory, count, i}; }
  BL_HD const ContactLaw& law(std::uint32_t body, Index i) const {
    return laws[body * materials + (mass_per_r3.material ? mass_per_r3.material[i] : 0)];
  }

  /// f(body, contact) for all that grain i touches of the surfaces `surface(k)`, ascending, k < n; `keep`:
  /// histories are advanced.
  template <class Surfaces, class F>
  BL_HD void each(Index i, Index n, Surfaces&& surface, bool keep, F&& f) const {
    const WallMemories remembered = memories(i);
    WallTouches touches(remembered, walls.surfaces.data, capacity);
    find(i, n, surface, double(radius[i]), touches);
    if (touches.size() > 0) {
      touches.settle();
      WallMemory next[kMostWallContacts];
      for (int k = 0; k < touches.size(); ++k) next[k] = touch_one(i, touches[k], remembered, f);
      if (keep)
        for (int k = 0; k < touches.size(); ++k) remembered[k] = next[k];
    }
    if (keep && remembered.count() != Index(touches.size())) count[i] = Index(touches.size());
  }
  /// The same for all walls from which fluid parts a wet grain, touched or not; not to be called without
  /// lubrication.
  template <class Surfaces, class F>
  BL_HD void each_film(Index i, Index n, Surfaces&& surface, F&& f) const {
    if (!(wetness[i] > 0)) return;
    const Real R = radius[i];
    WallTouches near(WallMemories{nullptr, nullptr, i}, walls.surfaces.data, kMostWallContacts);
    find(i, n, surface, double(R) + double(lubrication.range(R)), near);
    if (near.size() == 0) return;
    near.settle();
    for (int k = 0; k < near.size(); ++k) {
      const ClosestPoint& closest = near[k].closest;
      const BodyPose& pose = poses[near[k].body];
      const Vec3d point = x[i] - closest.distance * closest.normal;
      const NearSurfaces at{closest.normal, closest.distance - double(R), R, 1, Real(closest.distance), 0};
      ContactForce on_grain = lubrication(at, v[i] - Real3(surface_velocity(pose, arm(pose, point))),
                                          omega[i], Real3(pose.omega));
      on_grain.force *= wetness[i], on_grain.torque_i *= wetness[i], on_grain.torque_j *= wetness[i];
      f(near[k].body, Contact{on_grain, point});
    }
  }

 private:
  /// Collects what is within `range` of the centre of grain i, m.
  template <class Surfaces>
  BL_HD void find(Index i, Index n, Surfaces&& surface, double range, WallTouches& touches) const {
    const Vec3d at = x[i];
    for (Index k = 0; k < n; ++k) {
      const Index s = surface(k);
      const Surface& of = walls.surfaces[s];
      const BodyPose& pose = poses[of.body];
      if (!pose.present) continue;
      const SurfaceView view(of, pose, frame, at);
      const double reach = of.reach(range);
      if (view.beyond(walls, reach)) continue;
      view.each_closest_point(walls, reach, 1e-4 * double(radius[i]),
                              [&](const ClosestPoint& closest) { touches.add(s, closest, range); });
    }
  }
  /// r: from the body's centre, m.
  BL_HD static Vec3d surface_velocity(const BodyPose& pose, const Vec3d& r) {
    return pose.v + cross(pose.omega, r) + pose.rotation.rotate(pose.slide);
  }
  /// Of a place from the centre of a body, by the nearest image, m.
  BL_HD Vec3d arm(const BodyPose& pose, const Vec3d& point) const {
    return frame.nearest_image(point - pose.origin());
  }
  template <class F>
  BL_HD WallMemory touch_one(Index i, const WallTouch& touch, const WallMemories& remembered, F& f) const {
    const ClosestPoint& closest = touch.closest;
    const BodyPose& pose = poses[touch.body];
    ContactHistory h;
    if (touch.from != kNone) h = remembered[touch.from].history;
    h.overlap = std::abs(h.overlap);
    const Vec3d point = x[i] - closest.distance * closest.normal;
    const Sphere grain{radius[i], Real(mass_per_r3(i)) * cube(radius[i])};
    ContactGeometry at = touch_wall(grain, closest.normal, double(radius[i]) - closest.distance);
    const Vec3d r = arm(pose, point), v_wall = surface_velocity(pose, r);
    if (pose.free)
      at.m_star /= 1 + at.m_star * Real(free_bodies[pose.free - 1].inverse_effective_mass(pose.rotation, r,
                                                                                          closest.normal));
    const ContactForce on_grain =
        law(touch.body, i)(at, v[i] - Real3(v_wall), omega[i], Real3(pose.omega), dt, h);
    f(touch.body, Contact{on_grain, point});
    h.overlap *= closest.side;
    return {touch.key(), closest.normal, h};
  }
};

/// Sums over the wall contacts of each row's grain; advances their histories.
struct WallContactPass {
  WallContacts contacts;
  WallRows rows;
  ContactSum* sums;       ///< [rows]
  TouchLoads loads = {};  ///< where to record what the grains do to free bodies; may be none
  BL_HD void operator()(Index row) const {
    wait_for_loop_before();
    let_next_loop_begin();
    const Index i = rows.grain[row];
    const Index* surface = rows.surface + rows.offset[row];
    if (loads) loads.clear(i);
    ContactSum sum;
    contacts.each(
        i, Index(rows.offset[row + 1] - rows.offset[row]), [&](Index k) { return surface[k]; }, true,
        [&](std::uint32_t body, const WallContacts::Contact& c) {
          sum.add({Vec3d(c.on_grain.force), Vec3d(c.on_grain.torque_i)});
          if (loads && contacts.poses[body].free)
            loads.add(i, {c.on_wall(), contacts.torque_on(body, c), body});
        });
    sums[row] = sum;
  }
};

/// Adds what fluid between grains and walls does to the sums of each row.
struct WallFilmPass {
  WallContacts contacts;
  WallRows rows;
  ContactSum* sums;  ///< [rows]
  BL_HD void operator()(Index row) const {
    const Index* surface = rows.surface + rows.offset[row];
    contacts.each_film(
        rows.grain[row], Index(rows.offset[row + 1] - rows.offset[row]), [&](Index k) { return surface[k]; },
        [&](std::uint32_t, const WallContacts::Contact& c) {
          sums[row].add({Vec3d(c.on_grain.force), Vec3d(c.on_grain.torque_i)});
        });
  }
};

/// Surfaces that come within `beyond` of where a grain looks for them.
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
  Span<std::uint64_t> count;
  BL_HD void operator()(Index row) const {
    count[row] = 0;
    for (Index s = 0; s < near.walls.surfaces.size; ++s) count[row] += near(grain[row], s);
  }
};

struct FillWallsPass {
  WallNear near;
  WallRows rows;
  Index* surface;
  Span<Index> row_of;  ///< of each grain
  BL_HD void operator()(Index row) const {
    const Index i = rows.grain[row];
    std::uint64_t slot = rows.offset[row];
    for (Index s = 0; s < near.walls.surfaces.size; ++s)
      if (near(i, s)) surface[slot++] = s;
    row_of[i] = row;
  }
};

}  // namespace bedload::inline BL_VARIANT
