#include "src/walls/parameters.hpp"

#include <algorithm>
#include <cmath>

#include "bedload/case/config.hpp"
#include "bedload/geometry/body.hpp"
#include "bedload/geometry/sampling.hpp"
#include "kernels/fluid/layer_force.hpp"
#include "kernels/smoothing/registry.hpp"
#include "src/walls/free_bodies.hpp"

namespace BL_SOLVER {
namespace {

// -- how walls move ----------------------------------------------------------

BodyPose still_pose(const WallBody& body) {
  BodyPose p;
  p.slip = body.slip == WallSlip::slip;
  p.kind = body.type->kind;
  p.repulsion = body.repels();
  p.no_penetration = body.no_penetration && body.stops_fluid() && !body.single_layer();
  p.slide = body.surface_velocity;
  return p;
}

// -- free bodies -------------------------------------------------------------

/// From the material of a body: Hertz and Mindlin, with the rolling law of the grains.
BodyLaw law_of(const FreeConfig& f, ContactConfig contact) {
  contact.normal = NormalLaw::hertz;
  contact.tangential = SlidingLaw::mindlin;
  contact.he_damping = false;
  const ElasticCompliance own(f.E, f.nu);
  return BodyLaw::of(make_contact_law({.normal = own.normal + own.normal,
                                       .tangential = own.tangential + own.tangential,
                                       .nu = f.nu,
                                       .mu = f.mu,
                                       .mu_r = f.mu_r,
                                       .e = f.e,
                                       .contact = contact}));
}

/// b, place: indices among the wall bodies and among the free ones.
FreeBody free_body(const Config& config, std::uint32_t b, Index place) {
  const WallBody& body = config.wall.bodies[b];
  const FreeConfig& f = body.free;
  FreeBody out;
  RigidBody& k = out.rigid;
  k = rigid_body(f.solid, turning_centre(f), f.move, f.turn, f.axis, config.domain.two_d);
  k.body = b;
  k.fluid = f.fluid;
  k.contacts = f.contacts;
  k.release = f.release_time;
  out.velocity = f.velocity, out.spin = f.spin;

  const auto farthest = [&](double beyond) {
    double r = 0;
    for (const Vec3d& corner : corners(body, config.domain, beyond)) r = std::max(r, norm(corner - k.centre));
    return r;
  };
  const double size = out.size = farthest(0);
  out.reach = farthest(particles_beyond(body, config.fluid));
  out.inverse_mass = 1 / f.solid.mass;
  if (k.turn == BodyTurn::axis) out.inverse_mass += size * size / k.axial;
  if (k.turn == BodyTurn::all)
    out.inverse_mass += size * size / std::min({k.moments.x, k.moments.y, k.moments.z});

  out.law = law_of(f, config.contact);
  out.mu_r = f.mu_r;
  out.grain_compliance =
      ElasticCompliance(config.grain.E, config.grain.nu).normal + wall_compliance(body, config.grain).normal;
  if (!body.stops_grains()) return out;
  for (const BodyBall& ball : contact_balls(body, config.domain)) {
    const double R_star = f.contact_radius > 0 ? f.contact_radius : ball.radius;
    out.balls.push_back({ball.centre, ball.radius, R_star, place});
  }
  return out;
}

}  // namespace

WallMotionParameters wall_motion_parameters(const Config& config) {
  WallMotionParameters p;
  double depth = 0;  // of a single layer, m
  if (config.fluid.present)
    with_fluid_kernel(config.fluid, config.domain, [&](const auto& w) { depth = layer_depth(w); });
  for (const WallBody& body : config.wall.bodies) {
    BodyPose still = still_pose(body);
    const double dx = config.wall.spacing(body);
    if (config.fluid.present)
      still.volume = body.single_layer() ? dx * config.domain.spacing_along(1, dx) * depth
                                         : particle_volume(body, dx, config.domain);
    p.walls.push_back({still, MotionLaw(body.motion, config.time.end), corners(body, config.domain),
                       corners(body, config.domain, particles_beyond(body, config.fluid))});
  }
  for (const InletConfig& inlet : config.inlets) p.inlets.emplace_back(inlet, config.fluid.dx, config.domain);
  p.inlet_volume = config.domain.cell_volume(config.fluid.dx);
  return p;
}

FreeBodyParameters free_body_parameters(const Config& config) {
  FreeBodyParameters p;
  p.walls = config.wall.bodies.size();
  if (config.wall.free_bodies() == 0) return p;
  for (std::uint32_t b = 0; b < p.walls; ++b) {
    const WallBody& body = config.wall.bodies[b];
    p.compliances.push_back(body.free.present ? ElasticCompliance(body.free.E, body.free.nu)
                                              : wall_compliance(body, config.grain));
    if (body.free.present) p.bodies.push_back(free_body(config, b, Index(p.bodies.size())));
  }
  p.gravity = config.gravity;
  p.acceleration = norm(config.gravity) + config.frame.acceleration;
  if (config.fluid.present) p.response = 8 * config.fluid.h() / config.fluid.c;
  p.contact = config.contact;
  p.contact_fraction = config.time.contact;
  if (config.grain.present) {
    const double R = p.grain_radius = 0.5 * config.grain.smallest();
    p.grain_mass = 4.0 / 3.0 * M_PI * R * R * R * config.grain.rho;
  }
  return p;
}

std::vector<EnclosedSolid> held_solids(const Config& config) {
  std::vector<EnclosedSolid> solids;
  for (std::uint32_t b = 0; b < config.wall.bodies.size(); ++b) {
    const WallBody& body = config.wall.bodies[b];
    if (body.free.present || !body.stops_fluid() || !is_closed(body)) continue;
    const SolidMoments m = solid_moments(body, config.domain);
    if (m.volume > 0)
      solids.push_back({b, m.volume, m.middle() - MotionLaw(body.motion, config.time.end).at(0).centre});
  }
  return solids;
}

}  // namespace BL_SOLVER
