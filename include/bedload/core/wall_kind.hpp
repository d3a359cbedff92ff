#pragma once
#include <cstdint>

namespace bedload {

/// Where the particles of a wall have the pressure from with which they meet the fluid: a trait of each
/// wall.type, and a case in WallPass::finish.
enum class WallKind : std::uint32_t {
  extrapolated,  ///< from the fluid next to them
  frozen,        ///< from their own density, which follows continuity
  mirrored,      ///< from the density about their images in the fluid
  single_layer,  ///< none: they push fluid away one by one
};

}  // namespace bedload
