#include "src/lattice/parameters.hpp"

#include "bedload/case/config.hpp"
#include "bedload/case/lattice_step.hpp"

namespace BL_SOLVER {

LatticeParameters lattice_parameters(const Config& config) {
  const LatticeStep step = lattice_step(config);
  LatticeParameters p;
  p.units = {config.fluid.dx, step.dt, config.fluid.rho0};
  p.tau = step.tau;
  const double half = step.tau - 0.5;
  p.magic = config.lattice.collision == LatticeCollision::trt ? config.lattice.magic : half * half;
  p.gravity = gravity_on_fluid(config);
  for (int k = 0; k < 3; ++k) p.static_gravity[k] = config.domain.periodic[k] ? 0 : p.gravity[k];
  p.lift = config.fluid.rho0 * (p.gravity - config.gravity);
  p.drive = config.drive;
  p.mass_every = config.lattice.mass_every;
  p.shear_rate = config.domain.shear_rate;
  for (const WallBody& body : config.wall.bodies)
    p.walls.push_back({MotionLaw(body.motion, config.time.end), body.surface_velocity});
  return p;
}

}  // namespace BL_SOLVER
