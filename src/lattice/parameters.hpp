#pragma once
// What the lattice takes from a case.

#include <cstdint>
#include <vector>

#include "bedload/case/config/drive.hpp"
#include "bedload/core/types.hpp"
#include "bedload/motion/law.hpp"

namespace bedload {
struct Config;
}

namespace BL_SOLVER {

/// SI values of one unit of the lattice.
struct LatticeUnits {
  double dx = 0;   ///< m
  double dt = 0;   ///< s
  double rho = 0;  ///< kg/m3

  double velocity() const { return dx / dt; }                            ///< m/s
  double acceleration() const { return dx / (dt * dt); }                 ///< m/s2
  double mass() const { return rho * dx * dx * dx; }                     ///< kg
  double momentum() const { return mass() * velocity(); }                ///< kg m/s
  double force() const { return momentum() / dt; }                       ///< N
  double energy() const { return mass() * velocity() * velocity(); }     ///< J
  double pressure() const { return rho * velocity() * velocity() / 3; }  ///< Pa, of an excess density of 1
};

struct LatticeWall {
  MotionLaw motion;
  Vec3d slide;  ///< of its surface in place, m/s
};

struct LatticeParameters {
  LatticeUnits units;
  double tau = 1;        ///< steps
  double magic = 0;      ///< of TRT; of one relaxation time (tau - 1/2)^2
  Vec3d gravity;         ///< m/s2
  Vec3d static_gravity;  ///< part of it that walls hold, m/s2
  Vec3d lift;            ///< on grains, where gravity leaves out the fluid: of the fluid they displace, N/m3
  DriveConfig drive;
  std::int64_t mass_every = 0;  ///< steps; 0: never
  std::vector<LatticeWall> walls;
  double shear_rate = 0;  ///< of sheared sides across z, 1/s; 0: none
  bool sheared() const { return shear_rate != 0; }
};
LatticeParameters lattice_parameters(const Config& config);

}  // namespace BL_SOLVER
