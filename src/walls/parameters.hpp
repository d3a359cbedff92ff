#pragma once
// Parameters of walls and of free bodies.

#include <vector>

#include "bedload/case/config/contact.hpp"
#include "bedload/case/config/walls.hpp"
#include "bedload/case/materials.hpp"
#include "bedload/motion/law.hpp"
#include "kernels/bodies/ball_contacts.hpp"
#include "kernels/bodies/body_kicks.hpp"
#include "src/motion/inlet_flow.hpp"

namespace bedload {
struct Config;
}

namespace BL_SOLVER {

/// A wall with any motion.
struct MovingWall {
  BodyPose still;              ///< pose without motion
  MotionLaw law;               ///< of a wall that is not free
  std::vector<Vec3d> corners;  ///< of the box around it, m
  std::vector<Vec3d> reach;    ///< of the box around its particles and their images, m
};

struct WallMotionParameters {
  std::vector<MovingWall> walls;
  std::vector<InletFlow> inlets;
  double inlet_volume = 0;  ///< of a particle in an inflow buffer, m3
};
WallMotionParameters wall_motion_parameters(const Config& config);

/// A body that moves by the forces that act on it.
struct FreeBody {
  RigidBody rigid;
  Vec3d velocity, spin;            ///< at the start; m/s, rad/s
  double size = 0, reach = 0;      ///< of the corners from the centre; of all particles and their images, m
  double inverse_mass = 0;         ///< largest 1/effective mass, 1/kg
  BodyLaw law;                     ///< of contacts with other bodies
  std::vector<ContactBall> balls;  ///< for contacts with other bodies
  double mu_r = 0;                 ///< rolling friction
  double grain_compliance = 0;     ///< 1/E* of contacts with grains, 1/Pa
};

struct FreeBodyParameters {
  std::vector<FreeBody> bodies;
  std::vector<ElasticCompliance> compliances;  ///< of all wall bodies; none without free ones
  std::size_t walls = 0;                       ///< number of wall bodies
  Vec3d gravity;                               ///< m/s2
  double acceleration = 0;                     ///< largest, of gravity and the frame, m/s2
  double response = 0;                         ///< sound travel time across the kernel, times a few, s
  ContactConfig contact;                       ///< of grains with bodies
  double contact_fraction = 0;                 ///< limit of a substep over the duration of a contact
  double grain_radius = 0, grain_mass = 0;     ///< of the smallest; m, kg; 0 without grains
};
FreeBodyParameters free_body_parameters(const Config& config);

/// Closed bodies in the fluid that are held or moved.
std::vector<EnclosedSolid> held_solids(const Config& config);

}  // namespace BL_SOLVER
