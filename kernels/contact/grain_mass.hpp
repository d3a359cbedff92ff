#pragma once
#include "bedload/core/span.hpp"

namespace BL_SOLVER {

/// What a grain has over the cube of its radius, by its material.
struct PerR3 {
  double one = 0;                           ///< of all grains, where they are of one material
  Span<const std::uint32_t> material = {};  ///< of each grain; empty: one
  Span<const double> each = {};             ///< by material
  BL_HD double operator()(Index i) const { return material ? each[material[i]] : one; }
  BL_HD std::uint32_t material_of(Index i) const { return material ? material[i] : 0; }
};
using MassPerR3 = PerR3;    ///< 4/3 pi rho_s, kg/m3
using VolumePerR3 = PerR3;  ///< 4/3 pi, less in clumps, whose grains overlap

}  // namespace BL_SOLVER
