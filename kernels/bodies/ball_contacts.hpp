#pragma once
// Contacts of free bodies with other bodies: balls fixed to one collide with the surfaces of the others, by
// the contact laws of the grains. The force acts on both bodies at the same point. Where two balls overlap,
// each collides with the surface of the other's body: one contact is found twice, and each counts half.

#include "bedload/case/materials.hpp"
#include "kernels/bodies/rigid_body.hpp"
#include "kernels/contact/registry.hpp"
#include "kernels/contact/wall_contacts.hpp"

namespace BL_SOLVER {

struct ContactBall {
  Vec3d x0;       ///< centre at t = 0, m
  double radius;  ///< m
  double R_star;  ///< m
  Index owner;    ///< among the free bodies
};

/// Contact law of free bodies: Hertz and Mindlin, with the rolling law of the grains.
using BodyLaw = ContactLawOf<Hertz, Mindlin, RollingLaws::Any>;

struct BallPass {
  Frame frame;
  SurfaceSet walls;
  const BodyPose* poses;
  const RigidBody* bodies;
  const BodyLaw* laws;                   ///< of the free bodies
  const ElasticCompliance* compliances;  ///< of all wall bodies
  Span<const ContactBall> balls;
  WallMemory* const* memory;  ///< [capacity][balls]
  Index* contacts;            ///< [balls]
  int capacity;
  double dt;  ///< s
  ContactLoads loads;

  BL_HD void operator()(Index i) const {
    loads.clear(i);
    const ContactBall& ball = balls[i];
    const Vec3d x = centre(ball);
    const WallMemories memories{memory, contacts, i};
    SurfaceContacts<> found(memories, walls.surfaces.data, capacity);
    find(ball, x, found);
    if (found.size() > 0) {
      found.resolve();
      WallMemory next[kMostWallContacts];
      for (int k = 0; k < found.size(); ++k)
        next[k] = evaluate(i, ball, x, found[k], taken_over(ball, found, found[k], memories));
      for (int k = 0; k < found.size(); ++k) memories[k] = next[k];
    }
    contacts[i] = Index(found.size());
  }
  /// Number of contacts of a ball that are left out, since the deepest `capacity` alone count.
  BL_HD Index dropped(Index i) const {
    return left_out({memory, contacts, i}, walls.surfaces.data, capacity,
                    [&](auto& found) { find(balls[i], centre(balls[i]), found); });
  }

 private:
  BL_HD Vec3d centre(const ContactBall& ball) const { return poses[bodies[ball.owner].body].place(ball.x0); }
  /// Collects what a ball at x touches.
  template <int kMost>
  BL_HD void find(const ContactBall& ball, const Vec3d& x, SurfaceContacts<AllKinds, kMost>& found) const {
    const std::uint32_t own = bodies[ball.owner].body;
    for (Index s = 0; s < walls.surfaces.size; ++s) {
      const Surface& surface = walls.surfaces[s];
      const BodyPose& pose = poses[surface.body];
      if (surface.body == own || !pose.present || !poses[own].present || passes(pose)) continue;
      const double reach = surface.reach(ball.radius);
      const SurfaceView view(surface, pose, frame, x);
      if (view.beyond(walls, reach)) continue;
      view.each_closest_point(walls, reach, 1e-4 * ball.radius,
                              [&](const ClosestPoint& closest) { found.add(s, closest, ball.radius); });
    }
  }
  /// Bodies without contacts.
  BL_HD bool passes(const BodyPose& pose) const { return pose.free && !bodies[pose.free - 1].contacts; }
  BL_HD Vec3d arm(const BodyPose& pose, const Vec3d& point) const {
    return frame.nearest_image(point - pose.origin());
  }
  /// R* of the ball of `other` that overlaps most with this one at x, m; 0 if none does.
  BL_HD double ball_opposite(const ContactBall& ball, const Vec3d& x, const BodyPose& other) const {
    double most = 0, R_star = 0;
    for (Index j = 0; j < balls.size; ++j) {
      const ContactBall& b = balls[j];
      if (b.owner != other.free - 1) continue;
      const double overlap = ball.radius + b.radius - norm(frame.nearest_image(other.place(b.x0) - x));
      if (overlap > most) most = overlap, R_star = b.R_star;
    }
    return R_star;
  }
  /// Between the body of a ball and another one.
  BL_HD BodyLaw law(const ContactBall& ball, std::uint32_t other) const {
    const ElasticCompliance &a = compliances[bodies[ball.owner].body], &b = compliances[other];
    BodyLaw out = laws[ball.owner];
    out.normal.E_star = Real(1 / (a.normal + b.normal));
    out.sliding.G_star = Real(1 / (a.tangential + b.tangential));
    return out;
  }
  /// Memory of a contact, perhaps inherited from another body that the ball has left for this one. A new
  /// contact has had its normal before.
  BL_HD WallMemory taken_over(const ContactBall& ball, const SurfaceContacts<>& found,
                              const SurfaceContact& contact, const WallMemories& memories) const {
    if (contact.from == kNone) return {contact.key(), contact.closest.normal, {}};
    WallMemory memory = memories[contact.from];
    const std::uint32_t left = found.body_of(memory);
    if (left != contact.body)
      law(ball, contact.body)
          .take_over(law(ball, left), Real(ball.R_star), Real(bodies[ball.owner].mass), memory.history);
    return memory;
  }
  BL_HD WallMemory evaluate(Index i, const ContactBall& ball, const Vec3d& x, const SurfaceContact& contact,
                            const WallMemory& memory) const {
    const ClosestPoint& closest = contact.closest;
    const RigidBody& a = bodies[ball.owner];
    const BodyPose &mine = poses[a.body], &other = poses[contact.body];
    ContactHistory h = memory.history;
    h.overlap = std::abs(h.overlap);

    const Vec3d point = x - closest.distance * closest.normal;
    const Vec3d r_mine = arm(mine, point), r_other = arm(other, point);
    double inverse_mass = a.inverse_effective_mass(mine.rotation, r_mine, closest.normal);
    if (other.free)
      inverse_mass += bodies[other.free - 1].inverse_effective_mass(other.rotation, r_other, closest.normal);
    const BodyLaw acting = law(ball, contact.body);
    const double opposite = other.free ? ball_opposite(ball, x, other) : 0;
    const double R_star = opposite > 0 ? 1 / (1 / ball.R_star + 1 / opposite) : ball.R_star;
    const double weight = opposite > 0 ? 0.5 : 1;
    // a constraint may block the motion along the normal: bound the mass, else damping would be infinite
    const double m_star = 1 / max_of(inverse_mass, 1e-6 / a.mass);
    ContactGeometry at{.n = Real3(closest.normal),
                       .n_mid = halfway(Real3(memory.normal), Real3(closest.normal)),
                       .overlap = Real(ball.radius - closest.distance),
                       .R_star = Real(R_star),
                       .m_star = Real(m_star),
                       .arm_i = 0,
                       .arm_j = 0,
                       .inverse_spin = 0,
                       .inverse_rolling = 0};
    if (acting.rolls()) {
      Vec3d about = mine.omega - other.omega;
      about -= dot(about, closest.normal) * closest.normal;
      const double spin = norm(about);
      if (spin > 0) about *= 1 / spin;
      double turning = a.inverse_turning_inertia(mine.rotation, about),
             rolling = a.inverse_rolling_inertia(mine.rotation, r_mine, about);
      if (other.free) {
        const RigidBody& b = bodies[other.free - 1];
        turning += b.inverse_turning_inertia(other.rotation, about);
        rolling += b.inverse_rolling_inertia(other.rotation, r_other, about);
      }
      // irrelevant where nothing rotates, but must not be 0
      at.inverse_spin = max_of(Real(turning), Real(1e-20));
      at.inverse_rolling = max_of(Real(rolling), Real(1e-20));
    }
    // velocities and arms are those in the middle of the substep
    const Vec3d v_ball = mine.v + cross(mine.omega, r_mine + closest.distance * closest.normal),
                moved = closest.distance * (closest.normal - Vec3d(at.n_mid)) - 0.5 * dt * v_ball;
    const auto velocity = [&](const BodyPose& pose, const Vec3d& r) {
      return pose.v + cross(pose.omega, r + moved + 0.5 * dt * pose.v);
    };
    const Vec3d v = velocity(mine, r_mine) - velocity(other, r_other);
    const ContactForce f = acting(at, Real3(v), Real3(mine.omega), Real3(other.omega), Real(dt), h);
    const Vec3d force = weight * Vec3d(f.force);
    const Vec3d couple = weight * Vec3d(f.torque_i);  // that of rolling friction
    loads.add(i, {force, cross(r_mine, force) + couple, a.body});
    loads.add(i, {-force, -cross(r_other, force) - couple, contact.body});
    h.overlap *= closest.side;
    return {contact.key(), closest.normal, h};
  }
};

}  // namespace BL_SOLVER
