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
    SurfaceContacts<> found({memory, contacts, i}, walls.surfaces.data, capacity);
    find(ball, x, found);
    found.resolve();
    if constexpr (BodyLaw::kApart) found.drop_apart(ball.radius);
    found.each(
        Lane(i, 0), true,
        [&](const SurfaceContact& contact, std::uint32_t left, ContactHistory& h) {
          law(ball, contact.body)
              .take_over(law(ball, left), Real(ball.R_star), Real(bodies[ball.owner].mass), h);
        },
        [&](const SurfaceContact& contact, WallMemory& of) { evaluate(i, ball, x, contact, of); });
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
      const std::uint32_t body = walls.surfaces[s].body;
      const BodyPose& pose = poses[body];
      if (body == own || !pose.present || !poses[own].present || passes(pose)) continue;
      double reach = ball.radius;
      if constexpr (BodyLaw::kApart) reach += double(law(ball, body).range()) * ball.R_star;
      found.seek(walls, s, pose, frame, x, 1e-4 * ball.radius, ball.radius, reach);
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
  BL_HD void evaluate(Index i, const ContactBall& ball, const Vec3d& x, const SurfaceContact& contact,
                      WallMemory& memory) const {
    const ClosestPoint& closest = contact.closest;
    const RigidBody& a = bodies[ball.owner];
    const BodyPose &mine = poses[a.body], &other = poses[contact.body];
    ContactHistory& h = memory.history;
    const Vec3d point = x - closest.distance * closest.normal;
    const Vec3d r_mine = arm(mine, point), r_other = arm(other, point);
    double inverse_mass = a.inverse_effective_mass(mine.rotation, r_mine, closest.normal);
    if (other.free)
      inverse_mass += bodies[other.free - 1].inverse_effective_mass(other.rotation, r_other, closest.normal);
    const BodyLaw acting = law(ball, contact.body);
    h.overlap = acting.last_overlap(h);
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
    memory.normal = closest.normal;
  }
};

}  // namespace BL_SOLVER
