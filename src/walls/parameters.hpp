#pragma once
// What walls, and those of them that move by the forces on them, take from a case.

#include <vector>

#include "bedload/case/config/contact.hpp"
#include "bedload/case/config/walls.hpp"
#include "bedload/case/materials.hpp"
#include "bedload/motion/law.hpp"
#include "kernels/bodies/ball_contacts.hpp"
#include "src/motion/inlet_flow.hpp"

namespace bedload {
struct Config;
}

namespace bedload::inline BL_VARIANT {

/// A wall, however it moves.
struct MovingWall {
  BodyPose still;              ///< all but how it moves
  MotionLaw law;               ///< where it is not free
  std::vector<Vec3d> corners;  ///< of the box around it, m
  std::vector<Vec3d> reach;    ///< of the box around its particles and their images, m
};

struct WallMotionParameters {
  std::vector<MovingWall> walls;
  std::vector<InletFlow> inlets;
  double inlet_volume = 0;  ///< that a particle on its way in stands for, m3
};
WallMotionParameters wall_motion_parameters(const Config& config);

/// A body that moves by the forces on it.
struct FreeBody {
  RigidBody rigid;
  Vec3d velocity, spin;            ///< at the start; m/s, rad/s
  double size = 0, reach = 0;      ///< of the corners from the centre; of all particles and their images, m
  double inverse_mass = 0;         ///< largest 1/effective mass, 1/kg
  BodyLaw law;                     ///< by which it touches other bodies
  std::vector<ContactBall> balls;  ///< by which it touches them
  double mu_r = 0;                 ///< rolling friction
  double grain_compliance = 0;     ///< 1/E* where grains touch it, 1/Pa
};

struct FreeBodyParameters {
  std::vector<FreeBody> bodies;
  std::vector<ElasticCompliance> compliances;  ///< of all wall bodies; none without free ones
  std::size_t walls = 0;                       ///< how many wall bodies there are
  Vec3d gravity;                               ///< m/s2
  double acceleration = 0;                     ///< largest, of gravity and the frame, m/s2
  double response = 0;                         ///< how long sound takes around a particle, s
  ContactConfig contact;                       ///< of grains with them
  double contact_fraction = 0;                 ///< of a contact's duration, that a substep may take
  double grain_radius = 0, grain_mass = 0;     ///< of the smallest; m, kg; 0 without grains
};
FreeBodyParameters free_body_parameters(const Config& config);

}  // namespace bedload::inline BL_VARIANT
