#pragma once
// Walls, and those of them that move by the forces on them.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bedload/case/choices.hpp"
#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/motion.hpp"
#include "bedload/case/config/shapes.hpp"
#include "bedload/case/setup_choices.hpp"

namespace bedload {

/// Mass of a solid about its centre and the volume of its shape, in the axes of the case.
struct MassProperties {
  double mass = 0;                             ///< kg
  Vec3d centre;                                ///< of mass, m
  std::array<double, 6> inertia{};             ///< Ixx, Iyy, Izz, Ixy, Ixz, Iyz (products with their minus), kg m2
  double volume = 0;                           ///< m3; 0 where the shape is not closed
  Vec3d middle;                                ///< of the volume, m
  bool operator==(const MassProperties&) const = default;
};

/// Ball by which a free body touches others.
struct BodyBall {
  Vec3d centre;                                ///< at t = 0, m
  double radius = 0;                           ///< m
  bool operator==(const BodyBall&) const = default;
};

/// Bodies of one shape thrown at random into a box; as many bodies once resolved.
struct ScatterConfig {
  bool present = false;
  std::int64_t count = 1;
  Vec3d min, max;                              ///< m
  double gap = 0;                              ///< least distance between balls around two of them, m
  bool turned = true;                          ///< each in another direction
  std::uint64_t seed = 1;
  bool operator==(const ScatterConfig&) const = default;
};

/// A wall body that moves by the forces on it.
struct FreeConfig {
  bool present = false;
  ScatterConfig scatter;                       ///< several of it
  double density = 0;                          ///< kg/m3; or mass
  double mass = 0;                             ///< kg
  std::vector<double> centre_of_mass;          ///< m; empty: of the shape
  std::vector<double> inertia;                 ///< about the centre of mass, kg m2; empty: of the shape
  Vec3d velocity;                              ///< of the centre of mass at the start, m/s
  Vec3d spin;                                  ///< rad/s
  double release_time = 0;                     ///< held until then, s
  Chosen<BodyMove> move = BodyMove::all;
  Chosen<BodyTurn> turn = BodyTurn::all;
  Vec3d axis{0, 0, 1};                         ///< unit (resolved)
  std::vector<double> point;                   ///< move = none: stays where it is, m; empty: centre of mass
  bool fluid = true;                           ///< the fluid acts on it
  bool contacts = true;                        ///< touches other bodies
  double E = 0, e = 0;                         ///< Pa, - (default grain.*)
  double nu = std::numeric_limits<double>::infinity();  ///< (default grain.nu)
  double mu = std::numeric_limits<double>::infinity();  ///< (default grain.mu)
  double mu_r = 0;                             ///< rolling friction
  double contact_spacing = 0;                  ///< of sampled balls, m (resolved; 0: balls are given)
  double contact_radius = 0;                   ///< R* of contacts, m; 0: the ball's own radius
  std::vector<BodyBall> balls;                 ///< instead of sampled ones
  MassProperties solid;                        ///< resolved
  bool operator==(const FreeConfig&) const = default;
};

/// One wall body: shape, boundary condition for fluid, motion.
struct WallBody {
  std::string name;
  ChosenOrNamed<WallShape> shape = WallShape::box;  ///< or the name of a shape
  Vec3d min, max;                              ///< box, tank: m; of a shape: around it (resolved)
  std::array<bool, 6> faces{true, true, true, true, true, true};  ///< tank: x-, x+, y-, y+, z-, z+
  Vec3d point, normal;                         ///< plane: normal points into the flow
  Chosen<WallType> type = WallType::adami;
  Chosen<WallSlip> slip = WallSlip::noslip;
  bool no_penetration = true;                  ///< what comes too near is stopped
  bool repulsion = false;                      ///< Monaghan repulsion in addition to the wall's pressure
  Vec3d surface_velocity;                      ///< of the surface in its own plane, as of a belt, in the body's axes, m/s
  Chosen<LayerForce> force = LayerForce::kajtar;  ///< of a single layer
  double dx = 0;                               ///< spacing of its particles, m; 0: wall.dx
  std::string material;                        ///< which of grain.material; empty: its own keys, else as the grains
  double mu = std::numeric_limits<double>::infinity();    ///< sliding friction of grains on it (default grain.mu)
  double mu_r = std::numeric_limits<double>::infinity();  ///< rolling friction (default grain.mu_r)
  double e = 0;                                ///< restitution; 0: grain.e
  double E = 0;                                ///< Young's modulus, Pa; 0: grain.E
  double nu = std::numeric_limits<double>::infinity();    ///< Poisson's ratio (default grain.nu)
  Chosen<WearLaw> wear = WearLaw::none;        ///< by grains
  double k_over_H = 0;                         ///< of the law of wear, 1/Pa
  double wear_patch = 0;                       ///< edge of the patches, m; 0: d_max of the grains
  MotionConfig motion;
  FreeConfig free;                             ///< instead of a motion
  Solid solid;                                 ///< of a named shape (resolved)
  bool stops_fluid() const { return type->stops_fluid; }
  bool repels() const { return stops_fluid() && !single_layer() && (repulsion || type->repels); }
  bool single_layer() const { return type->single_layer; }
  bool stops_grains() const { return type->stops_grains; }
  bool moves() const { return motion.moves() || free.present; }
  bool operator==(const WallBody&) const = default;
};

/// Grid of patches around a body in which its wear is told.
struct WearPatches {
  Vec3d lo;                                    ///< at t = 0, m
  double size;                                 ///< m
  std::array<double, 3> count;                 ///< along x, y, z
  WearPatches(const WallBody& body, const DomainConfig& domain, double d_max)
      : size(body.wear_patch > 0 ? body.wear_patch : d_max) {
    const bool plane = body.shape == WallShape::plane;
    lo = plane ? domain.min : body.min;
    const Vec3d hi = plane ? domain.max : body.max;
    for (int k = 0; k < 3; ++k) count[k] = std::max(1.0, std::ceil((hi[k] - lo[k]) / size));
  }
  double number() const { return count[0] * count[1] * count[2]; }
};

struct WallConfig {
  Chosen<WallType> type = WallType::adami;     ///< default of the bodies, as what follows
  Chosen<WallSlip> slip = WallSlip::noslip;
  Chosen<LayerForce> force = LayerForce::kajtar;
  bool no_penetration = true;
  bool repulsion = false;
  bool energy_consistent = true;               ///< of all bodies: the fluid provides the work of their pressure
  bool suction = false;                        ///< of all bodies: their pressure may fall below zero
  double dx = 0;                               ///< spacing of wall particles, m (default fluid.dx)
  double rep_D = 0;                            ///< m2/s2 (default 5 g H)
  double rep_r0 = 0;                           ///< m (default 0.5 dx)
  double layer_r0 = 0;                         ///< reach of the Monaghan force of single layers, m (default dx)
  std::vector<WallBody> bodies;
  int free_bodies() const {
    int n = 0;
    for (const WallBody& body : bodies) n += body.free.present;
    return n;
  }
  bool wears() const {
    for (const WallBody& body : bodies)
      if (body.wear != WearLaw::none) return true;
    return false;
  }
  double spacing(const WallBody& body) const { return body.dx > 0 ? body.dx : dx; }  ///< m
  bool operator==(const WallConfig&) const = default;
};

}  // namespace bedload
