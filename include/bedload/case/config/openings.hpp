#pragma once
// Where fluid and grains come in and go out.

#include <limits>
#include <string>
#include <vector>

#include "bedload/case/config/grains.hpp"

namespace bedload {

/// A plane orifice through which fluid comes in.
struct InletConfig {
  std::string name;
  Chosen<OrificeShape> shape = OrificeShape::disc;
  Vec3d centre, direction;                     ///< m; unit, into the flow
  double radius = 0;                           ///< disc: m
  Vec3d half_a, half_b;                        ///< rectangle: from its centre to the middles of two sides, m
  double rate = 0;                             ///< m3/s; exactly one of rate and velocity
  double velocity = 0;                         ///< m/s
  std::string factor = "1";                    ///< of either; formula in t
  double ramp = 0;                             ///< opening and closing take this long, s (default 10 h/c)
  double start = 0;                            ///< s
  double stop = std::numeric_limits<double>::infinity();  ///< s
  bool operator==(const InletConfig&) const = default;
};

/// Where fluid or grains are taken out.
struct OutletConfig {
  std::string name;
  Chosen<OutletPhase> phase = OutletPhase::both;
  ChosenOrNamed<OutletShape> shape = OutletShape::box;  ///< or the name of a shape
  Vec3d min, max;                              ///< box: m; of a shape: around it (resolved)
  Vec3d point, normal;                         ///< plane: normal points out of the flow
  Solid solid;                                 ///< of a named shape (resolved)
  bool takes(Phase what) const {
    return phase != (what == Phase::fluid ? OutletPhase::grains : OutletPhase::fluid);
  }
  bool operator==(const OutletConfig&) const = default;
};

/// Where grains, or clumps of them, are dropped in one by one.
struct GrainInletConfig {
  std::string name;
  Chosen<GrainInletShape> shape = GrainInletShape::box;
  Vec3d min, max;                              ///< box: m, grains lie inside
  Vec3d centre, direction;                     ///< disc: m, normal; centres of grains lie on it
  double radius = 0;                           ///< disc: m, grains lie inside
  double rate = 0;                             ///< grains/s; exactly one of rate and mass_rate
  double mass_rate = 0;                        ///< kg/s
  Vec3d velocity;                              ///< m/s
  double start = 0;                            ///< s
  double stop = std::numeric_limits<double>::infinity();  ///< s
  std::vector<SizeClass> sizes;                ///< default: one class, grain.d
  std::string material;                        ///< which of grain.material; empty: grain.*
  std::string clump;                           ///< which shape; empty: spheres
  std::vector<double> orientation;             ///< of clumps, all alike: rotation vector, deg; empty: at random
  std::uint32_t number = 0;                    ///< of the material in GrainConfig::all_materials (resolved)
  bool operator==(const GrainInletConfig&) const = default;
};

}  // namespace bedload
