#pragma once
// Parameters of the grain solver.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bedload/case/config/domain.hpp"
#include "bedload/case/config/grains.hpp"
#include "bedload/case/limits.hpp"
#include "kernels/contact/lubrication.hpp"
#include "kernels/contact/registry.hpp"

namespace BL_SOLVER {

/// Clumps of one fill: its grains as one body, or bodies of one shape; or those of one shape and material
/// that inlets drop, also in the case in which a bed settles without them.
struct ClumpKind {
  int fill = 0;                ///< index in the case; -1: they come in
  std::uint32_t material = 0;  ///< of their grains
  Vec3d velocity = {};         ///< of a fill that is one body, at the start, m/s
  RigidConfig freedom = {};
  std::optional<ClumpShape> shape = {};  ///< none: the fill is one body
  double density = 0;                    ///< of a shape, kg/m3
  std::uint32_t spheres = 0;             ///< of each; counted from the grains where the fill is one body
  bool shares_drag = false;              ///< its grains have the drag of one sphere
};

/// Patches of a wall body, at t = 0.
struct WearGrid {
  Vec3d lo;                    ///< m
  double size = 0;             ///< m; 0: wear is not asked for
  std::array<int, 3> count{};  ///< along x, y, z
  double k_over_H = 0;         ///< by which the law multiplies its sum, 1/Pa
  WearLaw law = WearLaw::none;
  bool wears() const { return size > 0; }
};

struct SolidParameters {
  std::vector<GrainMaterial> materials;    ///< in the order of their numbers
  double d_max = 0, d_min = 0;             ///< of the largest and the smallest, m
  double skin = 0;                         ///< of the lists, m
  std::vector<ContactLaw> pair_laws = {};  ///< [materials][materials]
  std::vector<ContactLaw> wall_laws = {};  ///< [bodies][materials]
  bool contacts = true;                    ///< whether grains touch each other and walls
  Lubrication films = {};
  Vec3d gravity = {};        ///< m/s2
  bool fixed = false;        ///< grains never move
  bool exponential = true;   ///< drag is integrated exactly; else it limits the substep
  double drag_fraction = 0;  ///< limit of a substep over the relaxation time of drag
  SubstepLimits limits;
  ReflectConfig reflect;
  std::vector<ClumpKind> clumps = {};
  bool plane = false;   ///< clumps move in the xz plane
  bool energy = false;  ///< its flows are counted
  struct Spectra {
    double from = 0;                 ///< J
    double from_force = 0;           ///< N
    int per_decade = 0;              ///< bins; 0: no spectra
    std::vector<double> sizes = {};  ///< diameters between classes, m
  } spectra = {};                    ///< of what contacts dissipate, and of their peaks
  std::vector<WearGrid> wear = {};   ///< [bodies]; empty: of none
  double shear_rate = 0;             ///< of a sheared box, 1/s; 0: none
  bool single_forces = false;        ///< of contacts are recorded at the end of a step
  double near_gap = 0;               ///< up to which grains and walls are near for that, m; 0: if they touch

  std::uint32_t bodies() const { return std::uint32_t(wall_laws.size() / materials.size()); }  ///< of walls
};

/// Throws CaseError if the restitution cannot be reached.
SolidParameters solid_parameters(const Config& config);

}  // namespace BL_SOLVER
