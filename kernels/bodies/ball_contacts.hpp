#pragma once
// Free bodies against other bodies: balls fixed to one meet the surfaces of the others, with the contact laws
// of the grains. Both bodies are pushed at the same point. Where two balls overlap each of them meets the
// surface of the other's body, so that one contact is found twice; either then pushes with half its force.

#include "bedload/case/materials.hpp"
#include "kernels/bodies/rigid_body.hpp"
#include "kernels/contact/registry.hpp"
#include "kernels/contact/wall_contacts.hpp"

namespace bedload::inline BL_VARIANT {

struct TouchBall {
  Vec3d x0;       ///< centre at t = 0, m
  double radius;  ///< m
  double R_star;  ///< m
  Index owner;    ///< among the free bodies
};

/// Of free bodies: the grains' way to resist rolling beside Hertz and Mindlin.
using BodyLaw = ContactLawOf<Hertz, Mindlin, RollingLaws::Any>;

struct BallPass {
  Frame frame;
  SurfaceSet walls;
  const BodyPose* poses;
  const RigidBody* bodies;
  const BodyLaw* laws;                   ///< of the free bodies
  const ElasticCompliance* compliances;  ///< of all wall bodies
  Span<const TouchBall> balls;
  WallMemory* const* memory;  ///< [capacity][balls]
  Index* contacts;            ///< [balls]
  int capacity;
  double dt;  ///< s
  TouchLoads loads;

  BL_HD void operator()(Index i) const {
    loads.clear(i);
    const TouchBall& ball = balls[i];
    const std::uint32_t own = bodies[ball.owner].body;
    const Vec3d x = poses[own].place(ball.x0);
    const WallMemories memories{memory, contacts, i};
    WallTouches<> touches(memories, walls.surfaces.data, capacity);
    for (Index s = 0; s < walls.surfaces.size; ++s) {
      const Surface& surface = walls.surfaces[s];
      const BodyPose& pose = poses[surface.body];
      if (surface.body == own || !pose.present || !poses[own].present || passes(pose)) continue;
      const double reach = surface.reach(ball.radius);
      const SurfaceView view(surface, pose, frame, x);
      if (view.beyond(walls, reach)) continue;
      view.each_closest_point(walls, reach, 1e-4 * ball.radius,
                              [&](const ClosestPoint& closest) { touches.add(s, closest, ball.radius); });
    }
    if (touches.size() > 0) {
      touches.settle();
      WallMemory next[kMostWallContacts];
      for (int k = 0; k < touches.size(); ++k)
        next[k] = touch_one(i, ball, x, touches[k], taken_over(ball, touches, touches[k], memories));
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
  /// R* of the ball of `other` that overlaps most with this one at x, m; 0 if none does.
  BL_HD double ball_opposite(const TouchBall& ball, const Vec3d& x, const BodyPose& other) const {
    double most = 0, R_star = 0;
    for (Index j = 0; j < balls.size; ++j) {
      const TouchBall& b = balls[j];
      if (b.owner != other.free - 1) continue;
      const double overlap = ball.radius + b.radius - norm(frame.nearest_image(other.place(b.x0) - x));
      if (overlap > most) most = overlap, R_star = b.R_star;
    }
    return R_star;
  }
  /// Between the body of a ball and another one.
  BL_HD BodyLaw law(const TouchBall& ball, std::uint32_t other) const {
    const ElasticCompliance &a = compliances[bodies[ball.owner].body], &b = compliances[other];
    BodyLaw out = laws[ball.owner];
    out.normal.E_star = Real(1 / (a.normal + b.normal));
    out.sliding.G_star = Real(1 / (a.tangential + b.tangential));
    return out;
  }
  /// What a touch remembers, perhaps of another body that the ball has left for this one.
  BL_HD ContactHistory taken_over(const TouchBall& ball, const WallTouches<>& touches, const WallTouch& touch,
                                  const WallMemories& memories) const {
    if (touch.from == kNone) return {};
    const WallMemory& memory = memories[touch.from];
    const std::uint32_t left = touches.body_of(memory);
    ContactHistory h = memory.history;
    if (left != touch.body)
      law(ball, touch.body).take_over(law(ball, left), Real(ball.R_star), Real(bodies[ball.owner].mass), h);
    return h;
  }
  BL_HD WallMemory touch_one(Index i, const TouchBall& ball, const Vec3d& x, const WallTouch& touch,
                             ContactHistory h) const {
    const ClosestPoint& closest = touch.closest;
    const RigidBody& a = bodies[ball.owner];
    const BodyPose &mine = poses[a.body], &other = poses[touch.body];
    h.overlap = std::abs(h.overlap);

    const Vec3d point = x - closest.distance * closest.normal;
    const Vec3d r_mine = arm(mine, point), r_other = arm(other, point);
    double inverse_mass = a.inverse_effective_mass(mine.rotation, r_mine, closest.normal);
    if (other.free)
      inverse_mass += bodies[other.free - 1].inverse_effective_mass(other.rotation, r_other, closest.normal);
    const BodyLaw acting = law(ball, touch.body);
    const double opposite = other.free ? ball_opposite(ball, x, other) : 0;
    const double R_star = opposite > 0 ? 1 / (1 / ball.R_star + 1 / opposite) : ball.R_star;
    const double weight = opposite > 0 ? 0.5 : 1;
    // a push that no constraint lets through meets a mass without end, for which no damping is left
    const double m_star = 1 / max_of(inverse_mass, 1e-6 / a.mass);
    ContactGeometry at{
        closest.normal, ball.radius - closest.distance, Real(R_star), Real(m_star), 0, 0, 0, 0};
    if (acting.rolls()) {
      Vec3d about = mine.omega - other.omega;
      about -= dot(about, closest.normal) * closest.normal;
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
    const ContactForce f = acting(at, Real3(v), Real3(mine.omega), Real3(other.omega), Real(dt), h);
    const Vec3d force = weight * Vec3d(f.force);
    const Vec3d couple = weight * Vec3d(f.torque_i);  // that of rolling friction
    loads.add(i, {force, cross(r_mine, force) + couple, a.body});
    loads.add(i, {-force, -cross(r_other, force) - couple, touch.body});
    h.overlap *= closest.side;
    return {touch.key(), closest.normal, h};
  }
};

}  // namespace bedload::inline BL_VARIANT
