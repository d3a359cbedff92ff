#pragma once
// What the solver of the fluid takes from a case.

#include <cstdint>
#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/drive.hpp"
#include "bedload/case/config/fluid.hpp"
#include "bedload/case/config/time.hpp"
#include "bedload/case/particle_order.hpp"
#include "kernels/boundaries/orifice.hpp"
#include "kernels/fluid/layer_force.hpp"

namespace bedload {
struct Config;
}

namespace BL_SOLVER {

struct FluidParameters {
  /// Whether viscosity differs between particles.
  bool viscosity_varies() const { return several || thickens; }

  FluidProperties fluid;
  bool several = false;   ///< species, which differ in viscosity
  bool thickens = false;  ///< grains raise the viscosity of the fluid around them
  DomainConfig domain;
  EosConfig eos;
  PressureConfig pressure;
  DensityConfig density;
  ViscosityConfig visc;
  SdpdConfig sdpd;
  DriveConfig drive;
  TimeConfig time;
  double xsph = 0;
  double shift = 0;  ///< factor A of particle shifting
  ParticleOrder order;
  double tensile = 0;             ///< 0: no tensile term
  bool tensile_one_sign = false;  ///< it is the same for both signs of the pressure
  double skin = 0;                ///< of the lists, m
  std::uint64_t seed = 1;         ///< of noise
  int block = 8;                  ///< cells each way of a block that one rank owns

  bool mixed = false;    ///< grains share the space
  double spreading = 0;  ///< how fast fluid that overfills its volume grows denser, c/h

  bool energy_consistent = false;     ///< fluid pays for the work of the pressure of walls
  bool suction = false;               ///< walls hold fluid back by pressure below zero
  bool repelled = false;              ///< surfaces of walls push fluid or stop it
  Repulsion repulsion{};              ///< by which they do, without a cap
  bool frozen = false;                ///< some walls have their own density
  std::vector<LayerLaw> layers = {};  ///< one a body, those of inlets too; empty without single layers
  std::vector<Orifice> orifices = {};
};
FluidParameters fluid_parameters(const Config& config);

}  // namespace BL_SOLVER
