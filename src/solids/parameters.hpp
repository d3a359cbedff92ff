#pragma once
// What the solver of the grains takes from a case.

#include <cstdint>
#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/grains.hpp"
#include "bedload/case/limits.hpp"
#include "kernels/contact/lubrication.hpp"
#include "kernels/contact/registry.hpp"

namespace bedload::inline BL_VARIANT {

/// Grains that move as one body.
struct RigidGroup {
  int fill = 0;                ///< that they come from, its place in the case
  std::uint32_t material = 0;  ///< of them
  Vec3d velocity;              ///< at the start, m/s
  RigidConfig freedom;
};

struct SolidParameters {
  std::vector<GrainMaterial> materials;    ///< as they are numbered
  double d_max = 0;                        ///< of the largest, m
  double skin = 0;                         ///< of the lists, m
  std::vector<ContactLaw> pair_laws = {};  ///< [materials][materials]
  std::vector<ContactLaw> wall_laws = {};  ///< [bodies][materials]
  bool contacts = true;                    ///< whether grains touch each other and walls
  Lubrication films = {};
  Vec3d gravity = {};        ///< m/s2
  bool fixed = false;        ///< grains never move
  bool exponential = true;   ///< drag acts exactly within a substep; else it bounds the substep
  double drag_fraction = 0;  ///< of the time in which drag acts, that a substep may take
  SubstepLimits limits;
  ReflectConfig reflect;
  std::vector<RigidGroup> groups = {};
  bool plane = false;  ///< groups move in the plane of x and z

  std::uint32_t bodies() const { return std::uint32_t(wall_laws.size() / materials.size()); }  ///< of walls
};

/// Throws CaseError where the restitution cannot be had.
SolidParameters solid_parameters(const Config& config);

}  // namespace bedload::inline BL_VARIANT
