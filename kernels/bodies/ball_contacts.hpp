#pragma once
// Free bodies against other bodies: balls fixed to one meet the surfaces of the others, with the contact laws
// of the grains. Both bodies are pushed at the same point.

#include "kernels/bodies/rigid_body.hpp"
#include "kernels/contact/contact_law.hpp"
#include "kernels/contact/wall_contacts.hpp"

namespace bedload::inline BL_VARIANT {

/// Contact law of a body and what its material gives to the moduli of a pair.
struct BodyMaterial {
  ContactLaw law;
  double give = 0, give_sideways = 0;  ///< (1 - nu^2)/E, (2 - nu)/G, 1/Pa
};

struct TouchBall {
  Vec3d x0;       ///< centre at t = 0, m
  double radius;  ///< m
  double R_star;  ///< m
  Index owner;    ///< among the free bodies
};

struct BallPass {
  Frame frame;
  SurfaceSet walls;
  const BodyPose* poses;
  const RigidBody* bodies;
  const BodyMaterial* materials;         ///< of the free bodies
  double wall_give, wall_give_sideways;  ///< of walls that are none, 1/Pa
  Span<const TouchBall> balls;
  WallMemory* const* memory;  ///< [room][balls]
  Index* contacts;            ///< [balls]
  int room;
  double dt;  ///< s
  TouchLoads loads;

  BL_HD void operator()(Index i) const {
    loads.clear(i);
    const TouchBall& ball = balls[i];
    const std::uint32_t own = bodies[ball.owner].body;
    const Vec3d x = poses[own].place(ball.x0);
    const WallMemories memories{memory, contacts, i};
    WallTouches touches(memories, walls.surfaces.data, room);
    for (Index s = 0; s < walls.surfaces.size; ++s) {
      const Surface& surface = walls.surfaces[s];
      const BodyPose& pose = poses[surface.body];
      if (surface.body == own || !pose.present || !poses[own].present || passes(pose)) continue;
      const double reach = surface.tracked() ? ball.radius : 2 * ball.radius;
      const SurfaceView view(surface, pose, frame, x);
      if (view.beyond(walls, reach)) continue;
      view.each_foot(walls, reach, 1e-4 * ball.radius,
                     [&](const Foot& foot) { touches.add(s, foot, ball.radius); });
    }
    if (touches.size() > 0) {
      touches.settle();
      WallMemory next[kMostWallContacts];
      for (int k = 0; k < touches.size(); ++k) next[k] = touch_one(i, ball, x, touches[k], memories);
      for (int k = 0; k < touches.size(); ++k) memories[k] = next[k];
    }
    contacts[i] = Index(touches.size());
  }

 private:
  /// Bodies that touch nobody.
  BL_HD bool passes(const BodyPose& pose) const { return pose.free && !bodies[pose.free - 1].touches; }
  BL_HD Vec3d arm(const BodyPose& pose, const Vec3d& point) const {
    return frame.nearest_image(point - pose.origin());
  }
  BL_HD WallMemory touch_one(Index i, const TouchBall& ball, const Vec3d& x, const WallTouch& touch,
                             const WallMemories& memories) const {
    const Foot& foot = touch.foot;
    const RigidBody& a = bodies[ball.owner];
    const BodyPose &mine = poses[a.body], &other = poses[touch.body];
    ContactHistory h;
    if (touch.from != kNone) h = memories[touch.from].history;
    h.overlap = std::abs(h.overlap);

    const Vec3d point = x - foot.distance * foot.normal;
    const Vec3d r_mine = arm(mine, point), r_other = arm(other, point);
    double ease = a.ease(mine.rotation, r_mine, foot.normal);
    double give = wall_give, give_sideways = wall_give_sideways;
    if (other.free) {
      ease += bodies[other.free - 1].ease(other.rotation, r_other, foot.normal);
      give = materials[other.free - 1].give, give_sideways = materials[other.free - 1].give_sideways;
    }
    const BodyMaterial& m = materials[ball.owner];
    ContactLaw law = m.law;
    law.hertz.E_star = Real(1 / (m.give + give));
    law.mindlin.G_star = Real(1 / (m.give_sideways + give_sideways));
    // a push that no constraint lets through meets a mass without end, for which no damping is left
    const double m_star = 1 / max_of(ease, 1e-6 / a.mass);
    ContactGeometry at{foot.normal, ball.radius - foot.distance, Real(ball.R_star), Real(m_star), 0, 0, 0, 0};
    if (law.rolling != RollingLaw::none) {
      Vec3d about = mine.omega - other.omega;
      about -= dot(about, foot.normal) * foot.normal;
      const double spin = norm(about);
      if (spin > 0) about *= 1 / spin;
      double turning = a.turning_ease(mine.rotation, about),
             rolling = a.rolling_ease(mine.rotation, r_mine, about);
      if (other.free) {
        const RigidBody& b = bodies[other.free - 1];
        turning += b.turning_ease(other.rotation, about);
        rolling += b.rolling_ease(other.rotation, r_other, about);
      }
      // neither matters where nothing turns, but must not be 0
      at.inverse_spin = max_of(Real(turning), Real(1e-20));
      at.inverse_rolling = max_of(Real(rolling), Real(1e-20));
    }
    const Vec3d v = mine.v + cross(mine.omega, r_mine) - other.v - cross(other.omega, r_other);
    const ContactForce f = law(at, Real3(v), Real3(mine.omega), Real3(other.omega), Real(dt), h);
    const Vec3d force = Vec3d(f.force), couple = Vec3d(f.torque_i);  // that of rolling friction
    loads.add(i, {force, cross(r_mine, force) + couple, a.body});
    loads.add(i, {-force, -cross(r_other, force) - couple, touch.body});
    h.overlap *= foot.side;
    return {touch.key(), foot.normal, h};
  }
};

}  // namespace bedload::inline BL_VARIANT
