#pragma once
// A case as the program sees it: every parameter with its default, checked and
// resolved. Written by src/case, read by everybody on the host. Knows nothing of
// precision or device. Keys, bounds and defaults: `bedload list parameters`.

#include <cstdint>
#include <string>
#include <vector>

#include "bedload/case/config/contact.hpp"
#include "bedload/case/config/coupling.hpp"
#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/drive.hpp"
#include "bedload/case/config/fluid.hpp"
#include "bedload/case/config/grains.hpp"
#include "bedload/case/config/lattice.hpp"
#include "bedload/case/config/motion.hpp"
#include "bedload/case/config/openings.hpp"
#include "bedload/case/config/output.hpp"
#include "bedload/case/config/shapes.hpp"
#include "bedload/case/config/time.hpp"
#include "bedload/case/config/walls.hpp"
#include "bedload/case/places.hpp"

namespace bedload {

struct Config {
  std::string title;
  Chosen<Preset> preset = Preset::standard;
  std::string file;                            ///< where it came from
  Places places;                               ///< where it gives its keys
  Vec3d gravity{0, 0, -9.81};                  ///< m/s2
  DriveConfig drive;
  double xsph = 0;
  double shift = 200;                          ///< factor A of particle shifting
  double tensile = 0;                          ///< 0 off; 1 switches the Monaghan 2000 term on
  bool tensile_one_sign = false;               ///< he2018: 0.01 for both signs of P
  DomainConfig domain;
  std::vector<ShapeConfig> shapes;
  FrameConfig frame;
  FluidConfig fluid;
  EosConfig eos;
  PressureConfig pressure;
  DensityConfig density;
  ViscosityConfig visc;
  SdpdConfig sdpd;
  LatticeConfig lattice;
  WallConfig wall;
  std::vector<InletConfig> inlets;
  std::vector<OutletConfig> outlets;
  GrainConfig grain;
  std::vector<GrainInletConfig> grain_inlets;
  ContactConfig contact;
  LubricationConfig lubrication;
  CouplingConfig couple;
  TimeConfig time;
  OutputConfig out;
  Chosen<Precision> precision = Precision::mixed;
  Chosen<Simd> simd = Simd::automatic;
  std::uint64_t block = 8;                     ///< cells each way of a block that one rank owns
  std::uint64_t seed = 1;
  double max_lost = 1e-3;                      ///< fraction of fluid, grains, bodies that may leave the domain unasked
  double skin_fluid = 0.3;                     ///< neighbour skin / fluid.dx
  double skin_grain = 0.3;                     ///< neighbour skin / grain.d_min
  /// Whether grains have averaging lengths of their own.
  bool own_lengths() const { return couple.own_lengths(grain.d_min, grain.d_max); }
  /// As far as fluid is averaged around the largest grain, m.
  double farthest_average() const { return couple.farthest(fluid.kappa(), grain.d_min, grain.d_max); }
  bool operator==(const Config&) const = default;
};

}  // namespace bedload
